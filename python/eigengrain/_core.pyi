"""The compiled part, as the package uses it; users find everything in the package itself."""
from __future__ import annotations

from collections.abc import Callable
from typing import Any, Optional

import numpy as np
from numpy.typing import NDArray

__version__: str

def set_threads(threads: int) -> None: ...
def threads() -> int: ...
def schema_markdown() -> str: ...
def set_petsc_options(options: str) -> None: ...

class Contacts:
    a: NDArray[np.int32]
    b: NDArray[np.int32]
    wall: NDArray[np.int32]
    rule: NDArray[np.int32]
    image: NDArray[np.int8]
    normal: NDArray[np.float64]
    branch: NDArray[np.float64]
    point: NDArray[np.float64]
    force: NDArray[np.float64]
    overlap: NDArray[np.float64]
    slides: NDArray[np.uint8]
    bonded: NDArray[np.uint8]
    rattler: NDArray[np.uint8]

class State:
    identity: NDArray[np.int64]
    position: NDArray[np.float64]
    radius: NDArray[np.float64]
    mass: NDArray[np.float64]
    inertia: NDArray[np.float64]
    material: NDArray[np.int32]
    fixed: NDArray[np.uint8]
    velocity: NDArray[np.float64]
    spin: Optional[NDArray[np.float64]]
    orientation: Optional[NDArray[np.float64]]
    force: NDArray[np.float64]
    moment: Optional[NDArray[np.float64]]
    owner: NDArray[np.int32]
    size: int
    walls: int
    time: float
    step: int
    dt: float
    next_dt: float
    name: str
    settings: str
    notes: list[str]
    has_stages: bool
    goal_steps: Optional[int]
    goal_time: Optional[float]
    goal_unbalanced: Optional[float]
    cell: tuple[NDArray[np.float64], list[float], list[bool]]
    def __init__(self, yaml: str, folder: str, name: str, overrides: list[str]) -> None: ...
    @staticmethod
    def read(file: str, overrides: list[str]) -> State: ...
    def write(self, file: str) -> None: ...
    def copy(self) -> State: ...
    def run(self, steps: int, until: float, report: Optional[Callable[[int, float], Any]]) -> None: ...
    def relax(self, tolerance: float, max_steps: int, report: Optional[Callable[[str], Any]]) -> dict[str, Any]: ...
    def change(self, position: Any, velocity: Any, spin: Any) -> None: ...
    def measure(self) -> dict[str, Any]: ...
    def balance(self) -> dict[str, Any]: ...
    def energies(self) -> dict[str, float]: ...
    def contacts(self) -> Contacts: ...
    def wall_forces(self) -> NDArray[np.float64]: ...

class System:
    mass: NDArray[np.float64]
    size: int
    elements: int
    free: NDArray[np.int32]
    set_aside: NDArray[np.int32]
    translation_block: NDArray[np.int32]
    rotation_block: NDArray[np.int32]
    body: NDArray[np.int32]
    is_rotation: NDArray[np.uint8]
    element_a: NDArray[np.int32]
    element_b: NDArray[np.int32]
    element_normal: NDArray[np.float64]
    element_lever_a: NDArray[np.float64]
    element_lever_b: NDArray[np.float64]
    element_kn: NDArray[np.float64]
    element_ks: NDArray[np.float64]
    element_twist: NDArray[np.float64]
    element_bending: NDArray[np.float64]
    def __init__(self, state: State, all: bool) -> None: ...
    def stiffness(self) -> tuple[Any, ...]: ...
    def kinematics(self) -> tuple[Any, ...]: ...
    def elasticity(self) -> tuple[Any, ...]: ...
    def viscosity(self) -> tuple[Any, ...]: ...
    def to_bodies(self, x: Any) -> tuple[NDArray[np.float64], NDArray[np.float64]]: ...
    def from_bodies(self, u: Any, theta: Any) -> NDArray[np.float64]: ...

class Product:
    size: int
    products: int
    def __init__(self, system: System, scaled: bool) -> None: ...
    def apply(self, x: Any) -> NDArray[np.float64]: ...

def critical_timestep(state: State, tolerance: float, seed: int, certify: str) -> dict[str, Any]: ...
