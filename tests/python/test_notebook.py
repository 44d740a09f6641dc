"""A notebook written from README.md and docs/ alone, and each of its numbers against scipy on the exported matrices.

Here 1,000 balls in a periodic cell; tests/bench/notebook.py does the same with 10,000.
"""
import matplotlib

matplotlib.use("Agg")
import numpy as np
import scipy.sparse
import scipy.sparse.linalg

import eigengrain
import eigengrain.plot


def notebook(bed, cell, folder):
    """Timestep, equilibrium, modes, moduli, density of states and pictures; `cell` repeats along all axes, as moduli want."""
    print(bed, *bed.notes)
    relaxed = bed.relax()
    print(f"unbalanced ratio {relaxed.start.mean:.1e} -> {relaxed.end.mean:.1e} ({relaxed.method}, {relaxed.steps} cycles)")
    step = bed.timestep(certify="never")
    print(f"true timestep {step.true.dt:.9e} s; PFC3D's rule takes {step['diagonal'].ratio_to_true:.4f} of it")
    system = bed.system()
    high, low = system.highest_modes(20), system.lowest_modes(20)
    print(f"{len(system.free)} unknowns: {low.frequencies[0]:.5g} ... {high.frequencies[0]:.5g} rad/s, participation "
          f"{low.participation[0]:.3f} ... {high.participation[0]:.4f}")
    density = system.density_of_states(bins=40)
    if cell is not bed:
        cell.relax()
    moduli = cell.moduli()
    print(f"bulk modulus {moduli.bulk:.5e} Pa, shear modulus {moduli.shear:.5e} Pa")
    eigengrain.plot.force_chains(bed).figure.savefig(folder / "force_chains.png")
    eigengrain.plot.mode_shape(bed, low, 0).figure.savefig(folder / "lowest_mode.png")
    eigengrain.plot.density_of_states(density).figure.savefig(folder / "density.png")
    return step, system, high, low, density, moduli


def scaled(system):
    """M^-1/2 K M^-1/2 on the free components, from the exported matrices."""
    stiffness, mass = system.reduced()
    root = scipy.sparse.diags(1 / np.sqrt(mass.diagonal()))
    return (root @ stiffness @ root).tocsr()


def by_inverse(a, above, wanted):
    """The least eigenvalues, zeros among them, by Lanczos on the inverse shifted a little below zero."""
    return np.sort(scipy.sparse.linalg.eigsh(a.tocsc(), k=wanted, sigma=-0.1 * above, which="LM", tol=1e-13,
                                             return_eigenvectors=False))


def linear_response(cell):
    """The 6x6 stiffness, C V = affine - f K^+ f with f = B'D(strain of the branches), by conjugate gradients."""
    system = cell.system()
    elements, K, B, D = system.elements, system.matrix("K"), system.matrix("B"), system.matrix("D")
    branch = elements.lever_a - elements.lever_b
    strain = np.zeros((len(elements), 6, 6))
    for column, (i, j) in enumerate([(0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1)]):
        strain[:, i, column] += 0.5 * branch[:, j]
        strain[:, j, column] += 0.5 * branch[:, i]
    strain = strain.reshape(-1, 6)
    loads = B.T @ (D @ strain)
    jacobi = scipy.sparse.diags(1 / np.maximum(K.diagonal(), 1e-12 * K.diagonal().max()))
    answers = [scipy.sparse.linalg.cg(K, load, tol=1e-11, atol=0, maxiter=20_000, M=jacobi) for load in loads.T]
    assert all(failed == 0 for _, failed in answers)
    relaxed = np.column_stack([answer for answer, _ in answers])
    return (strain.T @ (D @ strain) - loads.T @ relaxed) / np.linalg.det(cell.cell[0])


def check(found, cell, lowest):
    """Each number of the notebook to 1e-8 against scipy; the density, which is a random estimate, to three of its errors."""
    step, system, high, low, density, moduli = found
    a = scaled(system)
    largest = scipy.sparse.linalg.eigsh(a, k=20, which="LA", tol=1e-12, return_eigenvectors=False)[::-1]
    np.testing.assert_allclose(high.eigenvalues, np.sort(largest)[::-1], rtol=1e-8)
    np.testing.assert_allclose(step.true.dt, 2 / np.sqrt(largest.max()), rtol=1e-8)
    # All the least ones, so that none is missed: zeros (rigid motions, rattlers, mechanisms), then those of lowest_modes.
    least = lowest(a)
    zeros = int(np.sum(np.abs(least) < 1e-10 * largest.max()))
    assert len(least) >= zeros + 20
    np.testing.assert_allclose(low.eigenvalues, least[zeros:zeros + 20], rtol=1e-8)
    assert abs(density.count.sum() / a.shape[0] - 1) < 1e-8
    known = np.flatnonzero(density.edges[1:] < np.sqrt(least[-1]))
    counted, _ = np.histogram(np.sqrt(np.maximum(least, 0)), bins=density.edges)
    assert len(known) > 0
    for k in known:
        assert abs(density.count[k] - counted[k]) < 3 * density.error[k]
    # The mean of ω² is tr(A)/n. Of 8 random vectors it has a variance of 2 tr(A²)/8n²; bins and smearing add their squares.
    n, mean, width = a.shape[0], a.diagonal().mean(), density.edges[1]
    deviation = np.sqrt(2 * a.multiply(a).sum() / (8 * n**2)) + width**2 / 12 + density.resolution**2
    assert abs(density.count @ (density.edges[1:] - width / 2) ** 2 / n - mean) < 3 * deviation
    expected = linear_response(cell)
    np.testing.assert_allclose(moduli.stiffness, expected, rtol=0, atol=1e-8 * expected.max())
    np.testing.assert_allclose(moduli.bulk, expected[:3, :3].sum() / 9, rtol=1e-8)
    return zeros, len(known)


def test_notebook(packing, tmp_path):
    state = packing.copy()
    found = notebook(state, state, tmp_path)
    zeros, _ = check(found, state, lambda a: by_inverse(a, found[3].eigenvalues[0], 60))
    assert zeros >= 3
    for name in ("force_chains", "lowest_mode", "density"):
        assert (tmp_path / f"{name}.png").stat().st_size > 10_000
