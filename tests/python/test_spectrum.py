"""Modes, density of states, rigidity and moduli against scipy on the exported matrices."""
import numpy as np
import pytest
import scipy.linalg
import scipy.sparse
import scipy.sparse.linalg
from conftest import dense_packing, two_balls

import eigengrain


def scaled(system):
    """M^-1/2 K M^-1/2 on the free components."""
    k, m = system.reduced()
    root = scipy.sparse.diags(1 / np.sqrt(m.diagonal()))
    return (root @ k @ root).tocsc()


def test_twenty_highest_modes_of_the_bed_are_those_of_eigsh(bed):
    system = bed.system()
    expected = scipy.sparse.linalg.eigsh(scaled(system), k=20, which="LA", tol=1e-12, return_eigenvectors=False)
    np.testing.assert_allclose(system.highest_modes(20).eigenvalues, np.sort(expected)[::-1], rtol=1e-10)


def test_twenty_lowest_and_highest_modes_are_those_of_eigsh(packing):
    """Shift-invert a little above the middle of what is looked for: zeros are farther from there than any of it."""
    system = packing.system()
    a = scaled(system)
    high, low = system.highest_modes(20), system.lowest_modes(20)
    assert len(high) == len(low) == 20
    expected = scipy.sparse.linalg.eigsh(a, k=20, which="LA", tol=1e-12, return_eigenvectors=False)
    np.testing.assert_allclose(high.eigenvalues, np.sort(expected)[::-1], rtol=1e-10)
    nearest = scipy.sparse.linalg.eigsh(a, k=20, sigma=0.51 * low.eigenvalues[-1], which="LM", tol=1e-12,
                                        return_eigenvectors=False)
    np.testing.assert_allclose(low.eigenvalues, np.sort(nearest), rtol=1e-8)


def test_modes_are_orthonormal_and_solve_the_problem(packing):
    system = packing.system()
    for modes in (system.highest_modes(5), system.lowest_modes(5)):
        x = modes.shapes
        np.testing.assert_allclose(x @ (system.mass[:, None] * x.T), np.eye(5), atol=1e-7)
        for k in range(5):
            r = system.K @ x[k] - modes.eigenvalues[k] * system.mass * x[k]
            assert np.abs(r).max() < 1e-6 * np.abs(system.K @ x[k]).max() + 1e-12 * np.abs(system.K).max()


def test_all_modes_are_those_of_eigh(small):
    system = small.system()
    expected = scipy.linalg.eigh(scaled(system).toarray(), eigvals_only=True)
    found = system.all_modes()
    np.testing.assert_allclose(found.eigenvalues, expected, rtol=0, atol=1e-13 * expected[-1])
    assert found.shapes.shape == (0, system.size)
    shapes = system.all_modes(shapes=True).shapes
    np.testing.assert_allclose(shapes @ (system.mass[:, None] * shapes.T), np.eye(len(expected)), atol=1e-12)


def test_shares_of_modes_by_hand(small):
    system = small.system()
    modes = system.highest_modes(3)
    for k in range(3):
        u, theta = modes.motion(k)
        moving = 0.5 * small.bodies.mass * (u**2).sum(axis=1)
        turning = 0.5 * small.bodies.inertia * (theta**2).sum(axis=1)
        e = (moving + turning)[system.translation_block >= 0]
        np.testing.assert_allclose(modes.energy(k), (moving + turning) / e.sum(), rtol=0, atol=1e-14)
        assert modes.translation[k] == pytest.approx(moving.sum() / e.sum(), rel=1e-12)
        assert modes.participation[k] == pytest.approx(e.sum()**2 / (len(e) * (e**2).sum()), rel=1e-12)


def test_density_of_states_within_its_errors():
    system = eigengrain.load(dense_packing(box=0.06)).system()
    found = system.density_of_states(bins=12, moments=128, vectors=16)
    counted, _ = np.histogram(system.all_modes().frequencies, bins=found.edges)
    assert found.count.sum() == pytest.approx(found.modes, rel=1e-9)
    off = np.abs(found.count - counted) / (found.error + 0.5)
    assert (off > 2).sum() <= 2 and off.max() < 4
    assert np.sum(found.density * np.diff(found.edges)) == pytest.approx(1, rel=1e-9)


