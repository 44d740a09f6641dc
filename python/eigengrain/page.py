"""A state or a mode as one HTML page, to be turned and looked into with any browser; it needs no network."""
from __future__ import annotations

import base64
import html
import json
import os
import re
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import ArrayLike

from .errors import InputError
from .results import Floats
from .spectrum import Modes
from .state import State
from .system import System

Colour = Union[str, ArrayLike, Mapping[str, ArrayLike]]

#: What balls may be coloured by: name -> (what the page calls it, unit)
COLUMNS = {"force": ("sum of normal forces", "N"), "speed": ("speed", "m/s"), "radius": ("radius", "m"),
           "displacement": ("displacement in the mode", "of the largest")}
UNITS = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6, "µm": 1e-6, "nm": 1e-9, "dm": 1e-1, "km": 1e3}
SIDES = {"-x": (0, 0), "+x": (0, 1), "-y": (1, 0), "+y": (1, 1), "-z": (2, 0), "+z": (2, 1)}


def page(shown: State | System, path: str | os.PathLike[str], *, mode: Optional[Modes | tuple[Modes, int]] = None,
         colour: Optional[Colour] = None, chains: bool = True, colours: str = "viridis",
         title: Optional[str] = None) -> Path:
    """Writes a page that shows balls, clumps, walls and contact forces in three dimensions; returns where it is.

    shown: a state, or a system, of which the state that it was made of is shown.
    path: of the page, e.g. "bed.html": one file that needs nothing beside itself, no network either.
    mode: modes to be seen in motion, all of `modes`, or the k-th alone as (modes, k).
    colour: what balls are coloured by first: "radius", "speed", "force", with a mode "displacement"; or numbers of your own,
        (n,) in the order of the rows, or {label: numbers}. The page has the others to choose from.
    chains: contact forces too; they take 36 bytes a contact.
    colours: a colour map of matplotlib; viridis and cividis are told apart with any colour vision and in grey.
    title: by default the name of the scene.

    Needs matplotlib, and h5py for clumps in modes and for walls that have moved. Raises RuntimeError where the package was
    built without three.js.
    """
    scripts = _scripts()
    state = shown if isinstance(shown, State) else shown._state
    bodies = state.bodies
    if len(bodies) == 0:
        raise InputError(f"{state.name}: no balls to show")
    modes, chosen = (mode, range(len(mode))) if isinstance(mode, Modes) else (mode[0], [mode[1]]) if mode else (None, [])
    if modes is not None and (len(modes.shapes) == 0 or len(modes._system.translation_block) != len(bodies)):
        raise InputError("mode: modes of this state are wanted, with their shapes")
    scene = _Scene(state)
    contacts = state.contacts
    arrays = _Arrays()
    middle, size = scene.middle, scene.size
    data: dict[str, Any] = {
        "title": title or Path(state.name).name,
        "facts": f"{len(bodies):,} balls, {len(contacts):,} contacts, t = {state.time:.4g} s",
        "extent": scene.extent,
        "size": size, "flat": scene.flat,
        "position": arrays.add((bodies.position - middle) / size), "radius": arrays.add(bodies.radius / size),
        "identity": arrays.add(bodies.identity, np.int32), "lines": arrays.add(scene.frame()),
        "walls": [{"triangles": arrays.add((corners - middle) / size), "oneSided": one_sided}
                  for corners, one_sided in scene.walls()],
        "modes": [],
    }
    for k in chosen:
        moved = scene.displacement(modes, k)
        largest = np.linalg.norm(moved, axis=1).max(initial=0.0)
        data["modes"].append({"displacement": arrays.add(moved / largest if largest > 0 else moved),
                              "participation": float(modes.participation[k]),
                              "name": f"{k + 1}: {modes.frequencies[k]:.5g} rad/s"})
    first, columns = _chosen_first(colour, _columns(state, contacts, bool(data["modes"])), len(bodies))
    data["columns"] = [{"name": name, "unit": unit, **_scaled(values, arrays)} for name, unit, values in columns]
    data["first"] = first
    if chains:
        data["chains"] = _chains(state, contacts, scene, arrays)
    data["colours"] = _colour_table(colours)
    text = _filled((Path(__file__).parent / "page.html").read_text(encoding="utf-8"), {
        "TITLE": html.escape(data["title"]), "THREE_LICENSE": scripts["LICENSE"], "THREE": scripts["three.module.min.js"],
        "CONTROLS": scripts["OrbitControls.js"], "SCRIPT": (Path(__file__).parent / "page.js").read_text(encoding="utf-8"),
        "DATA": json.dumps(data, ensure_ascii=False).replace("<", "\\u003c"), "ARRAYS": arrays.text()})
    path = Path(path)
    path.write_text(text, encoding="utf-8")
    return path


