"""Pictures with matplotlib: contact forces, mode shapes, densities of states, spectra, timesteps.

Each function draws into the axes that it is given, or into new ones, and returns them; `figure.savefig` keeps them.
Colours are those of Okabe and Ito and of cividis, which are told apart with any colour vision and in grey.
"""
from __future__ import annotations

from typing import Any, Literal, Optional

import matplotlib
import matplotlib.collections
import matplotlib.colors
import matplotlib.ticker
import matplotlib.pyplot as plt
import numpy as np
from numpy.typing import ArrayLike

from .results import Floats, Timestep
from .spectrum import Density, Modes
from .state import State

BLUE, ORANGE, GREEN, VERMILION, GREY = "#0072B2", "#E69F00", "#009E73", "#D55E00", "#707070"
COLOURS = "cividis"

Axes = Any  # matplotlib's own, which has no types
Plane = Literal["xy", "xz", "yz"]
Slice = Optional[tuple[float, float]]


def force_chains(state: State, axes: Axes = None, *, plane: Plane = "xz", slice: Slice = None,
                 balls: bool = True) -> Axes:
    """Contacts as lines between the centres of their balls, as thick and as dark as their normal force.

    plane: looked at.
    slice: (from, to) across the plane, m: contacts and balls outside are left out; by default a layer of four mean
        radii in the middle, all of a scene that is thinner.
    balls: their outlines too.
    """
    axes = _axes(axes, (6, 5))
    bodies, contacts = state.bodies, state.contacts
    first, second, depth = _plane(plane)
    inside, between = _layer(bodies.position[:, depth], bodies.radius, slice)
    start = bodies.position[contacts.a]  # of the balls themselves, also in clumps
    length = bodies.radius[contacts.a] + bodies.radius[contacts.b] - contacts.overlap
    end = np.where((contacts.b >= 0)[:, None], start + length[:, None] * contacts.normal, contacts.point)
    shown = between(0.5 * (start + end)[:, depth]) & (contacts.normal_force > 0)
    force = contacts.normal_force[shown]
    segments = np.stack([start[shown][:, [first, second]], end[shown][:, [first, second]]], axis=1)
    if balls:
        _outlines(axes, bodies.position[inside], bodies.radius[inside], first, second)
    mean = force.mean() if len(force) else 1.0
    order = np.argsort(force)
    # Reversed: the largest forces are the darkest lines on white.
    lines = matplotlib.collections.LineCollection(
        1e3 * segments[order], linewidths=np.clip(1.1 * force[order] / mean, 0.25, 6), array=force[order],
        cmap=COLOURS + "_r", capstyle="round")
    lines.set_clim(0, np.quantile(force, 0.99) if len(force) else 1.0)
    axes.add_collection(lines)
    axes.figure.colorbar(lines, ax=axes, label="normal force [N]", extend="max", shrink=0.8)
    _lengths(axes, plane)
    return axes


def mode_shape(state: State, modes: Modes, k: int, axes: Axes = None, *, plane: Plane = "xz", slice: Slice = None,
               longest: float = 2.0) -> Axes:
    """How the balls move in mode k: arrows of their displacement, coloured by what part of the energy they have.

    longest: length of the longest arrow that is shown, in mean radii. plane, slice: as of `force_chains`.
    """
    axes = _axes(axes, (6, 5))
    bodies = state.bodies
    first, second, depth = _plane(plane)
    inside, _ = _layer(bodies.position[:, depth], bodies.radius, slice)
    u, _ = modes.motion(k)
    share = modes.energy(k)
    x, u, share = bodies.position[inside], u[inside][:, [first, second]], share[inside]
    _outlines(axes, x, bodies.radius[inside], first, second)
    size = np.linalg.norm(u, axis=1).max(initial=0.0)
    scale = longest * bodies.radius.mean() / size if size > 0 else 0.0
    order = np.argsort(share)
    arrows = axes.quiver(1e3 * x[order, first], 1e3 * x[order, second], *(1e3 * scale * u[order]).T,
                         share[order] * len(bodies), cmap=COLOURS + "_r", norm=matplotlib.colors.PowerNorm(0.4), angles="xy",
                         scale_units="xy", scale=1, width=0.005, zorder=3)
    axes.figure.colorbar(arrows, ax=axes, label="energy, of the mean of all balls", shrink=0.8)
    axes.set_title(f"$\\omega$ = {modes.frequencies[k]:.4g} rad/s, participation {modes.participation[k]:.3f}, "
                   f"{100 * modes.translation[k]:.0f}% translation", fontsize="medium")
    _lengths(axes, plane)
    return axes


