"""K, M, B and D of a state: as sparse matrices, as operators, as petsc4py matrices."""
from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import scipy.sparse
from numpy.typing import ArrayLike, NDArray
from scipy.sparse.linalg import LinearOperator

from . import _core
from .errors import InputError
from .results import Floats
from .spectrum import Density, Modes

if TYPE_CHECKING:
    from .state import State

Integers = NDArray[np.int32]


class StiffnessOperator(LinearOperator):
    """K x, or M^-1/2 K M^-1/2 x, without K: each contact is one compact record.

    Threads work on it and the GIL is released; the result is the same to the bit on any number of threads. Rows of
    fixed components are zero.
    """

    def __init__(self, product: _core.Product) -> None:
        super().__init__(np.float64, (product.size, product.size))
        self._product = product

    @property
    def products(self) -> int:
        """So far."""
        return self._product.products

    def _matvec(self, x: ArrayLike) -> Floats:
        return self._product.apply(np.asarray(x, dtype=float).ravel())

    def _rmatvec(self, x: ArrayLike) -> Floats:
        return self._matvec(x)

    def _adjoint(self) -> StiffnessOperator:
        return self


class Elements:
    """The contacts that K is made of, as arrays, a row an element. Bonds beside a contact are elements of their own."""

    def __init__(self, system: _core.System) -> None:
        self.a: Integers = system.element_a  #: (e,) row of the first body; of a clump its first ball
        self.b: Integers = system.element_b  #: (e,) row of the second, -1 at walls
        self.normal: Floats = system.element_normal  #: (e, 3) n, from a to b
        self.lever_a: Floats = system.element_lever_a  #: (e, 3) from the centre of a to the contact, m
        self.lever_b: Floats = system.element_lever_b  #: (e, 3) from that of b, m
        self.kn: Floats = system.element_kn  #: (e,) along n, N/m
        self.ks: Floats = system.element_ks  #: (e,) across n, N/m
        self.twist: Floats = system.element_twist  #: (e,) rotation about n, N m
        self.bending: Floats = system.element_bending  #: (e,) rotation about axes across n, N m

    def __len__(self) -> int:
        return len(self.a)


