"""What docs/python.md says, run as it stands."""
import os
import pathlib
import re

import matplotlib

matplotlib.use("Agg")
import numpy as np
import pytest

ROOT = pathlib.Path(os.environ["EIGENGRAIN_EXAMPLES"]).parent


@pytest.fixture(scope="module")
def blocks():
    return re.findall(r"```python\n(.*?)```", (ROOT / "docs" / "python.md").read_text(), flags=re.S)


@pytest.fixture
def folder(tmp_path, monkeypatch):
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_in_ten_minutes(blocks, folder):
    names = {}
    exec(compile(blocks[0], "docs/python.md", "exec"), names)
    for picture in ("force_chains.png", "mode.png", "density.png"):
        assert (folder / picture).stat().st_size > 10_000
    assert names["bed"].balance.mean < 1e-6
    low, high, system = names["low"], names["high"], names["system"]
    assert len(low) == len(high) == 20
    mass = system.mass
    for modes, size in ((low, 1e-5), (high, 1e-7)):
        for k in range(20):  # eigenpairs of the matrices for scipy
            x, value = modes.shapes[k], modes.eigenvalues[k]
            residual = system.K @ x - value * mass * x
            assert np.sqrt((residual**2 / mass).sum()) < size * value


def test_scenes_as_dicts(blocks, folder):
    names = {"eigengrain": __import__("eigengrain"), "rows": np.array([[0.05, 0.05, 0.05, 0.005]])}
    exec(compile(blocks[1], "docs/python.md", "exec"), names)
    assert len(names["state"].bodies) == 1


def test_matrices_in_hdf5(folder):
    h5py = pytest.importorskip("h5py")
    assert h5py
    import eigengrain
    system = eigengrain.load(ROOT / "examples" / "scenes" / "three_balls.yaml").system()
    system.export(".", ["h5"])
    (block,) = re.findall(r"```python\n(.*?)```", (ROOT / "docs" / "matrix-files.md").read_text(), flags=re.S)
    names = {}
    exec(compile(block, "docs/matrix-files.md", "exec"), names)
    assert (names["matrix"] != system.K).nnz == 0
