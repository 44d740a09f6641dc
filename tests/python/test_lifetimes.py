"""Arrays that outlive what they were taken from, and states that go on while arrays show them."""
import gc
import pickle
import sys
import threading
import weakref

import numpy as np
import pytest
from conftest import dense_packing, two_balls

import eigengrain

COLUMNS = ["identity", "position", "radius", "mass", "inertia", "material", "fixed", "velocity", "spin", "force",
           "moment", "owner"]
CONTACT_COLUMNS = ["a", "b", "wall", "rule", "image", "normal", "branch", "point", "force", "overlap", "slides",
                   "bonded", "rattlers"]


def churn():
    """Frees what can be freed, and lets other things take the memory."""
    gc.collect()
    return [np.full(100_000, np.nan) for _ in range(20)]


@pytest.mark.parametrize("name", COLUMNS)
def test_columns_of_bodies_outlive_their_state(name):
    state = eigengrain.load(dense_packing())
    array = getattr(state.bodies, name)
    expected = array.copy()
    del state
    churn()
    np.testing.assert_array_equal(array, expected)


@pytest.mark.parametrize("name", CONTACT_COLUMNS)
def test_columns_of_contacts_outlive_their_state(name):
    state = eigengrain.load(dense_packing())
    array = getattr(state.contacts, name)
    expected = array.copy()
    del state
    churn()
    np.testing.assert_array_equal(array, expected)


def test_matrices_and_operators_outlive_their_state():
    state = eigengrain.load(dense_packing())
    system = state.system()
    k, b, d, mass, operator = system.K, system.B, system.D, system.mass, system.operator()
    copies = k.copy(), b.copy(), d.copy(), mass.copy()
    del state, system
    churn()
    for one, other in zip((k, b, d), copies):
        assert (one != other).nnz == 0
    np.testing.assert_array_equal(mass, copies[3])
    x = np.random.default_rng(1).normal(size=k.shape[0])
    np.testing.assert_allclose(operator @ x, k @ x, rtol=1e-12, atol=1e-12 * np.abs(k @ x).max())


def test_what_was_taken_stays_as_it_was():
    state = eigengrain.load(two_balls())
    before = state.bodies.position
    bodies, system = state.bodies, state.system()
    expected, k = before.copy(), system.K
    state.run(2000)
    np.testing.assert_array_equal(before, expected)
    np.testing.assert_array_equal(bodies.position, expected)
    assert (system.K != k).nnz == 0
    assert np.abs(state.bodies.position - expected).max() > 0


def test_arrays_are_no_copies_and_cannot_be_written():
    state = eigengrain.load(two_balls())
    first, second = state.bodies.position, state.bodies.position
    assert np.shares_memory(first, second) and not first.flags.owndata
    with pytest.raises(ValueError, match="read-only"):
        first[0, 0] = 1
    with pytest.raises(ValueError):
        first.flags.writeable = True


def test_nothing_is_kept_for_ever():
    """References to None as a measure of leaks would lie; memory of the process does not."""
    resource = pytest.importorskip("resource")

    def take():
        for _ in range(20):
            state = eigengrain.load(dense_packing(), set={"run": {"steps": 1}}) if False else template.copy()
            state.run(1)
            state.bodies.position, state.contacts.force, state.system().K, pickle.dumps(state)

    template = eigengrain.load(dense_packing())
    take()
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    for _ in range(10):
        take()
    grown = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before
    assert grown < 10_000, f"{grown} kB more after 200 states of some 300 kB each"


def test_capsules_let_go_of_the_state():
    state = eigengrain.load(two_balls())
    array = state.bodies.position
    kept = weakref.ref(array)
    references = sys.getrefcount(array.base)
    view = array[:1]
    assert sys.getrefcount(array.base) >= references
    del array, view
    gc.collect()
    assert kept() is None


def test_other_threads_run_and_may_look_meanwhile():
    state = eigengrain.load(dense_packing())
    seen = []
    running = threading.Thread(target=state.run, args=(3000,))
    running.start()
    while running.is_alive():
        seen.append((state.step, float(state.bodies.position.sum())))
    running.join()
    assert state.step == 3000
    assert seen[0][0] == 0 and len(seen) > 10


def test_one_operator_from_many_threads():
    operator = eigengrain.load(dense_packing()).system().operator()
    x = np.random.default_rng(1).normal(size=operator.shape[0])
    expected = operator @ x
    wrong = []

    def ask():
        for _ in range(50):
            if not np.array_equal(operator @ x, expected):
                wrong.append(1)

    threads = [threading.Thread(target=ask) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not wrong
