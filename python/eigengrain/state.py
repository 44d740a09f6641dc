"""States: bodies and contacts as arrays, and what makes them move."""
from __future__ import annotations

import os
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from .errors import InputError, SolverError
from .results import Balance, Break, Energies, Floats, Measure, Relaxation, Timestep
from .spectrum import Moduli, Rigidity

if TYPE_CHECKING:
    from .load import Settings
    from .system import System

Integers = NDArray[np.int32]


class Bodies:
    """The balls of a state as arrays, a row a ball, as they were when they were asked for.

    Rows stand in the order of storage, along a space-filling curve: `identity` is the place of a ball in its scene,
    and `in_scene_order(array)` sorts rows so. Arrays are read only and no copies; they stay as they are when the state
    goes on, and they keep alive what they show. Columns that the scene has no need of are None.
    """

    def __init__(self, handle: _core.State) -> None:
        self._handle = handle.copy()

    def __len__(self) -> int:
        return self._handle.size

    @property
    def identity(self) -> NDArray[np.int64]:
        """(n,) place in the scene, from 0."""
        return self._handle.identity

    @property
    def position(self) -> Floats:
        """(n, 3) centres, m."""
        return self._handle.position

    @property
    def radius(self) -> Floats:
        """(n,) m."""
        return self._handle.radius

    @property
    def mass(self) -> Floats:
        """(n,) kg; of a clump, in all its rows, the clump's."""
        return self._handle.mass

    @property
    def inertia(self) -> Floats:
        """(n,) moment of inertia of a sphere about any axis, kg m2; of a clump its least principal one."""
        return self._handle.inertia

    @property
    def material(self) -> Integers:
        """(n,) index into the `materials` of the scene."""
        return self._handle.material

    @property
    def fixed(self) -> NDArray[np.uint8]:
        """(n,) components that are held, as bits: 1, 2, 4 for x, y, z and 8, 16, 32 for rotations."""
        return self._handle.fixed

    @property
    def velocity(self) -> Floats:
        """(n, 3) m/s, half a step before the time of the state (leapfrog)."""
        return self._handle.velocity

    @property
    def spin(self) -> Optional[Floats]:
        """(n, 3) angular velocity, rad/s, likewise; None where nothing turns."""
        return self._handle.spin

    @property
    def orientation(self) -> Optional[Floats]:
        """(n, 4) unit quaternions x, y, z, w from the body's frame to space; None where nothing asks for them."""
        return self._handle.orientation

    @property
    def force(self) -> Floats:
        """(n, 3) sum of contact forces, N, without gravity and loads."""
        return self._handle.force

    @property
    def moment(self) -> Optional[Floats]:
        """(n, 3) the same of moments about the centres, N m; None where nothing turns."""
        return self._handle.moment

    @property
    def owner(self) -> Integers:
        """(n,) the row that has the unknowns of a ball: its own, or that of the first ball of its clump."""
        return self._handle.owner

    def in_scene_order(self, rows: ArrayLike) -> NDArray[Any]:
        """A copy of an array with a row a ball, sorted by identity."""
        return np.asarray(rows)[np.argsort(self.identity, kind="stable")]


class Contacts:
    """The contacts of a state that act, as arrays, a row a contact; read only, no copies.

    A bond beside a contact adds its force to it; one over a gap is a row of its own.
    """

    def __init__(self, table: _core.Contacts) -> None:
        self._table = table

    def __len__(self) -> int:
        return len(self._table.a)

    @property
    def a(self) -> Integers:
        """(c,) row of the first ball."""
        return self._table.a

    @property
    def b(self) -> Integers:
        """(c,) row of the second ball, -1 at walls."""
        return self._table.b

    @property
    def wall(self) -> Integers:
        """(c,) number of the wall, -1 between balls."""
        return self._table.wall

    @property
    def rule(self) -> Integers:
        """(c,) index into the contact rules of the scene, in the order of its `contacts`."""
        return self._table.rule

    @property
    def image(self) -> NDArray[np.int8]:
        """(c, 3) the copy of the periodic cell that the second side is in."""
        return self._table.image

    @property
    def normal(self) -> Floats:
        """(c, 3) unit vector from the first side to the second."""
        return self._table.normal

    @property
    def branch(self) -> Floats:
        """(c, 3) from the centre of the first body to that of the second; at walls to the contact point, m."""
        return self._table.branch

    @property
    def point(self) -> Floats:
        """(c, 3) where the contact is, m."""
        return self._table.point

    @property
    def force(self) -> Floats:
        """(c, 3) force of the first side on the second, N."""
        return self._table.force

    @property
    def overlap(self) -> Floats:
        """(c,) m, positive where surfaces interpenetrate."""
        return self._table.overlap

    @property
    def slides(self) -> NDArray[np.bool_]:
        """(c,) whether the contact is at the limit of friction."""
        return self._table.slides.view(bool)

    @property
    def bonded(self) -> NDArray[np.bool_]:
        """(c,) whether a bond that carries moments is part of it."""
        return self._table.bonded.view(bool)

    @property
    def rattlers(self) -> NDArray[np.bool_]:
        """(n,) for each ball: whether too few contacts hold it."""
        return self._table.rattler.view(bool)

    @property
    def normal_force(self) -> Floats:
        """(c,) F.n, N, compression positive. A new array."""
        return np.einsum("ij,ij->i", self.force, self.normal)

    @property
    def shear_force(self) -> Floats:
        """(c, 3) what is left of the force across n, N. A new array."""
        return self.force - self.normal_force[:, None] * self.normal


