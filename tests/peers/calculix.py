#!/usr/bin/env python3
"""Finite elements against CalculiX: the stiffness matrix of the same mesh, number by number, and its eigenfrequencies.

The meshes are blocks whose inner nodes are moved about, of C3D4, C3D8 and C3D10, written once as an .inp file that both
programs read. CalculiX stores its matrices with 14 digits (*FREQUENCY, SOLVER=MATRIXSTORAGE); ours come from the Python
package. Masses: ours are lumped, so frequencies are compared with CalculiX's mass matrix in both problems, and that
matrix, as far as its integration is exact, with the consistent one.

Exit code 77: CalculiX (ccx) or the package is not there.
"""
import argparse
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np

YOUNG, POISSON, DENSITY = 2.1e11, 0.3, 7850.0
# CalculiX prints 14 digits, and both sum a node's elements in their own order.
DIGITS = 2e-13
KINDS = {"C3D4": 4, "C3D8": 8, "C3D10": 10}


def block(kind, cells, rng):
    """Nodes [n, 3] and elements [m, nodes of one] of a block of 2 x 1 x 1 m; inner corners are moved about."""
    shape = [c + 1 for c in cells]
    size = np.array([2.0, 1.0, 1.0])
    index = np.arange(np.prod(shape)).reshape(shape)
    grid = np.stack(np.meshgrid(*[np.linspace(0, 1, s) for s in shape], indexing="ij"), -1).reshape(-1, 3)
    inner = np.all((grid > 1e-9) & (grid < 1 - 1e-9), axis=1)
    nodes = grid * size
    nodes[inner] += 0.06 * rng.uniform(-1, 1, (inner.sum(), 3))
    bricks = []
    for i, j, k in np.ndindex(*cells):
        b = index[i:i + 2, j:j + 2, k:k + 2]
        bricks.append([b[0, 0, 0], b[1, 0, 0], b[1, 1, 0], b[0, 1, 0], b[0, 0, 1], b[1, 0, 1], b[1, 1, 1], b[0, 1, 1]])
    bricks = np.array(bricks)
    if kind == "C3D8":
        return nodes, bricks
    # Six tetrahedra about the diagonal from corner 0 to corner 6.
    paths = [(0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6), (0, 5, 1, 6)]
    tets = np.concatenate([bricks[:, p] for p in paths])
    if kind == "C3D4":
        return nodes, tets
    edges = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]
    middles, more, columns = {}, [], []
    for a, b in edges:
        column = []
        for first, second in zip(tets[:, a], tets[:, b]):
            key = (min(first, second), max(first, second))
            if key not in middles:
                middles[key] = len(nodes) + len(more)
                more.append(0.5 * (nodes[first] + nodes[second]))
            column.append(middles[key])
        columns.append(column)
    return np.concatenate([nodes, more]), np.concatenate([tets, np.array(columns).T], axis=1)


def write_inp(path, kind, nodes, elements, step):
    with open(path, "w") as f:
        f.write("*NODE, NSET=ALL\n")
        for n, x in enumerate(nodes, 1):
            f.write(f"{n}, {x[0]:.17g}, {x[1]:.17g}, {x[2]:.17g}\n")
        f.write(f"*ELEMENT, TYPE={kind}, ELSET=BODY\n")
        for e, nodes_of in enumerate(elements, 1):
            f.write(f"{e}, " + ", ".join(str(n + 1) for n in nodes_of) + "\n")
        f.write(f"*MATERIAL, NAME=STEEL\n*ELASTIC\n{YOUNG}, {POISSON}\n*DENSITY\n{DENSITY}\n"
                "*SOLID SECTION, ELSET=BODY, MATERIAL=STEEL\n" + step)


def run_calculix(folder, job):
    done = subprocess.run(["ccx", job], cwd=folder, capture_output=True, text=True, check=False)
    if "Job finished" not in done.stdout:
        raise SystemExit(f"ccx did not finish {folder / job}:\n{done.stdout[-2000:]}")


