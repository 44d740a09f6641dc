#!/usr/bin/env python3
"""How good PFC3D's rule for dashpots (eq. 1.35) is: its step over the true limit of the cycle.

    damped_limits.py [PROGRAM]      the program; default build/release/bin/eigengrain

Prints the tables of docs/theory.md as Markdown: one contact, a chain, a packing; beta along and across the normal alike
(and beta_n alone), local damping alpha. The estimate is `diagonal` of `eigengrain timestep` over sqrt(1 + alpha), the
limit is `true.limit`.
"""
import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BETAS = [0, 0.05, 0.1, 0.2, 0.5, 1, 2]
ALPHAS = [0, 0.4, 0.8]


def scene(balls, more=""):
    return f"""
materials: [{{name: grain, density: 2500 kg/m3}}]
contacts: [{{between: [grain, grain], law: linear, kn: 1.0e5 N/m, ks: 5.0e4 N/m, friction: 0.5}}]
balls: {balls}
damping: {{local: 0}}
{more}
"""


def ball(x, y, z):
    return f"{{position: [{x:.15g}, {y:.15g}, {z:.15g}], radius: 0.01, material: grain}}"


def row(direction, count):
    length = math.sqrt(sum(c * c for c in direction))
    steps = [0.02 * (1 - 1e-9) * c / length for c in direction]
    return "[" + ", ".join(ball(*(i * s for s in steps)) for i in range(count)) + "]"


SCENES = {
    "pair along (1,0,0)": scene(row((1, 0, 0), 2)),
    "pair along (1,1,1)": scene(row((1, 1, 1), 2)),
    "chain of 60 along (1,0,0)": scene(row((1, 0, 0), 60)),
    "chain of 60 along (1,1,1)": scene(row((1, 1, 1), 60)),
    "1,000 balls, dense": scene(
        "[{fill: dense, mean_overlap: 1e-3, radius: 2 mm, material: grain, seed: 3}]",
        "periodic: {box: [37 mm, 37 mm, 37 mm]}"),
}


def ask(program, path, settings, folder):
    out = Path(folder) / "out.json"
    subprocess.run([program, "timestep", path, "--json", out] + [a for s in settings for a in ("--set", s)],
                   check=True, stdout=subprocess.DEVNULL)
    return json.loads(out.read_text(encoding="utf-8"))


def main():
    program = sys.argv[1] if len(sys.argv) > 1 else ROOT / "build/release/bin/eigengrain"
    with tempfile.TemporaryDirectory() as folder:
        for across in (1, 0):
            print(f"\nbeta_s = {'beta_n' if across else '0'}; rule 1.35 over the true limit at alpha = "
                  f"{', '.join(map(str, ALPHAS))}\n")
            print("| | " + " | ".join(f"β {b}" for b in BETAS) + " |")
            print("| --- |" + " --- |" * len(BETAS))
            for name, text in SCENES.items():
                path = Path(folder) / "scene.yaml"
                path.write_text(text, encoding="utf-8")
                cells = []
                for beta in BETAS:
                    ratios = []
                    for alpha in ALPHAS:
                        found = ask(program, path, [f"contacts.0.beta_n={beta}", f"contacts.0.beta_s={across * beta}",
                                                    f"damping.local={alpha}"], folder)
                        dt = next(e["dt"] for e in found["estimates"] if e["name"] == "diagonal")
                        ratios.append(dt / math.sqrt(1 + alpha) / found["true"]["limit"])
                    cells.append(" ".join(f"{r:.2f}" for r in ratios))
                print(f"| {name} | " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main()
