"""Scenes from files and dicts, settings, mistakes, and states that are kept."""
import copy
import json
import pickle

import numpy as np
import pytest
from conftest import dense_packing, two_balls

import eigengrain


def test_a_dict_says_what_the_file_says(tmp_path):
    scene = two_balls(damping={"local": 0.3}, timestep={"policy": "fixed", "dt": "10 us"})
    file = tmp_path / "scene.yaml"
    file.write_text(json.dumps(scene))  # JSON is YAML
    from_file, from_dict = eigengrain.load(file), eigengrain.load(scene)
    for state in (from_file, from_dict):
        state.run(50)
    assert from_file.time == from_dict.time == pytest.approx(50e-5, rel=1e-12)
    np.testing.assert_array_equal(from_file.bodies.position, from_dict.bodies.position)
    assert json.loads(from_file.settings) == json.loads(from_dict.settings)


def test_numbers_of_numpy_and_arrays_of_balls():
    rows = np.array([[0, 0, 0.00499, 0.005], [0, 0, 0.01497, 0.005], [0.1, 1 / 3, 0.2, 0.004]])
    scene = two_balls(gravity=np.array([0, 0, -9.81]), balls=[{"array": rows, "material": "grain"}])
    bodies = eigengrain.load(scene).bodies
    np.testing.assert_array_equal(bodies.in_scene_order(bodies.position), rows[:, :3])
    np.testing.assert_array_equal(bodies.in_scene_order(bodies.radius), rows[:, 3])


def test_overrides_as_of_the_command_line():
    state = eigengrain.load(two_balls(), set={"contacts.0.kn": 2e5, "gravity": [0, 0, -1]})
    assert eigengrain.load(two_balls(), set=["contacts.0.kn=200000.0", "gravity=[0, 0, -1]"]).settings == state.settings
    assert state.system().elements.kn.tolist() == [2e5, 2e5]


def test_every_mistake_is_told_at_once_with_its_place(tmp_path):
    file = tmp_path / "bad.yaml"
    file.write_text("gravty: [0, 0, -9.81]\nmaterials: [{name: grain, density: -1}]\n")
    with pytest.raises(eigengrain.InputError) as caught:
        eigengrain.load(file)
    assert isinstance(caught.value, ValueError)
    assert f"{file}:1: " in str(caught.value) and "gravity" in str(caught.value)
    lines = {line for _, line, _ in caught.value.mistakes}
    assert lines >= {1, 2}


@pytest.mark.parametrize("balls, message", [
    ([{"array": [[0, 0, 0]], "material": "grain"}], r"balls\[0\].array: shape \(n, 4\)"),
    ([{"position": object()}], "not object"),
    ([{"position": [0, 0, 0], "radius": -1, "material": "grain"}], r"the dict.*radius"),
])
def test_mistakes_in_dicts(balls, message):
    with pytest.raises(eigengrain.InputError, match=message):
        eigengrain.load(two_balls(balls=balls))


def test_a_file_that_is_not_there(tmp_path):
    with pytest.raises(eigengrain.InputError, match="nowhere.yaml"):
        eigengrain.load(tmp_path / "nowhere.yaml")


def test_saved_pickled_and_copied_states_go_on_alike(tmp_path):
    state = eigengrain.load(dense_packing())
    state.run(30)
    state.save(tmp_path / "state.h5")
    others = [eigengrain.load(tmp_path / "state.h5"), pickle.loads(pickle.dumps(state)), state.copy(),
              copy.deepcopy(state)]
    state.run(30)
    for other in others:
        assert other.step == 30
        other.run(30)
        np.testing.assert_array_equal(other.bodies.position, state.bodies.position)
        np.testing.assert_array_equal(other.bodies.spin, state.bodies.spin)


def test_other_settings_leave_the_state():
    state = eigengrain.load(dense_packing())
    softer = state.with_settings({"contacts.0.kn": 5e4})
    np.testing.assert_array_equal(softer.bodies.position, state.bodies.position)
    assert set(softer.system().elements.kn) == {5e4}
    assert set(state.system().elements.kn) == {1e5}
    with pytest.raises(eigengrain.InputError, match="kn"):
        state.with_settings({"contacts.0.kn": -1})


def test_threads():
    before = eigengrain.threads()
    eigengrain.set_threads(1)
    assert eigengrain.threads() == 1
    eigengrain.set_threads(before)


def test_h5py_in_one_process_reads_what_is_written(tmp_path):
    h5py = pytest.importorskip("h5py")
    state = eigengrain.load(two_balls())
    state.save(tmp_path / "state.h5")
    with h5py.File(tmp_path / "state.h5") as file:
        np.testing.assert_array_equal(file["bodies/position"][:], state.bodies.position)
    with h5py.File(tmp_path / "other.h5", "w") as file:
        file["x"] = np.arange(3)
    state.save(tmp_path / "again.h5")
    assert eigengrain.load(tmp_path / "again.h5").step == 0
