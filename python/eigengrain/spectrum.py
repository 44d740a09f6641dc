"""Modes, density of states, rigidity and moduli: what K says of an assembly."""
from __future__ import annotations

import os
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import _core
from .results import Floats

if TYPE_CHECKING:
    from .system import System

Integers = NDArray[np.int32]


@dataclass(frozen=True)
class Modes:
    """Eigenpairs of K x = lambda M x on the free components."""

    eigenvalues: Floats  #: (m,) lambda, 1/s2
    residuals: Floats  #: (m,) |A x - lambda x| / |lambda x| of A = M^-1/2 K M^-1/2
    shapes: Floats = field(repr=False)  #: (m, size) x with x.Mx = 1; (0, size) where they were not asked for
    #: (m,) (sum e)^2 / (N sum e^2) of the kinetic energies of the N bodies: 1 where all move alike, 1/N where one does
    participation: Floats
    translation: Floats  #: (m,) share of the kinetic energy in translations; the rest turns
    _system: System = field(repr=False)

    def __len__(self) -> int:
        return len(self.eigenvalues)

    @property
    def frequencies(self) -> Floats:
        """(m,) angular frequencies sqrt(lambda), rad/s; 0 where rounding made an eigenvalue negative."""
        return np.sqrt(np.maximum(self.eigenvalues, 0))

    def motion(self, k: int) -> tuple[Floats, Floats]:
        """(u, θ), each (n, 3), of mode k: m and rad along the axes of space."""
        return self._system.to_bodies(self.shapes[k])

    def energy(self, k: int) -> Floats:
        """(n,) share of each body in the kinetic energy of mode k; of a clump in the row of its holder."""
        system = self._system
        of_block = (system.mass * self.shapes[k]**2).reshape(-1, 3).sum(axis=1)
        return np.bincount(system.body, weights=of_block, minlength=len(system.translation_block)) / of_block.sum()

    def save(self, file: str | os.PathLike[str]) -> None:
        """Writes the shapes for ParaView (.vtu)."""
        _core.write_modes(self._system._system, os.fspath(file), self.shapes)


@dataclass(frozen=True)
class Density:
    """How many modes lie in each interval of angular frequency."""

    edges: Floats  #: (bins + 1,) rad/s
    count: Floats  #: (bins,) modes between two edges; together all of them, those of zero frequency in the first bins
    error: Floats  #: (bins,) standard error: of the random vectors, and of the smearing
    resolution: float  #: what a single mode is smeared over at most (standard deviation), rad/s
    modes: int  #: free components
    products: int  #: with K
    seconds: float

    @property
    def centres(self) -> Floats:
        """(bins,) middles of the bins, rad/s."""
        return 0.5 * (self.edges[1:] + self.edges[:-1])

    @property
    def density(self) -> Floats:
        """(bins,) part of all modes for each rad/s: its integral is 1."""
        return self.count / np.diff(self.edges) / self.modes

    @property
    def density_error(self) -> Floats:
        """(bins,) standard error of `density`."""
        return self.error / np.diff(self.edges) / self.modes


@dataclass(frozen=True)
class Springs:
    """The rows of sqrt(D) B: one spring of one contact each."""

    a: Integers  #: row of the first body
    b: Integers  #: of the second, -1 at walls
    kind: NDArray[np.str_]  #: "normal", "shear", "twist" or "bending"
    direction: Floats  #: (s, 3) of the displacement, or axis of the rotation, that it resists

    def __len__(self) -> int:
        return len(self.a)


@dataclass(frozen=True)
class Rigidity:
    """Maxwell-Calladine: unknowns - len(springs) = floppy - self_stress, the two on the right counted apart."""

    bodies: int  #: that have unknowns
    rattlers: int  #: with too few contacts to be held
    set_aside: int  #: free bodies that no counted contact touches
    contacts: int
    springs: Springs = field(repr=False)
    unknowns: int  #: free components
    floppy: int  #: motions that no spring resists, the trivial ones included
    trivial: int  #: rigid motions of everything together among them
    self_stress: int  #: sets of spring forces that balance everywhere
    excess: int  #: springs beyond Maxwell's count: len(springs) - (unknowns - trivial)
    counts_agree: bool
    floppy_u: Floats = field(repr=False)  #: (floppy, n, 3) of `shapes=True`, m; with x.Mx = 1
    floppy_theta: Floats = field(repr=False)  #: (floppy, n, 3) rad
    #: (self_stress, springs) force or moment of each spring over the root of its stiffness; orthonormal
    stresses: Floats = field(repr=False)
    floppy_residual: float
    stress_residual: float
    seconds: float

    @classmethod
    def _from(cls, found: dict[str, Any]) -> Rigidity:
        kinds = np.array(["normal", "shear", "twist", "bending"])
        springs = Springs(found.pop("spring_a"), found.pop("spring_b"), kinds[found.pop("spring_kind")],
                          found.pop("spring_direction"))
        return cls(**(found | {"springs": springs}))


@dataclass(frozen=True)
class Moduli:
    """Elastic stiffness of a periodic assembly, in Voigt's order xx, yy, zz, yz, xz, xy with whole shear angles."""

    stiffness: Floats  #: (6, 6) Pa
    affine: Floats  #: (6, 6) of bodies that follow the strain and do not turn, Pa
    volume: float  #: of the cell, m3
    contacts: int
    bulk: float  #: Voigt's mean, Pa
    shear: float  #: Voigt's mean, Pa
    residuals: Floats  #: (6,) of the linear systems
    iterations: int
    seconds: float
    displacement: Floats = field(repr=False)  #: (6, n, 3) what balls move by beside a strain of 1, m
    rotation: Floats = field(repr=False)  #: (6, n, 3) and turn by, rad

    @classmethod
    def _from(cls, found: dict[str, Any]) -> Moduli:
        return cls(**(found | {name: np.array(found[name]) for name in ("residuals", "displacement", "rotation")}))