def test_rigidity_against_the_rank_of_b(small):
    system = small.system()
    k, _ = system.reduced()
    rank = np.linalg.matrix_rank(scaled(system).toarray(), tol=1e-11 * np.abs(k).max() / system.mass.min(),
                                 hermitian=True)
    found = small.rigidity(shapes=True)
    assert found.counts_agree and found.trivial == 3
    assert found.floppy == k.shape[0] - rank
    assert len(found.springs) == 3 * found.contacts == found.stresses.shape[1]
    stiffness = np.where(found.springs.kind == "normal", 1e5, 5e4)
    # A state of self-stress leaves every ball in balance.
    forces = (np.sqrt(stiffness) * found.stresses[0])[:, None] * found.springs.direction
    balance = np.zeros((len(small.bodies), 3))
    np.add.at(balance, found.springs.a, -forces)
    np.add.at(balance, found.springs.b, forces)
    assert np.abs(balance).max() < 1e-10 * np.abs(forces).max()
    for u, theta in zip(found.floppy_u, found.floppy_theta):
        assert np.abs(system.K @ system.from_bodies(u, theta)).max() < 1e-9 * np.abs(system.K).max() * np.abs(u).max()


def test_rigidity_words():
    state = eigengrain.load(two_balls())
    normal, sticking = state.rigidity("normal"), state.rigidity("sticking")
    assert len(normal.springs) == 2 and len(sticking.springs) == 6
    with pytest.raises(eigengrain.InputError, match="none of all"):
        state.rigidity("some")


def test_moduli_against_scipy(small):
    """C = (affine - f K^+ f)/V from the exported K, B and D alone."""
    system, elements = small.system(), small.system().elements
    branch = elements.lever_a - elements.lever_b
    followed = np.zeros((len(elements), 3, 6))
    for column, (i, j) in enumerate([(0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1)]):
        followed[:, i, column] += 0.5 * branch[:, j]
        followed[:, j, column] += 0.5 * branch[:, i]
    strain = np.zeros((6 * len(elements), 6))
    for e in range(len(elements)):
        strain[6 * e:6 * e + 3] = followed[e]
    k, b, d = system.K.toarray(), system.B, system.D
    f = b.T @ (d @ strain)
    volume = 0.045**3
    affine = strain.T @ (d @ strain) / volume
    expected = affine - f.T @ np.linalg.pinv(k, rcond=1e-11, hermitian=True) @ f / volume
    found = small.moduli()
    np.testing.assert_allclose(found.affine, affine, rtol=0, atol=1e-12 * affine.max())
    np.testing.assert_allclose(found.stiffness, expected, rtol=0, atol=1e-8 * affine.max())
    assert found.bulk == pytest.approx(expected[:3, :3].sum() / 9, rel=1e-8)
    assert found.displacement.shape == (6, len(small.bodies), 3)


def test_moduli_want_a_cell(bed):
    with pytest.raises(eigengrain.InputError, match="repeats along all axes"):
        bed.moduli()


def test_finite_strains_agree_to_the_overlap():
    """A cell is strained by 1e-7 and relaxed: so little that no contact opens or closes. The stress changes by C times the
    strain, but for what K leaves out, which is of the size of the overlap over the radius (2e-3)."""
    start = eigengrain.load(dense_packing())
    start.relax(1e-11)
    contacts = len(start.contacts)
    found = []
    for strain in (1e-7, -1e-7):
        rate = strain / start.copy().timestep(certify="never").true.limit
        strained = start.with_settings({"periodic.velocity_gradient": [[rate, 0, 0], [0, 0, 0], [0, 0, 0]]})
        strained.run(1)
        strained = strained.with_settings({"periodic.velocity_gradient": []})
        strained.relax(1e-11)
        assert len(strained.contacts) == contacts
        found.append((strained.cell[0][0, 0], strained.measure().stress))
    strain = (found[0][0] - found[1][0]) / start.cell[0][0, 0]
    assert 1e-8 < strain < 1e-6
    slope = (found[0][1] - found[1][1]) / strain
    c = start.moduli().stiffness
    np.testing.assert_allclose(np.diag(slope), c[:3, 0], rtol=0, atol=4e-3 * c[0, 0])


def test_mode_shapes_for_paraview(small, tmp_path):
    modes = small.system().lowest_modes(2)
    modes.save(tmp_path / "modes.vtu")
    assert b"mode_2_rotation" in (tmp_path / "modes.vtu").read_bytes()