class State:
    """A scene in motion. Made by `eigengrain.load`; may be pickled and copied.

    Work never changes a state in place: it is done on a copy which takes its place at the end, so what was taken from
    it before stays as it was, and after a failure the state is what it was at the start.
    """

    def __init__(self, handle: _core.State) -> None:
        self._handle = handle

    def __repr__(self) -> str:
        return (f"<eigengrain.State {self.name}: {self._handle.size} balls, {self._handle.walls} walls, "
                f"step {self.step}, t = {self.time:g} s>")

    # what there is

    @property
    def bodies(self) -> Bodies:
        """The balls as they are now."""
        return Bodies(self._handle)

    @property
    def contacts(self) -> Contacts:
        """The contacts that act now."""
        return Contacts(self._handle.contacts())

    @property
    def name(self) -> str:
        """Of the scene file."""
        return self._handle.name

    @property
    def time(self) -> float:
        """s."""
        return self._handle.time

    @property
    def step(self) -> int:
        """Cycles since the start."""
        return self._handle.step

    @property
    def dt(self) -> float:
        """Of the last cycle, s; 0 before the first."""
        return self._handle.dt

    @property
    def settings(self) -> str:
        """What the scene said beside its balls, as JSON."""
        return self._handle.settings

    @property
    def notes(self) -> list[str]:
        """What the reader made, or found odd though it is no mistake."""
        return self._handle.notes

    @property
    def cell(self) -> tuple[Floats, Floats, NDArray[np.bool_]]:
        """(edges, origin, periodic): edges (3, 3), a column an edge, m; origin (3,), m; which axes repeat (3,)."""
        edges, origin, periodic = self._handle.cell
        return edges, np.array(origin), np.array(periodic)

    @property
    def energies(self) -> Energies:
        return Energies(**self._handle.energies())

    @property
    def balance(self) -> Balance:
        """How far from equilibrium. Costs about a step."""
        return Balance(**self._handle.balance())

    @property
    def wall_forces(self) -> Floats:
        """(walls, 3) force of the balls on each wall, N."""
        return self._handle.wall_forces()

    def measure(self) -> Measure:
        """Stress, porosity, coordination and fabric of the whole assembly."""
        return Measure(**self._handle.measure())

    # what makes it move

    def run(self, steps: Optional[int] = None, *, time: Optional[float] = None, unbalanced: Optional[float] = None,
            callback: Optional[Callable[[State], Any]] = None, every: int = 100, progress: bool = False) -> None:
        """The explicit cycle, with the timestep policy of the scene, to the first of these ends.

        steps: so many more steps.
        time: so much longer, s.
        unbalanced: until the mean unbalanced ratio is below this and nothing falls, looked at every `every` steps.
        callback: called with this state every `every` steps, and at the end; the run is over if it returns True
        (of Python or numpy).
        progress: a line on the error stream.

        Without an end it is that of the scene (`run`), counted from the scene's start. Other threads run meanwhile.
        Ctrl-C ends it after a whole step with KeyboardInterrupt; the state is then the one reached. Raises SolverError
        where the run blows up; the state is then that of the last call of `callback`, without one that of the start.
        """
        if every < 1:
            raise InputError(f"every: {every} steps; a whole number from 1 up is wanted")
        if steps is None and time is None and unbalanced is None and self._handle.has_stages:
            raise InputError("the scene has stages, which the program runs: eigengrain run; give steps or time here")
        if steps is not None and steps < 0:
            raise InputError(f"steps: {steps}; a number from 0 up is wanted")
        if time is not None and not time >= 0:
            raise InputError(f"time: {time} s; a number from 0 up is wanted")
        if unbalanced is not None and not unbalanced > 0:
            raise InputError(f"unbalanced: {unbalanced}; a ratio above 0 is wanted")
        show = _Progress(self.step, steps, self.time, time) if progress else None

        def looks() -> bool:
            over = callback(self) if callback is not None else None
            return isinstance(over, (bool, np.bool_)) and bool(over)

        try:
            self._handle.run(steps, time, unbalanced, every, None if callback is None else looks, show)
        finally:
            if show is not None:
                show.finish()

    @property
    def breaks(self) -> list[Break]:
        """Bonds that broke since the state was made, or since the program that wrote it had noted them."""
        return [Break(**row) for row in self._handle.breaks()]

    def relax(self, tolerance: float = 1e-10, *, max_steps: int = 1000000, progress: bool = False) -> Relaxation:
        """Brings the state to the equilibrium that damped motion leads to, by explicit cycles and Newton's method.

        tolerance: mean unbalanced ratio to reach.
        max_steps: explicit steps to spend.
        progress: lines on the error stream.

        Raises SolverError where none was found; the state is then the nearest one. Ctrl-C as in `run`.
        """
        report = (lambda line: print(line, file=sys.stderr)) if progress else None
        found = Relaxation._from(self._handle.relax(tolerance, max_steps, report))
        if not found.converged:
            raise SolverError(f"no equilibrium within {tolerance:g} was found: the mean unbalanced ratio is "
                              f"{found.end.mean:.3e}, and rounding of positions alone makes {found.end.floor:.1e}")
        return found

    def change(self, *, position: Optional[ArrayLike] = None, velocity: Optional[ArrayLike] = None,
               spin: Optional[ArrayLike] = None) -> None:
        """Puts balls elsewhere or gives them other velocities; arrays (n, 3) in the order of the rows.

        position: m. Contacts are looked for anew, and those that stay keep their history.
        velocity: m/s. spin: rad/s.
        """
        self._handle.change(*(None if rows is None else np.asarray(rows, dtype=float)
                              for rows in (position, velocity, spin)))

    def with_settings(self, set: Settings) -> State:
        """This state with other settings, e.g. {"contacts.0.friction": 0.3}, as `--set` of the program."""
        from .load import as_overrides
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "state.h5"
            self.save(file)
            return State(_core.State.read(str(file), as_overrides(set)))

    # questions

    def timestep(self, *, tolerance: float = 1e-10, seed: int = 1,
                 certify: Literal["small", "always", "never"] = "small") -> Timestep:
        """The true critical timestep of the state as it stands, and every estimate beside it.

        tolerance: wished relative residual of the eigenpair.
        seed: of the random start vector.
        certify: prove the truth by a sparse factorisation; "small" where that is quick.
        """
        return Timestep._from(_core.critical_timestep(self._handle, tolerance, seed, certify))

    def system(self, contacts: Literal["acting", "listed"] = "acting") -> System:
        """K, M, B and D of the state as it stands.

        contacts: those that act, or all that are near as if they acted.
        """
        from .system import System
        if contacts not in ("acting", "listed"):
            raise InputError(f'contacts: "{contacts}"; write acting or listed')
        return System(_core.System(self._handle, contacts == "listed"), self.copy())

    def rigidity(self, springs: Literal["all", "sticking", "normal"] = "all", *, with_rattlers: bool = True,
                 shapes: bool = False) -> Rigidity:
        """Floppy modes and states of self-stress, by two rank-revealing decompositions that know nothing of each other.

        springs: all that contacts have; "sticking": contacts that slide have no shear; "normal": the frictionless count.
        with_rattlers: else balls with too few contacts are left out, one after the other.
        shapes: also the motions and the stresses; takes floppy × unknowns numbers.
        """
        return Rigidity._from(_core.rigidity(self._handle, springs, with_rattlers, shapes))

    def moduli(self) -> Moduli:
        """The elastic stiffness tensor of an assembly in a cell that repeats along all axes, by linear response."""
        return Moduli._from(_core.moduli(self._handle))

    # keeping it

    def save(self, file: str | os.PathLike[str]) -> None:
        """Writes a state file, all of the state to the bit; `load` and the program read it."""
        self._handle.write(os.fspath(file))

    def copy(self) -> State:
        """Another state that goes its own way from here. Costs nothing until it does."""
        return State(self._handle.copy())

    __copy__ = copy

    def __deepcopy__(self, memo: Any) -> State:
        return self.copy()

    def __reduce__(self) -> tuple[Any, ...]:
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "state.h5"
            self.save(file)
            return _unpickled, (file.read_bytes(),)


def _unpickled(data: bytes) -> State:
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "state.h5"
        file.write_bytes(data)
        return State(_core.State.read(str(file), []))


class _Progress:
    """A line on the error stream that changes."""

    def __init__(self, step: int, steps: Optional[int], time: float, duration: Optional[float]) -> None:
        self._step, self._steps, self._time, self._duration = step, steps, time, duration

    def __call__(self, step: int, time: float) -> None:
        parts = []
        if self._steps:
            parts.append((step - self._step) / self._steps)
        if self._duration:
            parts.append((time - self._time) / self._duration)
        done = f"{100 * max(parts):3.0f}%  " if parts else ""
        bar = f"[{'#' * int(20 * max(parts)):20}] " if parts else ""
        print(f"\r{bar}{done}step {step}, t = {time:.6g} s ", end="", file=sys.stderr, flush=True)

    def finish(self) -> None:
        print(file=sys.stderr)