def _scripts() -> dict[str, str]:
    folder = Path(__file__).parent / "three"
    if not (folder / "VERSION").exists():
        raise RuntimeError("this build of eigengrain has no three.js, which pages are shown with: install npm and build again "
                           f"(or, from the sources: python/three/fetch.sh {folder})")
    return {file.name: file.read_text(encoding="utf-8") for file in folder.iterdir()}


def _filled(template: str, parts: dict[str, str]) -> str:
    """All at once: what is filled in may have anything in it."""
    return re.sub(r"\{\{([A-Z_]+)\}\}", lambda place: parts[place[1]], template)


class _Arrays:
    """Numbers of a page, as base64 of their little-endian bytes."""

    def __init__(self) -> None:
        self._texts: list[str] = []

    def add(self, numbers: ArrayLike, kind: Any = np.float32) -> int:
        """Which one it is in the page; rows behind each other."""
        self._texts.append(base64.b64encode(np.ascontiguousarray(numbers, dtype=np.dtype(kind).newbyteorder("<"))).decode())
        return len(self._texts) - 1

    def text(self) -> str:
        return "\n".join(f'<script type="text/plain" class="array">{text}</script>' for text in self._texts)


def _scaled(values: Optional[Floats], arrays: _Arrays) -> dict[str, Any]:
    """Values as 0 to 1 between the ends of the colour bar; a few that stick out far do not take all the colours.

    None: the page takes them from the mode that it shows.
    """
    if values is None or len(values) == 0:
        return {"low": 0.0, "high": 1.0, "above": False, "values": -1}
    low, high, most = float(values.min()), float(values.max()), float(np.quantile(values, 0.995))
    if 0 <= low < 0.2 * high:
        low = 0.0
    above = low < most and low + 1.5 * (most - low) < high
    end = most if above else high
    # Where all are alike they have the colour of the middle.
    parts = (values - low) / (end - low) if end > low else np.full(len(values), 0.5)
    return {"low": low, "high": end, "above": above, "values": arrays.add(parts)}


def _columns(state: State, contacts: Any, moving: bool) -> list[tuple[str, str, Optional[Floats]]]:
    bodies = state.bodies
    pressed, between = np.maximum(contacts.normal_force, 0), contacts.b >= 0
    force = np.bincount(contacts.a, weights=pressed, minlength=len(bodies))
    force += np.bincount(contacts.b[between], weights=pressed[between], minlength=len(bodies))
    found = {"force": force, "speed": np.linalg.norm(bodies.velocity, axis=1), "radius": bodies.radius}
    if moving:
        found = {"displacement": None} | found
    return [(*COLUMNS[name], values) for name, values in found.items()]


