#!/usr/bin/python3
"""What selective mass scaling adds to a packing of examples/ for steps beyond its limit, beside the other ways: the table of
docs/theory.md.

    lifts.py [--size 10k] [--steps 1,1.02,1.1,1.3,2] [--damping 0] [--program PATH] [--out FILE.md]

For each multiple of the limit of the cycle (damping: local, of the scene otherwise as it is) one `timestep --lift --certify`: the
mass that makes the step stable by the true limit, by weights of the bodies alone, by each body's own block (`differential`,
nothing lighter than it is) and alike for all (`uniform`), in percent of all, and how many bodies the first has.
"""
import argparse
import tempfile
from pathlib import Path

from ask import TREE, ask, packing


def look_at(options, *more):
    with tempfile.TemporaryDirectory() as folder:
        return ask(options.program, "timestep", packing(options.size), folder,
                   "--set", f"damping.local={options.damping:g}", *more)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--size", default="10k")
    parser.add_argument("--steps", default="1.02,1.1,1.3,2")
    parser.add_argument("--damping", type=float, default=0)
    parser.add_argument("--program", default=str(TREE / "build/release/bin/eigengrain"))
    parser.add_argument("--out")
    options = parser.parse_args()
    limit = look_at(options)["true"]["limit"]
    lines = ["| step over the limit | by the eigenvalue | by weights | `differential`, c >= 1 | `uniform` | proof |",
             "| ---: | ---: | ---: | ---: | ---: | --- |"]
    for factor in options.steps.split(","):
        lift = look_at(options, "--lift", f"{float(factor) * limit:.17g}", "--certify")["lift"]
        added = [f"{100 * lift[key] / lift['mass']:.2g}" for key in
                 ("added", "added_by_weights", "added_differential", "added_uniform")]
        added[0] += f" ({len(lift['bodies']):,})"
        lines.append(f"| {factor} | " + " | ".join(added) + f" | {lift['proof']} |")
    text = "\n".join(lines)
    print(text)
    if options.out:
        Path(options.out).write_text(text + "\n")


if __name__ == "__main__":
    main()
