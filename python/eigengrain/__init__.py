"""Discrete elements with their true stiffness matrix.

    import eigengrain
    state = eigengrain.load("packing.yaml")     # a scene, a saved state, or a dict
    state.bodies.position                       # numpy arrays
    state.timestep().true.dt                    # the true critical timestep, s
    K = state.system().K                        # scipy.sparse

Numbers are SI. Results do not depend on the number of threads.
"""
from __future__ import annotations

from ._core import __version__, schema_markdown, set_petsc_options, set_threads, threads
from .errors import InputError, SolverError
from .load import load
from .page import page
from .results import Balance, Break, Energies, Estimate, Measure, Relaxation, Timestep, Truth
from .spectrum import Density, Moduli, Modes, Rigidity, Springs
from .state import Bodies, Contacts, State
from .system import Elements, StiffnessOperator, System

__all__ = [
    "Balance", "Bodies", "Break", "Contacts", "Density", "Elements", "Energies", "Estimate", "InputError",
    "Measure", "Moduli", "Modes", "Relaxation", "Rigidity", "SolverError", "Springs", "State", "StiffnessOperator",
    "System", "Timestep", "Truth", "load", "page", "schema_markdown", "set_petsc_options", "set_threads", "threads",
    "__version__",
]
