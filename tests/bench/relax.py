#!/usr/bin/python3
"""Equilibrium of the packings of examples/ after gravity has tilted, and whether the explicit cycle keeps it.

    relax.py [--sizes 10k,100k] [--degrees 10] [--steps 1000] [--threads N] [--program PATH] [--out FILE.md]

Writes a Markdown table: what `eigengrain relax` spent, the unbalanced ratio that it left, and the ratio after so many
cycles from there. Exit 1 where an equilibrium misses 1e-10, has unsupported balls, or is not kept.
"""
import argparse
import math
import sys
import tempfile
from pathlib import Path

from ask import TREE, ask, packing

TOLERANCE = 1e-10
# Cycles move balls by less than an ulp of their positions each: the ratio stays a few times that rounding.
KEPT = 3e-10


def row(program, size, options, folder):
    tilt = math.radians(options.degrees)
    gravity = f"gravity=[{9.81 * math.sin(tilt):.17g}, 0, {-9.81 * math.cos(tilt):.17g}]"
    threads = ["--threads", str(options.threads)] if options.threads else []
    found = ask(program, "relax", packing(size), folder, "--output", str(folder), "--set", gravity, *threads,
                may_fail=True)
    state = found["state"]
    kept = ask(program, "run", state, folder, "--output", str(folder), "--set", f"run.steps={options.steps}", *threads,
               may_fail=True)
    good = (found["converged"] and max(found["unbalanced"]["mean"], found["unbalanced"]["moment_mean"]) <= TOLERANCE
            and found["unsupported"] == 0 and kept["unsupported"] == 0 and kept["unbalanced"]["mean"] <= KEPT)
    return good, [size, f"{found['start']['mean']:.1e}", f"{found['steps']:,}", f"{found['explicit_seconds']:.0f}",
                  found["iterations"], f"{found['linear_iterations']:,}",
                  f"{found['seconds'] - found['explicit_seconds']:.0f}", f"{found['unbalanced']['mean']:.1e}",
                  f"{found['unbalanced']['floor']:.1e}", found["unsupported"], f"{kept['unbalanced']['mean']:.1e}"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sizes", default="10k,100k")
    parser.add_argument("--degrees", type=float, default=10)
    parser.add_argument("--steps", type=int, default=1000)
    parser.add_argument("--threads", type=int)
    parser.add_argument("--program", default=str(TREE / "build/release/bin/eigengrain"))
    parser.add_argument("--out", type=Path)
    options = parser.parse_args()
    heads = ["balls", "ratio at first", "explicit steps", "s", "Newton", "linear", "s", "mean ratio", "floor",
             "unsupported", f"mean after {options.steps:,} cycles"]
    lines = ["| " + " | ".join(heads) + " |", "| " + " | ".join(["---:"] * len(heads)) + " |"]
    all_good = True
    for size in options.sizes.split(","):
        with tempfile.TemporaryDirectory() as folder:
            good, cells = row(options.program, size, options, Path(folder))
        all_good = all_good and good
        lines.append("| " + " | ".join(str(cell) for cell in cells) + " |")
    table = "\n".join(lines) + "\n"
    print(table, end="")
    if options.out:
        options.out.write_text(table)
    return 0 if all_good else 1


if __name__ == "__main__":
    sys.exit(main())
