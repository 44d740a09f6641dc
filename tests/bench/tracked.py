#!/usr/bin/python3
"""What the step that is tracked saves: packings of examples/ after gravity has tilted, run to the same unbalanced ratio
by the estimate of explicit codes (safety 0.8) and by policy `tracked`, in turn.

    tracked.py [--sizes 10k,100k] [--degrees 10] [--ratio 1e-4] [--repeat 3] [--threads 1] [--program PATH] [--out FILE.md]

With local damping 0.7, and with dashpots instead (beta along n and across). Writes a Markdown table: steps and
seconds of the cycle, medians over the repetitions, tracked over estimate, and the part of the time in which steps were proven.
"""
import argparse
import math
import statistics
import tempfile
from pathlib import Path

from ask import TREE, ask, packing

DAMPINGS = {"local damping 0.7": []} | {
    f"dashpots {beta}": ["--set", "damping.local=0", "--set", f"contacts.0.beta_n={beta}", "--set",
                         f"contacts.0.beta_s={beta}"] for beta in ("0.05", "0.01")}
POLICIES = {"estimate": [], "tracked": ["--set", "timestep={policy: tracked}"]}


def run(options, size, damping, policy, folder):
    tilt = math.radians(options.degrees)
    return ask(options.program, "run", packing(size), folder, "--output", str(folder), "--threads", str(options.threads),
               "--set", f"gravity=[{9.81 * math.sin(tilt):.17g}, 0, {-9.81 * math.cos(tilt):.17g}]",
               "--set", f"run={{steps: 1000000, until: {{unbalanced: {options.ratio:g}}}}}",
               *DAMPINGS[damping], *POLICIES[policy])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sizes", default="10k,100k")
    parser.add_argument("--degrees", type=float, default=10)
    parser.add_argument("--ratio", type=float, default=1e-4)
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--program", default=str(TREE / "build/release/bin/eigengrain"))
    parser.add_argument("--out")
    options = parser.parse_args()
    lines = ["| packing | damping | estimate: steps, s | tracked: steps, s | steps | time | proving |",
             "| --- | --- | --- | --- | ---: | ---: | ---: |"]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for size in options.sizes.split(","):
            for damping in DAMPINGS:
                found = {policy: [] for policy in POLICIES}
                for _ in range(options.repeat):
                    for policy in POLICIES:
                        found[policy].append(run(options, size, damping, policy, folder))
                seconds = {p: statistics.median(r["seconds"] for r in runs) for p, runs in found.items()}
                steps = {p: runs[0]["steps"] for p, runs in found.items()}
                proving = statistics.median(r["policy"]["seconds"] / r["seconds"] for r in found["tracked"])
                lines.append(f"| {size} | {damping} | {steps['estimate']:,}, {seconds['estimate']:.1f} "
                             f"| {steps['tracked']:,}, {seconds['tracked']:.1f} "
                             f"| {steps['tracked'] / steps['estimate']:.3f} "
                             f"| {seconds['tracked'] / seconds['estimate']:.3f} | {100 * proving:.1f}% |")
    text = "\n".join(lines)
    print(text)
    if options.out:
        Path(options.out).write_text(text + "\n")


if __name__ == "__main__":
    main()
