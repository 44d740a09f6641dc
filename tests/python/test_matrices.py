"""K, M, B, D and the critical timestep against scipy, on packings."""
import numpy as np
import pytest
import scipy.linalg
import scipy.sparse.linalg
from conftest import dense_packing, two_balls

import eigengrain

# 0.21 × 0.21 m bed of examples/data/packing_10k.txt: by an independent program from the same positions.
BED_LAMBDA = 1.1076739277883823e9


def test_k_is_symmetric_to_the_bit_and_the_product_without_k(bed):
    system = bed.system()
    k = system.K
    assert (k != k.T).nnz == 0
    assert k.shape == (system.size, system.size) and k.blocksize == (3, 3)
    x = np.random.default_rng(0).normal(size=system.size)
    operator = system.operator()
    y = operator @ x
    # Both are sums of some tens of terms a row.
    np.testing.assert_allclose(y, k @ x, rtol=0, atol=1e-13 * np.abs(k).max() * np.abs(x).max() * 30)
    assert operator.products == 1


def test_k_is_b_d_b(bed):
    system = bed.system()
    k, b, d = system.K.tocsr(), system.B.tocsr(), system.D.tocsr()
    assert b.shape == (6 * len(system.elements), system.size)
    assert abs(k - b.T @ d @ b).max() < 1e-13 * abs(k).max()


def test_fixed_components_are_masked():
    scene = two_balls()
    scene["balls"][1]["fix"] = ["x", "wy"]
    system = eigengrain.load(scene).system()
    fixed = np.setdiff1d(np.arange(system.size), system.free)
    assert len(fixed) == 2
    k = system.K.toarray()
    assert not k[fixed].any() and not k[:, fixed].any()
    b, d = system.B.toarray(), system.D.toarray()
    np.testing.assert_allclose(b.T @ d @ b, k, rtol=0, atol=1e-12 * k.max())
    reduced, mass = system.reduced()
    assert reduced.shape == mass.shape == (10, 10)


def test_clumps_have_b_along_their_axes():
    """A clump that lies on a floor and on a ball, turned so that its principal axes are none of space."""
    scene = two_balls(clumps=[{"balls": [{"at": [0, 0, 0], "radius": 0.005}, {"at": [0.007, 0, 0], "radius": 0.004}],
                               "material": "grain",
                               "instances": [{"position": [0.0071, 0.001, 0.0049], "axis": [1, 2, 3], "angle": 0.7}]}])
    state = eigengrain.load(scene)
    system = state.system()
    k, b, d = system.K, system.B, system.D
    clump_rows = np.flatnonzero(state.bodies.owner != np.arange(len(state.bodies)))
    assert len(clump_rows) == 1
    holder = state.bodies.owner[clump_rows[0]]
    assert holder in system.elements.a or holder in system.elements.b
    assert system.rotation_block[holder] >= 0 and len(system.elements) > 2
    assert abs(k - b.T @ d @ b).max() < 1e-13 * abs(k).max()
    x = np.random.default_rng(5).normal(size=system.size)
    np.testing.assert_allclose(system.from_bodies(*system.to_bodies(x)), x, rtol=1e-13)
    assert not np.allclose(system.to_bodies(x)[1][holder], x[3 * system.rotation_block[holder]:][:3])


def test_the_truth_is_that_of_eigsh(bed):
    found = bed.timestep()
    k, m = bed.system().reduced()
    root = scipy.sparse.diags(1 / np.sqrt(m.diagonal()))
    value = scipy.sparse.linalg.eigsh(root @ k @ root, k=1, which="LA", tol=1e-13, return_eigenvectors=False)[0]
    assert found.true.lambda_max == pytest.approx(value, rel=1e-12)
    assert found.true.lambda_max == pytest.approx(BED_LAMBDA, rel=1e-12)
    assert found.true.dt == pytest.approx(2 / np.sqrt(value), rel=1e-12)
    assert found.contacts == 27440 and found.bodies == 10000
    x = found.true.mode
    full = bed.system()
    assert x @ (full.mass * x) == pytest.approx(1, rel=1e-12)
    assert np.linalg.norm(full.operator() @ x - value * full.mass * x) < 1e-8 * value * np.linalg.norm(full.mass * x)


def test_estimates_by_name(bed):
    found = bed.timestep(certify="never")
    assert found["diagonal"].dt == pytest.approx(3.494575352889191e-5, rel=1e-12)
    assert found["diagonal"].safe and 0.5 < found["diagonal"].ratio_to_true < 0.65
    assert "diagonal" in str(found)
    with pytest.raises(KeyError, match="there is no such estimate"):
        found["no such thing"]


