#!/usr/bin/env python3
"""What a step of deformable bodies costs: element steps a second by kind and solid, beside the memory that one step streams.

    deformables.py [--program P] [--elements 100000] [--steps 200] [--threads 1,2]

A free block that vibrates, no contacts. Bytes a step and element are those that have to move when nothing stays in a cache:
gradients and volumes of its integration points, its nodes' rows, and its corner forces once written and once read. The
bandwidth is that of a copy of 256 MB by numpy on one core, measured in the same run.
"""
import argparse
import json
import pathlib
import subprocess
import tempfile
import time

import numpy as np

SCENE = """materials: [{{name: rubber, density: 1000, young: 1 MPa, poisson: 0.3}}]
contacts: [{{between: [any, any], law: linear, kn: 1}}]
deformables:
  - {{block: {{min: [0, 0, 0], max: [1, 1, 1], cells: [{n}, {n}, {n}], element: {kind}}}, material: rubber, model: {model},
     loads: [{{box: {{min: [0.99, -1, -1], max: [2, 2, 2]}}, force: [0, 0, -1]}}]}}
damping: {{local: 0}}
timestep: {{policy: bound}}
run: {{steps: {steps}}}
outputs: {{checkpoint: 1000000}}
"""
KINDS = {"tet4": (6, 4, 1), "hex8": (1, 8, 8), "tet10": (6, 10, 4)}  # a brick, nodes, points


def bandwidth():
    a = np.ones(16_000_000)
    b = np.empty_like(a)
    best = min(timed(lambda: np.copyto(b, a)) for _ in range(5))
    return 3 * a.nbytes / best  # the store reads the line first


def timed(work):
    begin = time.perf_counter()
    work()
    return time.perf_counter() - begin


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default="build/release/bin/eigengrain")
    parser.add_argument("--elements", type=int, default=100_000)
    parser.add_argument("--steps", type=int, default=200)
    parser.add_argument("--threads", default="1,2")
    options = parser.parse_args()
    stream = bandwidth()
    print(f"copy of 128 MB by one core: {stream / 1e9:.1f} GB/s")
    print("element  solid                   threads  million element steps/s  bytes  of the limit by memory")
    with tempfile.TemporaryDirectory() as folder:
        for kind, (a_brick, nodes, points) in KINDS.items():
            n = round((options.elements / a_brick) ** (1 / 3))
            size = a_brick * n**3
            moved = points * (8 + 24 * nodes) + 4 * nodes + 2 * 24 * nodes
            for model in ("linear", "corotational", "neo-hookean"):
                scene = pathlib.Path(folder) / "block.yaml"
                scene.write_text(SCENE.format(n=n, kind=kind, model=model, steps=options.steps))
                for threads in options.threads.split(","):
                    subprocess.run([options.program, "run", scene, "--threads", threads, "--json", f"{folder}/run.json",
                                    "--output", folder], check=True, capture_output=True)
                    seconds = json.loads(pathlib.Path(f"{folder}/run.json").read_text())["seconds"]
                    rate = size * options.steps / seconds
                    part = rate * moved / (stream * int(threads))
                    print(f"{kind:8} {model:23} {threads:>7} {rate / 1e6:24.2f} {moved:6} {part:8.2f}", flush=True)


if __name__ == "__main__":
    main()