def _chosen_first(colour: Optional[Colour], columns: list[tuple[str, str, Optional[Floats]]],
                  count: int) -> tuple[int, list[tuple[str, str, Optional[Floats]]]]:
    if colour is None:
        return 0, columns
    if isinstance(colour, str):
        names = [name for name, _, _ in columns]
        if colour not in COLUMNS or COLUMNS[colour][0] not in names:
            known = [name for name, (label, _) in COLUMNS.items() if label in names]
            raise InputError(f'colour: "{colour}"; write one of {", ".join(known)}, or give numbers')
        return names.index(COLUMNS[colour][0]), columns
    given = colour if isinstance(colour, Mapping) else {"numbers that were given": colour}
    own = []
    for name, numbers in given.items():
        values = np.asarray(numbers, dtype=float)
        if values.shape != (count,) or not np.isfinite(values).all():
            raise InputError(f"colour: {name} has the shape {values.shape}; {count} finite numbers are wanted, one a ball")
        own.append((name, "", values))
    return 0, own + columns


def _chains(state: State, contacts: Any, scene: _Scene, arrays: _Arrays) -> dict[str, Any]:
    """Contacts that press as lines from the centre of the first ball, as thick as the root of their force."""
    bodies = state.bodies
    pressed = contacts.normal_force > 0
    a, b, force = contacts.a[pressed], contacts.b[pressed], contacts.normal_force[pressed]
    start = bodies.position[a]
    length = bodies.radius[a] + bodies.radius[b] - contacts.overlap[pressed]
    end = np.where((b >= 0)[:, None], start + length[:, None] * contacts.normal[pressed], contacts.point[pressed])
    mean = force.mean() if len(force) else 1.0
    thick = 0.12 * bodies.radius.mean() * np.clip(np.sqrt(force / mean), 0.15, 3)
    return {"start": arrays.add((start - scene.middle) / scene.size), "end": arrays.add((end - scene.middle) / scene.size),
            "thick": arrays.add(thick / scene.size), "a": arrays.add(a, np.int32), "b": arrays.add(b, np.int32),
            "count": len(force), **_scaled(force, arrays)}


def _colour_table(name: str) -> list[int]:
    """(256 × 3) bytes."""
    import matplotlib
    try:
        colours = matplotlib.colormaps[name]
    except KeyError:
        raise InputError(f'colours: matplotlib has no "{name}"; write e.g. viridis or cividis') from None
    return np.rint(255 * colours(np.linspace(0, 1, 256))[:, :3]).astype(int).ravel().tolist()