def test_the_map_of_the_unknowns_both_ways(bed):
    system = bed.system()
    x = np.random.default_rng(2).normal(size=system.size)
    u, theta = system.to_bodies(x)
    assert u.shape == theta.shape == (len(bed.bodies), 3)
    np.testing.assert_array_equal(system.from_bodies(u, theta), x)
    for blocks, rows, is_rotation in [(system.translation_block, u, False), (system.rotation_block, theta, True)]:
        has = np.flatnonzero(blocks >= 0)
        np.testing.assert_array_equal(rows[has], x.reshape(-1, 3)[blocks[has]])
        np.testing.assert_array_equal(system.body[blocks[has]], has)
        assert (system.is_rotation[blocks[has]] == is_rotation).all()
    assert not u[system.set_aside].any()
    with pytest.raises(eigengrain.InputError, match="unknowns is wanted"):
        system.to_bodies(x[:-1])
    with pytest.raises(eigengrain.InputError, match="a row for each ball"):
        system.from_bodies(u[:-1], theta)


def test_mass_of_the_unknowns(bed):
    system = bed.system()
    rows = np.where(system.is_rotation, bed.bodies.inertia[system.body], bed.bodies.mass[system.body])
    np.testing.assert_array_equal(system.mass.reshape(-1, 3), np.repeat(rows[:, None], 3, axis=1))


def test_contacts_are_those_of_the_geometry(bed):
    """Every column from the positions and radii alone."""
    bodies, contacts = bed.bodies, bed.contacts
    between = contacts.b >= 0
    a, b = contacts.a[between], contacts.b[between]
    way = bodies.position[b] - bodies.position[a]
    distance = np.linalg.norm(way, axis=1)
    np.testing.assert_allclose(contacts.normal[between], way / distance[:, None], rtol=0, atol=1e-15)
    overlap = bodies.radius[a] + bodies.radius[b] - distance
    np.testing.assert_allclose(contacts.overlap[between], overlap, rtol=0, atol=1e-17)
    np.testing.assert_allclose(contacts.normal_force[between], 1e5 * overlap, rtol=1e-12)
    point = bodies.position[a] + (bodies.radius[a] - overlap / 2)[:, None] * contacts.normal[between]
    np.testing.assert_allclose(contacts.point[between], point, rtol=0, atol=1e-16)
    at_wall = ~between
    assert set(contacts.wall[at_wall]) == {0, 1, 2, 3, 4} and (contacts.wall[between] == -1).all()
    sums = np.zeros_like(bodies.force)
    np.add.at(sums, contacts.a, -contacts.force)
    np.add.at(sums, b, contacts.force[between])
    np.testing.assert_allclose(sums, bodies.force, rtol=0, atol=1e-13 * np.abs(contacts.force).max() * 12)


def test_dashpots_and_their_absence():
    scene = two_balls()
    with pytest.raises(eigengrain.InputError, match="dashpots"):
        eigengrain.load(scene).system().C
    scene["contacts"][0]["beta_n"] = 0.2
    c = eigengrain.load(scene).system().C.toarray()
    np.testing.assert_array_equal(c, c.T)
    assert c.max() > 0


def test_formats(small):
    system = small.system()
    for name, format in [("K", "csr"), ("B", "csc"), ("D", "coo"), ("M", "csr")]:
        assert system.matrix(name, format).format == format
    np.testing.assert_array_equal(system.M.diagonal(), system.mass)
    scaled = system.operator(scaled=True)
    root = 1 / np.sqrt(system.mass)
    x = np.random.default_rng(3).normal(size=system.size)
    expected = root * (system.K @ (root * x))
    np.testing.assert_allclose(scaled @ x, expected, rtol=0, atol=1e-13 * np.abs(expected).max())


def test_petsc4py(small):
    pytest.importorskip("petsc4py")
    system = small.system()
    x = np.random.default_rng(4).normal(size=system.size)
    mat = system.petsc("K")
    from_x, to_y = mat.createVecs()
    from_x.setArray(x)
    mat.mult(from_x, to_y)
    expected = system.K @ x
    np.testing.assert_allclose(to_y.getArray(), expected, rtol=0, atol=1e-13 * np.abs(expected).max())
    # The library goes on in a process in which petsc4py has started PETSc.
    assert small.timestep().true.residual < 1e-8


def test_eigsh_takes_the_operator(packing):
    system = packing.system()
    value = scipy.sparse.linalg.eigsh(system.operator(scaled=True), k=1, which="LA", tol=1e-12,
                                      return_eigenvectors=False)[0]
    assert packing.timestep().true.lambda_max == pytest.approx(value, rel=1e-11)


def test_dense_spectrum_of_a_small_packing(small):
    k, m = small.system().reduced()
    values = scipy.linalg.eigh(k.toarray(), m.toarray(), eigvals_only=True)
    assert small.timestep().true.lambda_max == pytest.approx(values[-1], rel=1e-12)
    assert values[0] > -1e-12 * values[-1]
