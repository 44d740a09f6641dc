"""The cycle and relaxation from scripts: ends, callbacks, interrupts, failures."""
import os
import signal
import subprocess
import sys
import textwrap

import numpy as np
import pytest
from conftest import dense_packing, two_balls

import eigengrain


def test_parts_of_a_run_are_the_whole_run():
    whole, parts = eigengrain.load(dense_packing()), eigengrain.load(dense_packing())
    whole.run(170)
    parts.run(70)
    parts.run(100)
    assert whole.time == parts.time
    np.testing.assert_array_equal(whole.bodies.position, parts.bodies.position)
    np.testing.assert_array_equal(whole.bodies.velocity, parts.bodies.velocity)


def test_callbacks_see_the_state_and_may_end_the_run():
    state = eigengrain.load(two_balls())
    steps = []

    def note(seen):
        assert seen is state
        steps.append(seen.step)
        return seen.step >= 30

    state.run(1000, callback=note, every=10)
    assert steps == [10, 20, 30] and state.step == 30


def test_callbacks_do_not_change_the_run():
    plain, watched = eigengrain.load(dense_packing()), eigengrain.load(dense_packing())
    plain.run(100)
    watched.run(100, callback=lambda state: state.contacts.force, every=7)
    np.testing.assert_array_equal(plain.bodies.position, watched.bodies.position)


def test_a_numpy_truth_ends_a_run_too():
    state = eigengrain.load(two_balls())
    state.run(100, callback=lambda seen: seen.bodies.position[0, 2] < 1, every=10)
    assert state.step == 10


def test_a_run_goes_on_with_what_its_callback_changes():
    state = eigengrain.load(two_balls())
    state.run(20, callback=lambda seen: seen.change(velocity=np.full((2, 3), 3.0)) if seen.step == 10 else None,
              every=10)
    assert state.step == 20
    np.testing.assert_allclose(state.bodies.velocity[:, 0], 3.0, rtol=0.1)


def test_the_conditions_of_a_scene_end_its_run():
    state = eigengrain.load(two_balls(run={"steps": 10**6, "until": {"kinetic": 1e-12}}))
    state.run()
    assert 0 < state.step < 10**6 and state.energies.kinetic < 1e-12


def test_bonds_that_break_are_listed():
    state = eigengrain.load({
        "materials": [{"name": "grain", "density": 2500}],
        "contacts": [{"between": ["grain", "grain"], "law": "linear", "kn": 1e5,
                      "bond": {"kind": "parallel", "kn": 1e9, "ks": 1e9, "tension": 1e3}}],
        "balls": [{"position": [0, 0, 0], "radius": 0.005, "material": "grain", "velocity": [-1, 0, 0]},
                  {"position": [0.01, 0, 0], "radius": 0.005, "material": "grain", "velocity": [1, 0, 0]}]})
    assert state.breaks == []
    state.run(200)
    (broken,) = state.breaks
    assert broken.mode == "tension" and {broken.first, broken.second} == {0, 1} and 0 < broken.step <= 200
    np.testing.assert_allclose(broken.place, [0.005, 0, 0], atol=1e-5)
    np.testing.assert_allclose(np.abs(broken.normal), [1, 0, 0], atol=1e-12)


def test_an_exception_of_a_callback_comes_out():
    state = eigengrain.load(two_balls())

    def fail(_):
        raise ZeroDivisionError("mine")

    with pytest.raises(ZeroDivisionError, match="mine"):
        state.run(100, callback=fail, every=10)
    assert state.step == 10


def test_ends_by_time_by_ratio_and_as_the_scene_says():
    state = eigengrain.load(two_balls(timestep={"policy": "fixed", "dt": 1e-5}, run={"steps": 40}))
    state.run()
    assert state.step == 40
    state.run()
    assert state.step == 40
    state.run(time=1e-3)
    assert state.time == pytest.approx(40e-5 + 1e-3, abs=1.01e-5)
    state.run(unbalanced=1e-6)
    assert state.balance.mean < 1e-6 and state.balance.unsupported == 0


@pytest.mark.parametrize("arguments, message", [
    ({}, "does not say how far"), ({"steps": -1}, "from 0 up"), ({"steps": 5, "every": 0}, "from 1 up")])
def test_mistakes_of_a_run(arguments, message):
    with pytest.raises(eigengrain.InputError, match=message):
        eigengrain.load(two_balls()).run(**arguments)


def test_a_run_that_blows_up_leaves_the_state_as_it_was():
    state = eigengrain.load(two_balls(damping={"local": 0}, timestep={"policy": "fixed", "dt": 2e-3}))
    with pytest.raises(eigengrain.SolverError, match="blew up"):
        state.run(100000)
    assert state.step == 0 and np.isfinite(state.bodies.position).all()


def test_relaxation_and_its_end():
    state = eigengrain.load(two_balls())
    result = state.relax(1e-8)
    assert result.converged and result.end.mean < 1e-8 and result.end.unsupported == 0
    mass, k = state.bodies.mass[0], 1e5  # the lower contact carries both balls, the upper one
    np.testing.assert_allclose(sorted(state.contacts.overlap), [mass * 9.81 / k, 2 * mass * 9.81 / k], rtol=1e-6)
    np.testing.assert_allclose(state.wall_forces, [[0, 0, -2 * mass * 9.81]], rtol=1e-6, atol=1e-9)


def test_no_equilibrium_is_an_error_with_its_ratio():
    falling = two_balls(walls=[], balls=[{"position": [0, 0, 0], "radius": 0.005, "material": "grain"}])
    with pytest.raises(eigengrain.SolverError, match="no equilibrium"):
        eigengrain.load(falling).relax(max_steps=50)


def test_balls_are_put_elsewhere():
    state = eigengrain.load(two_balls())
    place = state.bodies.position + [0, 0, 2e-5]
    state.change(position=place, velocity=np.ones((2, 3)))
    np.testing.assert_array_equal(state.bodies.position, place)
    np.testing.assert_array_equal(state.bodies.velocity, np.ones((2, 3)))
    assert len(state.contacts) == 1  # the floor was overlapped by 1e-5 m
    with pytest.raises(eigengrain.InputError, match=r"shape \(2, 3\)"):
        state.change(velocity=np.ones((3, 3)))
    with pytest.raises(eigengrain.InputError, match="row 1"):
        state.change(position=[[0, 0, 0], [0, np.nan, 0]])


INTERRUPTED = """
    import os, signal, threading, eigengrain
    state = eigengrain.load({scene!r})
    threading.Timer(1.0, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
    try:
        state.{work}
    except KeyboardInterrupt:
        state.bodies.position.sum()
        state.run(3)
        print("ended at", state.step)
"""


@pytest.mark.parametrize("work", ["run(10**12)", "run(10**12, callback=lambda state: None, every=10**9)",
                                  "relax(max_steps=10**9)"])
def test_ctrl_c_ends_long_work_between_steps(work):
    # Two balls far above their floor fall for hours.
    deep = [{"plane": {"point": [0, 0, -1e6], "normal": [0, 0, 1]}, "material": "grain"}]
    scene = two_balls(walls=deep) if work.startswith("relax") else dense_packing()
    code = textwrap.dedent(INTERRUPTED).format(scene=scene, work=work)
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("ended at ")


def test_progress_is_a_line_on_the_error_stream():
    code = textwrap.dedent(f"""
        import eigengrain
        state = eigengrain.load({dense_packing()!r})
        state.run(2500, progress=True)
    """)
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0 and done.stdout == ""
    assert "%  step " in done.stderr
