"""Pages in three dimensions have in them what they are of; where there is a browser, it shows them."""
import base64
import json
import pathlib
import re
import shutil
import subprocess

import numpy as np
import pytest
from conftest import two_balls

import eigengrain

PACKAGE = pathlib.Path(eigengrain.__file__).parent
BROWSER = next(filter(None, map(shutil.which, ["chromium", "chromium-browser", "google-chrome"])), None)
needs_three = pytest.mark.skipif(not (PACKAGE / "three" / "VERSION").exists(), reason="built without three.js (npm)")


class Page:
    """A page taken apart again."""

    def __init__(self, path):
        self.text = path.read_text(encoding="utf-8")
        self.data = json.loads(re.search(r'<script type="application/json" id="data">(.*?)</script>', self.text)[1])
        self._arrays = re.findall(r'class="array">(.*?)</script>', self.text)

    def array(self, k, kind="<f4"):
        return np.frombuffer(base64.b64decode(self._arrays[k]), kind)

    def points(self, k):
        return self.array(k).reshape(-1, 3)


def seen(path, tmp_path):
    """What a browser makes of a page: its picture, and what its console says."""
    picture = tmp_path / "page.png"
    run = subprocess.run(
        [BROWSER, "--headless", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
         "--hide-scrollbars", "--window-size=1000,700", "--virtual-time-budget=4000", "--enable-logging=stderr",
         f"--user-data-dir={tmp_path / 'browser'}", f"--screenshot={picture}", path.resolve().as_uri()],
        capture_output=True, text=True, timeout=120)
    import matplotlib.image
    return matplotlib.image.imread(picture)[..., :3], [line for line in run.stderr.splitlines() if "CONSOLE" in line]


@needs_three
def test_a_page_has_the_balls_and_needs_nothing_else(small, tmp_path):
    path = eigengrain.page(small, tmp_path / "small.html", title="a < b & {{DATA}}")
    page = Page(path)
    bodies, contacts = small.bodies, small.contacts
    size = page.data["size"]
    # Single precision of numbers within 1 is what a screen can show.
    places = page.points(page.data["position"])
    np.testing.assert_allclose(places - places[0], (bodies.position - bodies.position[0]) / size, atol=3e-7)
    np.testing.assert_allclose(page.array(page.data["radius"]), bodies.radius / size, rtol=1e-6)
    np.testing.assert_array_equal(page.array(page.data["identity"], "<i4"), bodies.identity)
    assert np.linalg.norm(places, axis=1).max() < 1
    assert page.data["chains"]["count"] == len(contacts)
    start, end = page.points(page.data["chains"]["start"]), page.points(page.data["chains"]["end"])
    np.testing.assert_allclose(end - start, contacts.branch / size, atol=3e-7)
    force = page.data["columns"][page.data["first"]]
    values = force["low"] + page.array(force["values"]) * (force["high"] - force["low"])
    assert force["name"] == "sum of normal forces"
    assert values.sum() == pytest.approx(2 * contacts.normal_force.sum(), rel=1e-5)  # no walls: each counts for two
    assert len(page.data["lines"] and page.points(page.data["lines"])) == 24
    assert "a &lt; b &amp; {{DATA}}" in page.text
    # All of it is in the file: nothing is asked for elsewhere.
    page_itself = re.sub(r'<script type="text/plain" id="(three|controls)">.*?</script>', "", page.text, flags=re.S)
    assert not re.search(r'(src|href)\s*=|url\(|https?://', page_itself)


@needs_three
def test_colours_of_ones_own(small, tmp_path):
    height = small.bodies.position[:, 2]
    page = Page(eigengrain.page(small, tmp_path / "page.html", colour={"height": height}, colours="cividis", chains=False))
    first = page.data["columns"][page.data["first"]]
    assert first["name"] == "height" and "chains" not in page.data
    np.testing.assert_allclose(first["low"] + page.array(first["values"]) * (first["high"] - first["low"]), height, atol=1e-7)
    named = Page(eigengrain.page(small, tmp_path / "page.html", colour="radius"))
    assert named.data["columns"][named.data["first"]]["name"] == "radius"


