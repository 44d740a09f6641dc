#!/usr/bin/env python3
"""The notebook of tests/python/test_notebook.py with 10,000 balls, each number against scipy.

    notebook.py [FOLDER]      writes three pictures and prints the numbers and what they cost

The settled bed of examples/scenes/packing_10k.yaml stands in a box; moduli want a cell, so there are those of 10,000 balls
in one. Shift-invert in scipy does not get through here: SuperLU had not factored these 60,000 unknowns after six minutes.
So all eigenvalues at the lower end come from a block of random vectors that a Chebyshev polynomial has rid of the rest of the
spectrum. Some ten minutes; needs the Python package (PYTHONPATH=build/release/lib/python).
"""
import os
import pathlib
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
os.environ.setdefault("EIGENGRAIN_EXAMPLES", str(ROOT / "examples"))
sys.path.insert(0, str(ROOT / "tests/python"))
import numpy as np  # noqa: E402
import scipy.linalg  # noqa: E402
import test_notebook  # noqa: E402

import eigengrain  # noqa: E402

FOLDER = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")
FOLDER.mkdir(parents=True, exist_ok=True)


def by_polynomial(a, above, largest, columns=112, degree=500):
    """All eigenvalues of `a` up to `above`. T_n(x) ~ exp(2 n √((cut - λ)/largest))/2 for λ below the cut, 1 beyond it.

    The cut at 1.25 of the last one wanted: exp(2 · 500 · √(0.25 · 1.7e6/1.1e9)) = 4e8 for that one, and its square is what
    the eigenvalue is good to. The block has to have more columns than there are eigenvalues below the cut.
    """
    cut = 1.25 * above
    middle, half = 0.5 * (1.01 * largest + cut), 0.5 * (1.01 * largest - cut)
    block = np.random.default_rng(1).standard_normal((a.shape[0], columns))
    before, now = block, (a @ block - middle * block) / half
    for k in range(2, degree + 1):
        before, now = now, 2 / half * (a @ now - middle * now) - before
        if k % 50 == 0:  # or they grow out of range, and grow alike
            now, r = np.linalg.qr(now)
            before = scipy.linalg.solve_triangular(r, before.T, trans="T", check_finite=False).T
    q, _ = np.linalg.qr(now)
    values = np.linalg.eigvalsh(q.T @ (a @ q))
    assert values[-1] > cut, "more eigenvalues below the cut than columns"
    return values[values <= above * (1 + 1e-9)]


def timed(name, work):
    start, cpu = time.perf_counter(), time.process_time()
    result = work()
    print(f"{name}: {time.perf_counter() - start:.1f} s ({time.process_time() - cpu:.1f} s of processors)", flush=True)
    return result


bed = eigengrain.load(ROOT / "examples/scenes/packing_10k.yaml")
cell = timed("a cell of 10,000 balls", lambda: eigengrain.load({
    "materials": [{"name": "grain", "density": 2500}],
    "contacts": [{"between": ["grain", "grain"], "law": "linear", "kn": 1e5, "ks": 5e4, "friction": 0.5}],
    "periodic": {"box": [0.2022] * 3},
    "balls": [{"fill": "dense", "mean_overlap": 1e-3, "seed": 1, "material": "grain",
               "sizes": {"distribution": "uniform", "min": 4.5e-3, "max": 5.5e-3}}]}))
found = timed("notebook", lambda: test_notebook.notebook(bed, cell, FOLDER))
_, _, high, low, _, _ = found
zeros, bins = timed("scipy", lambda: test_notebook.check(
    found, cell, lambda a: by_polynomial(a, low.eigenvalues[-1], high.eigenvalues[0])))
print(f"{len(cell.bodies)} balls in the cell; all numbers agree to 1e-8. {zeros} eigenvalues of the bed are zero, {bins} bins of "
      "the density are known to a mode")
