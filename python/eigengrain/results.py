"""What questions are answered with."""
from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Truth:
    """The true critical timestep."""

    dt: float  #: 2/sqrt(lambda_max), undamped, s; infinite where nothing resists
    limit: float  #: of the cycle with its dashpots and local damping, s
    lambda_max: float  #: largest eigenvalue of K x = lambda M x, 1/s2
    residual: float  #: |A x - lambda x| / |lambda x| of A = M^-1/2 K M^-1/2
    limit_residual: float  #: the same of the eigenpair that `limit` comes from
    certified: bool  #: whether dt and limit are proven
    proven_dt: float  #: proven step, s; 0 where nothing is proven
    proven_by: str  #: "bound", "cholesky" or "none"
    mode: Floats = field(repr=False)  #: [unknowns] the eigenvector, x.Mx = 1
    seconds: float
    products: int  #: products with K


@dataclass(frozen=True)
class Break:
    """A bond that broke."""

    step: int
    time: float  #: s
    first: int  #: identities of the balls
    second: int
    place: tuple[float, float, float]  #: the contact point, m
    normal: tuple[float, float, float]  #: from the first to the second
    mode: str  #: "tension" or "shear"
    contact: int  #: which entry of the scene's `contacts` made it


@dataclass(frozen=True)
class Estimate:
    """An estimate of the undamped critical timestep, before any safety factor."""

    name: str
    source: str  #: paper, equation or program
    claim: str  #: what it says of itself
    dt: float  #: s
    ratio_to_true: float
    safe: bool  #: whether it does not exceed the truth in this scene
    seconds: float
    products: int
    range: tuple[float, float] | None  #: least and largest value over orientations of the frame, s


@dataclass(frozen=True)
class Timestep:
    """Estimated and true critical timesteps; `timestep["diagonal"]` is one of the estimates."""

    bodies: int
    contacts: int
    unknowns: int  #: free components
    set_aside: int  #: bodies without acting contacts, which are no part of it
    true: Truth
    estimates: list[Estimate]
    left_out: dict[str, str]  #: estimates that the scene has not, and why

    def __getitem__(self, name: str) -> Estimate:
        for estimate in self.estimates:
            if estimate.name == name:
                return estimate
        known = ", ".join(estimate.name for estimate in self.estimates)
        raise KeyError(f"{name}: {self.left_out.get(name, 'there is no such estimate')} (there are: {known})")

    def __str__(self) -> str:
        lines = [f"true critical timestep {self.true.dt:.6e} s, of the damped cycle {self.true.limit:.6e} s"]
        for estimate in self.estimates:
            lines.append(f"  {estimate.name:32} {estimate.dt:.6e} s  {estimate.ratio_to_true:7.4f} of the truth"
                         f"{'' if estimate.safe else '  UNSAFE'}")
        return "\n".join(lines)

    @classmethod
    def _from(cls, found: dict[str, Any]) -> Timestep:
        return cls(**(found | {"true": Truth(**found["true"]),
                               "estimates": [Estimate(**one) for one in found["estimates"]]}))


@dataclass(frozen=True)
class Balance:
    """How far a state is from equilibrium."""

    mean: float  #: mean resultant force / mean contact force: the unbalanced ratio
    max: float  #: largest resultant force / mean contact force
    moment_mean: float  #: the same of moment / radius
    moment_max: float
    floor: float  #: the mean ratio that rounding of positions alone makes
    unsupported: int  #: bodies that a load moves and that nothing touches
    bodies: int  #: free bodies with acting contacts
    contacts: int  #: acting
    mean_contact_force: float  #: N


@dataclass(frozen=True)
class Relaxation:
    """What it took to find an equilibrium."""

    converged: bool
    method: str  #: "explicit", "newton" or "explicit+newton"
    steps: int  #: explicit ones
    part_steps: int  #: cycles of a few moving bodies by themselves
    iterations: int  #: of Newton's method
    linear_iterations: int
    seconds: float
    start: Balance
    end: Balance

    @classmethod
    def _from(cls, found: dict[str, Any]) -> Relaxation:
        return cls(**(found | {"start": Balance(**found["start"]), "end": Balance(**found["end"])}))


@dataclass(frozen=True)
class Energies:
    """Mechanical energy, J."""

    kinetic: float  #: half a step before the time of the state
    elastic: float  #: stored in contacts
    gravitational: float


@dataclass(frozen=True)
class Measure:
    """Averages over a whole assembly."""

    volume: float  #: m3
    porosity: float
    stress: Floats  #: (3, 3), Pa, tension positive
    coordination: float  #: contacts a body
    rattlers: int
    coordination_without_rattlers: float
    fabric: Floats  #: (3, 3), mean of n n
    sliding: float  #: part of the contacts that slide
