"""Scenes and states from files, and scenes from Python."""
from __future__ import annotations

import json
import os
import tempfile
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, Union

import numpy as np

from . import _core
from .errors import InputError
from .state import State

Settings = Union[Mapping[str, Any], Iterable[str]]


def load(source: str | os.PathLike[str] | Mapping[str, Any], set: Settings = ()) -> State:
    """A state, from a scene or from a state that was saved.

    source: a scene file (YAML), a state file (HDF5), or a scene as a dict: the keys of scene files, with values as
        there ("5 mm" or 0.005). Paths in a dict are relative to the current folder. In a dict an entry of `balls` may
        have `array`, of shape (n, 4) with x, y, z, r a row (m), in the place of `file`.
    set: overrides as {"contacts.0.ks": 0} or ["contacts.0.ks=0"], as `--set` of the program.

    Raises InputError with every mistake that was found.
    """
    overrides = as_overrides(set)
    if isinstance(source, Mapping):
        with tempfile.TemporaryDirectory() as folder:
            text = json.dumps(_with_files(dict(source), Path(folder)), default=_plain)
            return State(_core.State(text, os.getcwd(), "the dict", overrides))
    return State(_core.State.read(os.fspath(source), overrides))


def as_overrides(set: Settings) -> list[str]:
    """Overrides as the program takes them: key=value, the value as YAML."""
    if isinstance(set, Mapping):
        return [f"{key}={value if isinstance(value, str) else json.dumps(value, default=_plain)}"
                for key, value in set.items()]
    if isinstance(set, str):
        return [set]
    return list(set)


def _plain(value: Any) -> Any:
    """What JSON does not know."""
    if isinstance(value, (np.ndarray, np.generic)):
        return value.tolist()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    raise InputError(f"a scene has numbers, texts, flags, lists and dicts, not {type(value).__name__}: {value!r}")


def _with_files(scene: dict[str, Any], folder: Path) -> dict[str, Any]:
    """Arrays of balls as packing files, which keep every bit."""
    balls = scene.get("balls")
    if not isinstance(balls, (list, tuple)):
        return scene
    entries = []
    for number, entry in enumerate(balls):
        if isinstance(entry, Mapping) and "array" in entry:
            rows = np.asarray(entry["array"], dtype=float)
            if rows.ndim != 2 or rows.shape[1] != 4:
                raise InputError(f"balls[{number}].array: shape (n, 4) is wanted, x, y, z, r a row, not {rows.shape}")
            file = folder / f"balls{number}.txt"
            np.savetxt(file, rows, fmt="%.17g")
            entry = {key: value for key, value in entry.items() if key != "array"} | {"file": str(file)}
        entries.append(entry)
    return scene | {"balls": entries}