class _Scene:
    """Where things are, and what of them only a state file says."""

    def __init__(self, state: State) -> None:
        self._state = state
        self._settings = json.loads(state.settings)
        self._file: Optional[dict[str, Any]] = None
        bodies = state.bodies
        # Meshes belong to what is seen; planes have no end, and are shown as far as the rest goes.
        self._planes = self._read_planes()
        self._surfaces = self._read_surfaces()
        points = [bodies.position - bodies.radius[:, None], bodies.position + bodies.radius[:, None]]
        points += [corners.reshape(-1, 3) for corners, _ in self._surfaces]
        self._fit(points)
        if state.cell[2].any():
            self._fit(points + [self._box().reshape(-1, 3)])
        planar = self._settings.get("planar")
        #: the axis across a plane, where all is in one
        self.flat = "xyz".index(planar.get("normal", "z")) if planar is not None else -1

    def _fit(self, points: list[Floats]) -> None:
        self.low = np.min([some.min(axis=0) for some in points], axis=0)
        self.high = np.max([some.max(axis=0) for some in points], axis=0)
        self.middle = 0.5 * (self.low + self.high)
        self.size = 0.5 * float(np.linalg.norm(self.high - self.low))

    @property
    def extent(self) -> str:
        edges = self.high - self.low
        unit, name = (1.0, "m") if edges.max() >= 1 else (1e3, "mm") if edges.max() >= 1e-3 else (1e6, "µm")
        return " × ".join(f"{unit * edge:.3g}" for edge in edges) + f" {name}"

    def frame(self) -> Floats:
        """(12, 2, 3) edges of the periodic cell, or of the box around everything."""
        return (self._box() - self.middle) / self.size

    def _box(self) -> Floats:
        edges, origin, periodic = self._state.cell
        edges, origin = np.array(edges), np.array(origin)
        for k in range(3):
            if not periodic[k]:  # no end there: as far as the balls go
                edges[:, k] = 0
                edges[k, k], origin[k] = self.high[k] - self.low[k], self.low[k]
        lines = []
        for k in range(3):
            i, j = (k + 1) % 3, (k + 2) % 3
            for at in [(0, 0), (0, 1), (1, 0), (1, 1)]:
                start = origin + at[0] * edges[:, i] + at[1] * edges[:, j]
                lines.append((start, start + edges[:, k]))
        return np.array(lines)

    def walls(self) -> list[tuple[Floats, bool]]:
        """(triangles as corners (3 t, 3) in m, whether they are seen from their active side alone) of each wall."""
        found = []
        margin = 0.02 * self.size
        low, high = self.low - margin, self.high + margin
        for point, normal in self._planes:
            corners = _section(point, normal, low, high)
            if len(corners) >= 3:
                found.append((np.concatenate([[corners[0], corners[k], corners[k + 1]] for k in range(1, len(corners) - 1)]), True))
        return found + self._surfaces

    def displacement(self, modes: Modes, k: int) -> Floats:
        """(n, 3) of each ball, those of clumps turning with them."""
        u, turn = modes.motion(k)
        owner = self._state.bodies.owner
        if (owner == np.arange(len(owner))).all():
            return u
        moved = u[owner]
        clumps = self._from_file()["clumps"]
        for q in range(len(clumps["position"])):
            rows = clumps["member"][clumps["starts"][q]:clumps["starts"][q + 1]]
            lever = self._state.bodies.position[rows] - clumps["position"][q]
            moved[rows] += np.cross(turn[owner[rows]], lever)
        return moved

    def _read_planes(self) -> list[tuple[Floats, Floats]]:
        """(point, unit normal) of each, in the order of their numbers; box by box and side by side."""
        found = []
        for entry in self._settings.get("walls", []):
            if "plane" in entry:
                point, normal = _lengths(entry["plane"]["point"]), np.array([float(x) for x in entry["plane"]["normal"]])
                found.append((entry, point, point, normal / np.linalg.norm(normal)))
            elif "box" in entry:
                corners = [_lengths(entry["box"]["min"]), _lengths(entry["box"]["max"])]
                for side, (axis, upper) in SIDES.items():
                    if side not in entry["box"].get("open", []):
                        found.append((entry, corners[upper], 0.5 * (corners[0] + corners[1]),
                                      (-1 if upper else 1) * np.eye(3)[axis]))
        result = []
        for number, (entry, point, centre, normal) in enumerate(found):
            turn, at, start = self._moved(number, entry, centre)
            result.append((at + turn @ (point - start), turn @ normal))
        return result

    def _read_surfaces(self) -> list[tuple[Floats, bool]]:
        """Polygons and meshes, which are numbered behind the planes."""
        result = []
        for entry in self._settings.get("walls", []):
            if "polygon" in entry:
                corners = np.array([_lengths(corner) for corner in entry["polygon"]["corners"]])
                places, shape = corners, entry["polygon"]
                triangles = np.concatenate([[corners[0], corners[k], corners[k + 1]] for k in range(1, len(corners) - 1)])
            elif "mesh" in entry:
                shape = entry["mesh"]
                triangles = UNITS[shape["unit"]] * _read_mesh(Path(shape["file"]))
                places = np.unique(triangles, axis=0)
            else:
                continue
            turn, at, start = self._moved(len(self._planes) + len(result), entry, places.mean(axis=0))
            result.append((at + (triangles - start) @ turn.T, False))
        return result

    def _moved(self, number: int, entry: dict[str, Any], centre: Floats) -> tuple[Floats, Floats, Floats]:
        """(rotation, centre now, centre at first) of a wall."""
        if "centre" in entry:
            centre = _lengths(entry["centre"])
        if {"velocity", "spin", "motion", "motion_file", "servo"} & set(entry):
            moving = self._from_file().get("moving_walls")
            if moving is not None and number in moving["wall"]:
                row = int(np.flatnonzero(moving["wall"] == number)[0])
                return _rotation(moving["orientation"][row]), moving["centre"][row], centre
        return np.eye(3), centre, centre

    def _from_file(self) -> dict[str, Any]:
        """Clumps and walls that move, of which only a state file says where they are."""
        if self._file is None:
            try:
                import h5py
            except ImportError as missing:
                raise ImportError("h5py is not installed (Debian: python3-h5py)") from missing
            with tempfile.TemporaryDirectory() as folder:
                name = Path(folder) / "state.h5"
                self._state.save(name)
                with h5py.File(name) as file:
                    self._file = {group: {key: rows[()] for key, rows in file[group].items()}
                                  for group in ("clumps", "moving_walls") if group in file}
        return self._file