class System:
    """K, M, B and D of a state as it was when it was asked for. K = B^T D B.

    Unknowns come in blocks of three: u (m), and θ (rad) where contacts resist it. Bodies without acting contacts, walls
    and fixed vectors have none; rows and columns of single fixed components are zero, and `free` leaves them out.
    """

    def __init__(self, system: _core.System, state: State) -> None:
        self._system = system
        self._state = state  # what it is of, for pictures

    def __repr__(self) -> str:
        return f"<eigengrain.System: {self.size} unknowns, {self._system.elements} contacts>"

    @property
    def size(self) -> int:
        """Unknowns, fixed components included."""
        return self._system.size

    # matrices

    @property
    def K(self) -> scipy.sparse.bsr_matrix:
        """(size, size) stiffness, blocks of 3×3; N/m, N, N m. Made at each call; symmetric to the bit."""
        return _bsr(self._system.stiffness())

    @property
    def B(self) -> scipy.sparse.bsr_matrix:
        """(6 e, size) rows of contact e are its relative displacement (m) and rotation (rad)."""
        return _bsr(self._system.kinematics())

    @property
    def D(self) -> scipy.sparse.bsr_matrix:
        """(6 e, 6 e) block diagonal: N/m for displacements, N m for rotations."""
        return _bsr(self._system.elasticity())

    @property
    def C(self) -> scipy.sparse.bsr_matrix:
        """(size, size) of the dashpots, N s/m. Raises InputError where no contact has any."""
        return _bsr(self._system.viscosity())

    @property
    def mass(self) -> Floats:
        """(size,) the diagonal of M: kg for u, kg m2 for θ. Fixed components have it too."""
        return self._system.mass

    @property
    def M(self) -> scipy.sparse.dia_matrix:
        """(size, size) the diagonal mass matrix."""
        return scipy.sparse.diags(self.mass, format="dia")

    def matrix(self, name: Literal["K", "M", "B", "D", "C"], format: str = "csr") -> scipy.sparse.spmatrix:
        """One of the matrices in any format of scipy; K_free = matrix("K")[free][:, free] has the free ones alone."""
        if name not in ("K", "M", "B", "D", "C"):
            raise InputError(f'matrix: "{name}"; write K, M, B, D or C')
        return getattr(self, name).asformat(format)

    def reduced(self) -> tuple[scipy.sparse.csr_matrix, scipy.sparse.csr_matrix]:
        """(K, M) on the free components alone, as CSR: what eigensolvers want."""
        free = self.free
        return self.K.tocsr()[free][:, free], scipy.sparse.diags(self.mass[free], format="csr")

    def operator(self, scaled: bool = False) -> StiffnessOperator:
        """K without K as scipy's LinearOperator; scaled: M^-1/2 K M^-1/2."""
        return StiffnessOperator(_core.Product(self._system, scaled))

    def petsc(self, name: Literal["K", "M", "B", "D", "C"] = "K") -> Any:
        """One of the matrices as petsc4py's Mat; blocks of three. Needs petsc4py."""
        try:
            from petsc4py import PETSc
        except ImportError as missing:
            raise ImportError("petsc4py is not installed (Debian: python3-petsc4py)") from missing
        matrix = getattr(self, name).tobsr((3, 3))
        index = PETSc.IntType
        result = PETSc.Mat().createBAIJ(size=matrix.shape, bsize=3, comm=PETSc.COMM_SELF,
                                        csr=(matrix.indptr.astype(index), matrix.indices.astype(index),
                                             matrix.data.astype(PETSc.ScalarType)))
        result.assemble()
        return result

    # the spectrum

    def highest_modes(self, count: int = 20) -> Modes:
        """The modes of the largest eigenvalues, the largest first. Raises SolverError where they do not converge."""
        return Modes(**_core.highest_modes(self._system, count), _system=self)

    def lowest_modes(self, count: int = 20) -> Modes:
        """The modes of the least eigenvalues that something resists, the least first.

        Rigid motions, rattlers and mechanisms are left out: eigenvalues below 1e-10 of the largest. Takes a sparse
        factor of K. Raises SolverError where they do not converge or memory does not suffice.
        """
        return Modes(**_core.lowest_modes(self._system, count), _system=self)

    def all_modes(self, shapes: bool = False) -> Modes:
        """Every mode, the least first, by a dense matrix (LAPACK); up to 20,000 unknowns."""
        return Modes(**_core.all_modes(self._system, shapes), _system=self)

    def density_of_states(self, *, bins: int = 50, moments: int = 512, vectors: int = 8, seed: int = 1) -> Density:
        """The density of states by the kernel polynomial method, for any size.

        bins: of equal width in angular frequency.
        moments: of Chebyshev polynomials; a mode is smeared over π/(2 moments) of the whole range.
        vectors: random ones; errors fall with the root of their number. Cost: moments/2 products with K each.
        """
        return Density(**_core.density_of_states(self._system, moments, vectors, bins, seed))

    # files

    def export(self, folder: str | os.PathLike[str], formats: Sequence[str] = ("h5", "csv")) -> list[Path]:
        """Writes K, M, B, D, contacts, bodies and the map of the unknowns into a folder; what `export` does.

        formats: "mtx" (MatrixMarket), "petsc" (binary), "h5" (HDF5), "csv" (tables).
        """
        return [Path(file) for file in _core.export_matrices(self._system, os.fspath(folder), list(formats))]

    @property
    def elements(self) -> Elements:
        """The contacts that K is made of."""
        return Elements(self._system)

    # the map of the unknowns

    @property
    def free(self) -> Integers:
        """(free,) the unknowns that are not fixed, increasing."""
        return self._system.free

    @property
    def translation_block(self) -> Integers:
        """(n,) the block of each ball's u, or -1: its unknowns are 3 block, ..., 3 block + 2."""
        return self._system.translation_block

    @property
    def rotation_block(self) -> Integers:
        """(n,) the block of each ball's θ, or -1. Of clumps it is along the principal axes."""
        return self._system.rotation_block

    @property
    def body(self) -> Integers:
        """(size/3,) the row of the ball that a block belongs to."""
        return self._system.body

    @property
    def is_rotation(self) -> NDArray[np.bool_]:
        """(size/3,) whether a block is a θ."""
        return self._system.is_rotation.view(bool)

    @property
    def set_aside(self) -> Integers:
        """Rows of balls without unknowns as no contact touches them."""
        return self._system.set_aside

    def to_bodies(self, x: ArrayLike) -> tuple[Floats, Floats]:
        """(u, θ), each (n, 3), of a vector of unknowns: m and rad along the axes of space, zeros where there are none.

        Of clumps it is the motion of the clump, in the row of its first ball.
        """
        return self._system.to_bodies(np.asarray(x, dtype=float))

    def from_bodies(self, u: ArrayLike, theta: ArrayLike) -> Floats:
        """(size,) The way back; zeros at fixed components."""
        return self._system.from_bodies(np.asarray(u, dtype=float), np.asarray(theta, dtype=float))


def _bsr(parts: tuple[Floats, Integers, Integers, int, int]) -> scipy.sparse.bsr_matrix:
    data, columns, offsets, rows, column_count = parts
    return scipy.sparse.bsr_matrix((data.reshape(-1, 3, 3), columns, offsets), shape=(rows, column_count))