def matrix_of(path, order):
    """A symmetric matrix of CalculiX (row, column, value a line), rows in the order of node and direction."""
    from scipy.sparse import coo_matrix
    table = np.loadtxt(path)
    i, j, v = table[:, 0].astype(int) - 1, table[:, 1].astype(int) - 1, table[:, 2]
    n = len(order)
    upper = coo_matrix((v, (order[i], order[j])), shape=(n, n)).tocsr()
    diagonal = upper.diagonal()
    full = upper + upper.T
    full.setdiag(diagonal)
    return full


def ours(folder, name):
    """K in the order of node and direction, and the lumped masses."""
    import eigengrain
    state = eigengrain.load({
        "materials": [{"name": "steel", "density": DENSITY, "young": YOUNG, "poisson": POISSON}],
        "contacts": [{"between": ["any", "any"], "law": "linear", "kn": 1.0}],
        "deformables": [{"mesh": {"file": str(folder / name), "unit": "m"}, "material": "steel", "model": "linear"}]})
    system = state.system()
    K = system.K.tocsr()
    block = np.asarray(system.translation_block)
    place = np.empty(K.shape[0], dtype=int)  # ours of (node, direction)
    for row, node in enumerate(state.bodies.identity):
        place[3 * node:3 * node + 3] = 3 * block[row] + np.arange(3)
    return K[place][:, place], np.asarray(system.mass)[place]


def frequencies(folder, job):
    """What CalculiX prints of its eigenvalues, rad/s squared."""
    values, reading = [], False
    for line in (folder / f"{job}.dat").read_text().splitlines():
        words = line.split()
        if "E I G E N V A L U E" in line:
            reading = True
        elif "P A R T I C I P A T I O N" in line:
            break
        elif reading and len(words) == 5 and words[0].isdigit():
            values.append(float(words[1]))
    return np.array(values)


def compare(kind, work):
    from scipy.sparse.linalg import eigsh
    folder = work / kind
    folder.mkdir(parents=True, exist_ok=True)
    nodes, elements = block(kind, (4, 3, 3), np.random.default_rng(5))
    write_inp(folder / "matrices.inp", kind, nodes, elements, "*STEP\n*FREQUENCY, SOLVER=MATRIXSTORAGE\n10\n*END STEP\n")
    run_calculix(folder, "matrices")
    order = np.array([3 * (int(n) - 1) + int(d) - 1
                      for n, d in (line.split(".") for line in (folder / "matrices.dof").read_text().split())])
    theirs = matrix_of(folder / "matrices.sti", order)
    mass = matrix_of(folder / "matrices.mas", order)
    K, lumped = ours(folder, "matrices.inp")
    worst = abs(K - theirs).max() / abs(theirs).max()
    whole = abs(lumped.sum() / 3 - mass.sum() / 3) / (mass.sum() / 3)
    print(f"{kind}: {len(elements)} elements, {len(nodes)} nodes; K differs by {worst:.1e} of its largest number, "
          f"masses in all by {whole:.1e}")

    held = "*BOUNDARY\n" + "".join(f"{n}, 1, 3\n" for n, x in enumerate(nodes, 1) if x[0] < 1e-9)
    write_inp(folder / "modes.inp", kind, nodes, elements, held + "*STEP\n*FREQUENCY\n10\n*END STEP\n")
    run_calculix(folder, "modes")
    printed = frequencies(folder, "modes")
    free = np.flatnonzero(np.repeat(nodes[:, 0] > 1e-9, 3))
    found = np.sort(eigsh(K[free][:, free].tocsc(), 10, mass[free][:, free].tocsc(), sigma=0, which="LM",
                          return_eigenvectors=False))
    off = np.max(np.abs(found / printed - 1))
    print(f"{kind}: eigenvalues of the held block differ by {off:.1e} (CalculiX prints 8 digits)")
    return worst <= DIGITS and whole <= 1e-12 and len(printed) == 10 and off <= 1e-6


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--work", type=Path, required=True, help="folder for what the programs read and write")
    work = parser.parse_args().work
    try:
        import eigengrain  # noqa: F401
        import scipy  # noqa: F401
    except ImportError as missing:
        print(missing)
        return 77
    if shutil.which("ccx") is None:
        print("there is no ccx (Debian: calculix-ccx)")
        return 77
    return 0 if all([compare(kind, work) for kind in KINDS]) else 1


if __name__ == "__main__":
    sys.exit(main())