def _lengths(texts: list[Any]) -> Floats:
    """m of lengths as scenes have them: "5 mm", "0.005"."""
    result = []
    for text in texts:
        number, unit = re.fullmatch(r"\s*([-+.\deE]*\d\.?)\s*(\S*)\s*", str(text)).groups()
        result.append(float(number) * (UNITS[unit] if unit else 1.0))
    return np.array(result)


def _rotation(q: Floats) -> Floats:
    """The matrix of a unit quaternion x, y, z, w."""
    x, y, z, w = q
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def _section(point: Floats, normal: Floats, low: Floats, high: Floats) -> list[Floats]:
    """Corners of what a box cuts out of a plane, counter-clockwise about its normal; none where they do not meet."""
    crossings = []
    for axis in range(3):
        i, j = (axis + 1) % 3, (axis + 2) % 3
        if abs(normal[axis]) < 1e-12:
            continue
        for a in (low[i], high[i]):
            for b in (low[j], high[j]):
                x = np.empty(3)
                x[i], x[j] = a, b
                x[axis] = point[axis] - (normal[i] * (a - point[i]) + normal[j] * (b - point[j])) / normal[axis]
                if low[axis] <= x[axis] <= high[axis]:
                    crossings.append(x)
    if len(crossings) < 3:
        return []
    middle = np.mean(crossings, axis=0)
    across = crossings[0] - middle
    beside = np.cross(normal, across)
    return sorted(crossings, key=lambda x: np.arctan2((x - middle) @ beside, (x - middle) @ across))


def _read_mesh(file: Path) -> Floats:
    """(3 t, 3) corners of the triangles of an STL or OBJ file that the reader of scenes has taken."""
    data = file.read_bytes()
    if file.suffix.lower() == ".obj":
        vertices, corners = [], []
        for words in (line.split() for line in data.decode("utf-8", "replace").splitlines()):
            if words[:1] == ["v"]:
                vertices.append([float(x) for x in words[1:4]])
            elif words[:1] == ["f"]:
                face = [int(word.split("/")[0]) for word in words[1:]]
                face = [k - 1 if k > 0 else len(vertices) + k for k in face]
                corners += [(face[0], face[k], face[k + 1]) for k in range(1, len(face) - 1)]
        return np.array(vertices)[np.array(corners).ravel()]
    count = int.from_bytes(data[80:84], "little") if len(data) >= 84 else -1
    if len(data) == 84 + 50 * count:
        rows = np.frombuffer(data, dtype=np.dtype([("x", "<f4", (4, 3)), ("rest", "<u2")]), offset=84)
        return rows["x"][:, 1:].reshape(-1, 3).astype(float)
    return np.array([[float(x) for x in line.split()[1:4]] for line in data.decode("utf-8", "replace").splitlines()
                     if line.split()[:1] == ["vertex"]])