@needs_three
def test_a_mode_moves_its_balls(small, tmp_path):
    system = small.system()
    modes = system.lowest_modes(3)
    page = Page(eigengrain.page(system, tmp_path / "mode.html", mode=modes))
    assert len(page.data["modes"]) == 3
    u, _ = modes.motion(2)
    np.testing.assert_allclose(page.points(page.data["modes"][2]["displacement"]), u / np.linalg.norm(u, axis=1).max(),
                               atol=1e-6)
    assert page.data["columns"][page.data["first"]]["values"] == -1  # by the mode that is shown
    one = Page(eigengrain.page(small, tmp_path / "mode.html", mode=(modes, 1)))
    assert [mode["name"] for mode in one.data["modes"]] == [page.data["modes"][1]["name"]]


@needs_three
def test_clumps_move_as_one_in_modes(tmp_path):
    pytest.importorskip("h5py")
    shape = [{"at": [0, 0, 0], "radius": 0.005}, {"at": [0.007, 0, 0], "radius": 0.004}, {"at": [0, 0.006, 0.002], "radius": 0.004}]
    state = eigengrain.load(two_balls(clumps=[{"balls": shape, "material": "grain", "instances": [
        {"position": [0.0071, 0.001, 0.0049], "axis": [1, 2, 3], "angle": 0.7}]}]))
    modes = state.system().all_modes(shapes=True)
    k = len(modes) - 1
    page = Page(eigengrain.page(state, tmp_path / "clumps.html", mode=(modes, k)))
    moved = page.points(page.data["modes"][0]["displacement"]).astype(float)
    owner, place = state.bodies.owner, state.bodies.position
    holder = owner[owner != np.arange(len(owner))][0]
    rows = np.flatnonzero(owner == holder)
    assert len(rows) == 3 and np.linalg.norm(moved[rows], axis=1).min() > 1e-3
    for i in rows:  # a rigid body: no distance changes to first order
        for j in rows:
            assert abs((place[i] - place[j]) @ (moved[i] - moved[j])) < 1e-6 * np.linalg.norm(place[i] - place[j]) + 1e-12
    assert max(np.linalg.norm(moved[i] - moved[rows[0]]) for i in rows) > 1e-3  # and it turns


@needs_three
def test_walls_are_where_they_have_moved_to(tmp_path):
    pytest.importorskip("h5py")
    scene = two_balls()
    scene["walls"] = [{"plane": {"point": ["0 mm", 0, 0], "normal": [0, 0, 2]}, "material": "grain"},
                      {"box": {"min": [-0.02, -0.02, 0], "max": ["20 mm", 0.02, 0.03], "open": ["-z", "+z"]}, "material": "grain",
                       "velocity": [0, 0.01, 0]},
                      {"polygon": {"corners": [[-0.01, -0.01, 0.025], [0.01, -0.01, 0.025], [0, 0.01, 0.025]], "two_sided": True},
                       "material": "grain", "velocity": [0, 0, 0.1]}]
    state = eigengrain.load(scene)
    state.run(time=0.05)
    page = Page(eigengrain.page(state, tmp_path / "walls.html"))
    size = page.data["size"]
    # The middle of the page, from a ball whose place is known.
    middle = state.bodies.position[0] - size * page.points(page.data["position"])[0].astype(float)
    walls = [middle + size * page.points(wall["triangles"]).astype(float) for wall in page.data["walls"]]
    moved = 0.01 * state.time
    floor, polygon = walls[0], walls[-1]
    np.testing.assert_allclose(floor[:, 2], 0, atol=1e-8)
    np.testing.assert_allclose(polygon[:, 2], 0.025 + 0.1 * state.time, atol=1e-8)
    assert [wall["oneSided"] for wall in page.data["walls"]][-1] is False
    # What is seen of the sides of a box: those that are no farther away than balls and polygons reach.
    for side in walls[1:-1]:
        assert np.ptp(side, axis=0).min() < 1e-7
        axis = int(np.argmin(np.ptp(side, axis=0)))
        assert abs(abs(side[0, axis] - (moved if axis == 1 else 0)) - 0.02) < 1e-7
    assert np.cross(floor[1] - floor[0], floor[2] - floor[0])[2] > 0  # faces the balls


