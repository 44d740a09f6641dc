#!/usr/bin/python3
"""Every estimate of the timestep on some scenes: its ratio to the truth and its time, as a Markdown table.

    estimates.py [--repeat 3] [--threads 1] [--program PATH] [SCENE ...]

Default scenes are the two packings of examples/. The time is the least of the repetitions; estimates that claim nothing
and are below the truth are plain numbers, those above it are marked `!`.
"""
import argparse
import json
import os
import subprocess
import tempfile
from pathlib import Path

TREE = Path(__file__).resolve().parents[2]


def report_of(program, scene, threads):
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "report.json"
        environment = dict(os.environ, OMP_NUM_THREADS=str(threads), OMP_WAIT_POLICY="passive")
        subprocess.run([program, "timestep", scene, "--json", out], check=True, env=environment, stdout=subprocess.DEVNULL)
        return json.loads(out.read_text())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="*", default=[TREE / f"examples/scenes/packing_{size}.yaml" for size in ("10k", "100k")])
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--program", default=TREE / "build/release/bin/eigengrain")
    arguments = parser.parse_args()

    rows = {}
    titles = []
    for scene in arguments.scenes:
        runs = [report_of(arguments.program, scene, arguments.threads) for _ in range(arguments.repeat)]
        titles.append(f"{runs[0]['bodies']:,}")
        truth = min(run["true"]["seconds"] for run in runs)
        rows.setdefault("true", ["true", "", ""]).extend(["1", f"{1000 * truth:.3g}"])
        for place, estimate in enumerate(runs[0]["estimates"]):
            row = rows.setdefault(estimate["name"], [estimate["name"], estimate["source"], estimate["claim"]])
            seconds = min(run["estimates"][place]["seconds"] for run in runs)
            mark = "" if estimate["safe"] else " !"
            row.extend([f"{estimate['ratio_to_true']:.4f}{mark}", f"{1000 * seconds:.2g}"])
    print("| estimate | source | claim | " + " | ".join(f"{title} | ms" for title in titles) + " |")
    print("| --- | --- | --- | " + " | ".join(["---: | ---:"] * len(titles)) + " |")
    for row in rows.values():
        print("| " + " | ".join(row) + " |")


main()