def density_of_states(density: Density, axes: Axes = None, *, frequencies: Optional[ArrayLike] = None,
                      label: str = "kernel polynomial method", colour: str = BLUE) -> Axes:
    """Density of states with its error bars (two standard errors); beside it the histogram of known frequencies."""
    axes = _axes(axes)
    if frequencies is not None:
        counted, _ = np.histogram(np.asarray(frequencies), bins=density.edges)
        axes.stairs(1e3 * counted / np.diff(density.edges) / density.modes, 1e-3 * density.edges, fill=True,
                    color="#dddddd", label="every mode, counted")
    axes.errorbar(1e-3 * density.centres, 1e3 * density.density, yerr=2e3 * density.density_error, color=colour,
                  fmt="o", markersize=3, linewidth=1, capsize=2, label=label)
    axes.set_xlabel("angular frequency $\\omega$ [10³ rad/s]")
    axes.set_ylabel("density of states [10⁻³ s/rad]")
    axes.set_ylim(bottom=0)
    axes.set_xlim(0, 1e-3 * density.edges[-1])
    axes.legend(frameon=False, fontsize="small")
    return axes


def participation(*sets: Modes, axes: Axes = None) -> Axes:
    """Participation ratio of modes against their frequency; filled where most of the energy is in translations."""
    axes = _axes(axes)
    for modes in sets:
        moves = modes.translation > 0.5
        for shown, fill, name in [(moves, BLUE, "mostly translation"), (~moves, "none", "mostly rotation")]:
            if shown.any():
                axes.scatter(1e-3 * modes.frequencies[shown], modes.participation[shown], s=22, facecolors=fill,
                             edgecolors=BLUE if fill != "none" else VERMILION, marker="o" if fill != "none" else "s",
                             label=name)
    handles, labels = axes.get_legend_handles_labels()
    once = dict(zip(labels, handles))  # several sets share their labels
    axes.legend(once.values(), once.keys(), frameon=False, fontsize="small")
    axes.set_yscale("log")
    axes.set_xlabel("angular frequency $\\omega$ [10³ rad/s]")
    axes.set_ylabel("participation ratio")
    return axes


def timesteps(found: Timestep, axes: Axes = None) -> Axes:
    """Estimates over the true critical timestep; safe and unsafe ones differ in shape and colour."""
    axes = _axes(axes, (6.5, 0.24 * len(found.estimates) + 1.2))
    shown = sorted(found.estimates, key=lambda estimate: estimate.ratio_to_true)
    for safe, colour, marker, name in [(True, BLUE, "o", "safe here"), (False, VERMILION, "X", "too large here")]:
        rows = [(k, e.ratio_to_true) for k, e in enumerate(shown) if e.safe is safe and np.isfinite(e.ratio_to_true)]
        if rows:
            places, ratios = zip(*rows)
            axes.scatter(ratios, places, color=colour, marker=marker, s=28, label=name, zorder=3)
    axes.axvline(1, color=GREY, linewidth=1)
    axes.set_yticks(range(len(shown)), [estimate.name for estimate in shown], fontsize="small")
    axes.grid(axis="x", color="#dddddd", linewidth=0.6)
    axes.set_xscale("log")
    axes.xaxis.set_major_locator(matplotlib.ticker.LogLocator(subs=(0.2, 0.5, 0.7, 1.0)))
    axes.xaxis.set_major_formatter(matplotlib.ticker.FormatStrFormatter("%g"))
    axes.xaxis.set_minor_formatter(matplotlib.ticker.NullFormatter())
    axes.set_xlabel("estimate / true critical timestep")
    axes.legend(frameon=False, fontsize="small", loc="lower right")
    return axes


def _axes(axes: Axes, size: tuple[float, float] = (6.5, 4.5)) -> Axes:
    if axes is not None:
        return axes
    return plt.subplots(figsize=size, layout="constrained", dpi=150)[1]


def _plane(plane: str) -> tuple[int, int, int]:
    first, second = ("xyz".index(axis) for axis in plane)
    return first, second, 3 - first - second


def _layer(depth: Floats, radius: Floats, slice: Slice) -> tuple[Any, Any]:
    """Which balls are in the layer, and a function that says so of places across the plane."""
    if slice is None:
        middle, half = 0.5 * (depth.min() + depth.max()), 2 * radius.mean()
        slice = (middle - half, middle + half)
    low, high = slice
    between = lambda place: (place >= low) & (place <= high)  # noqa: E731
    return between(depth), between


def _outlines(axes: Axes, position: Floats, radius: Floats, first: int, second: int) -> None:
    size = 2e3 * radius
    axes.add_collection(matplotlib.collections.EllipseCollection(
        size, size, np.zeros(len(size)), offsets=1e3 * position[:, [first, second]], units="xy",
        transOffset=axes.transData, facecolors="none", edgecolors="#c0c0c0", linewidths=0.5))
    axes.autoscale_view()


def _lengths(axes: Axes, plane: str) -> None:
    axes.autoscale_view()
    axes.set_aspect("equal")
    axes.set_xlabel(f"{plane[0]} [mm]")
    axes.set_ylabel(f"{plane[1]} [mm]")