@needs_three
def test_meshes_turn(examples, tmp_path):
    pytest.importorskip("h5py")
    drum = eigengrain.load(examples / "scenes" / "drum.yaml")
    before = Page(eigengrain.page(drum, tmp_path / "drum.html"))
    drum.run(time=0.15)
    after = Page(eigengrain.page(drum, tmp_path / "drum.html"))

    def corners(page, state):
        middle = state.bodies.position[0] - page.data["size"] * page.points(page.data["position"])[0].astype(float)
        return middle + page.data["size"] * page.points(page.data["walls"][-1]["triangles"]).astype(float)

    first, last = corners(before, eigengrain.load(examples / "scenes" / "drum.yaml")), corners(after, drum)
    # It speeds up to 6 rad/s in 0.1 s, about y: 0.3 rad, and turns on.
    angle = 0.3 + 6 * (drum.time - 0.1)
    turn = np.array([[np.cos(angle), 0, np.sin(angle)], [0, 1, 0], [-np.sin(angle), 0, np.cos(angle)]])
    np.testing.assert_allclose(last, first @ turn.T, atol=1e-7)


@needs_three
def test_what_the_documentation_says(small, examples, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text = (examples.parent / "docs" / "python.md").read_text()
    (block,) = [one for one in re.findall(r"```python\n(.*?)```", text, flags=re.S) if "eigengrain.page(" in one]
    system = small.system()
    exec(block, {"eigengrain": eigengrain, "bed": small, "system": system, "low": system.lowest_modes(2)})
    assert {path.name for path in tmp_path.iterdir()} == {"bed.html", "modes.html", "height.html"}


@needs_three
def test_where_all_are_alike_there_is_one_colour(tmp_path):
    page = Page(eigengrain.page(eigengrain.load(two_balls()), tmp_path / "page.html", colour="radius"))
    column = page.data["columns"][page.data["first"]]
    assert column["low"] == column["high"] == 0.005
    np.testing.assert_array_equal(page.array(column["values"]), 0.5)


@needs_three
def test_mistakes_are_told(small, tmp_path):
    path = tmp_path / "page.html"
    with pytest.raises(eigengrain.InputError, match="force, speed, radius"):
        eigengrain.page(small, path, colour="displacement")
    with pytest.raises(eigengrain.InputError, match="one a ball"):
        eigengrain.page(small, path, colour=np.ones(3))
    with pytest.raises(eigengrain.InputError, match="viridis"):
        eigengrain.page(small, path, colours="veridis")
    with pytest.raises(eigengrain.InputError, match="modes of this state"):
        eigengrain.page(eigengrain.load(two_balls()), path, mode=small.system().lowest_modes(1))
    assert not path.exists()


def test_without_three_it_says_what_to_install(small, tmp_path, monkeypatch):
    import sys
    module = sys.modules["eigengrain.page"]
    monkeypatch.setattr(module, "__file__", str(tmp_path / "page.py"))
    with pytest.raises(RuntimeError, match="install npm"):
        eigengrain.page(small, tmp_path / "page.html")


@needs_three
@pytest.mark.skipif(BROWSER is None, reason="no chromium")
@pytest.mark.parametrize("what", ["state", "mode"])
def test_a_browser_shows_it(what, small, tmp_path):
    modes = small.system().lowest_modes(2) if what == "mode" else None
    path = eigengrain.page(small, tmp_path / "page.html", mode=modes, colour="radius")
    picture, console = seen(path, tmp_path)
    assert console == []
    middle = picture[100:600, 300:900]
    ground = picture[2, -2]
    # Balls fill the middle, in many colours; they are not grey as walls, text and ground are.
    coloured = (middle.max(axis=2) - middle.min(axis=2)) > 0.15
    assert coloured.mean() > 0.25
    assert np.abs(middle - ground).max(axis=2).std() > 0.05
    assert len(np.unique((8 * middle[coloured]).astype(int), axis=0)) > 20
