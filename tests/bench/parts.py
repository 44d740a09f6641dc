#!/usr/bin/python3
"""What each part of the explicit method costs a step: the cycle with it beside the cycle without, by turns.

    parts.py [--size 10k] [--steps 1000] [--repeat 5] [--threads 1] [--program PATH] [--out FILE.md]

The scene is a settled packing of examples/, balls with friction and local damping in a box. Every part is switched in
alone (or left out), on the scene and the timestep of all; the table gives the median over the rounds of the time of a
step over that of the plain scene which ran just before it, and how far the rounds lie apart.
"""
import argparse
import json
import statistics
import subprocess
import sys
import tempfile
from collections import namedtuple
from pathlib import Path

TREE = Path(__file__).resolve().parents[2]
DT = "1e-5"

Part = namedtuple("Part", "name settings edit", defaults=([], None))


def law(**keys):
    return [f"contacts.0.{key}={value}" for key, value in keys.items()]


def floor(text):
    """The same box with another floor: the side -z of the box is opened for it."""
    def edit(scene):
        changed = scene.replace("open: [+z]", "open: [+z, -z]")
        assert changed != scene
        return changed.replace("walls:\n", f"walls:\n  - {{{text}, material: grain}}\n")
    return edit


def periodic(scene):
    """Sides that repeat in x and y instead of walls, and a floor."""
    head, _, tail = scene.partition("walls:")
    box = tail.split("max: [")[1].split("]")[0]
    damping = tail[tail.index("damping:"):]
    return (f"{head}periodic: {{box: [{box}], axes: [x, y]}}\n"
            f"walls:\n  - {{plane: {{point: [0, 0, 0], normal: [0, 0, 1]}}, material: grain}}\n{damping}")


def clumped(scene):
    """Each ball as a clump of one."""
    before, _, rest = scene.partition("balls:")
    after = rest[rest.index("walls:"):]
    packing = rest.split("file: ")[1].split(",")[0].split("}")[0].strip()
    entries = []
    for line in Path(packing).read_text().splitlines():
        if line.strip() and not line.startswith("#"):
            x, y, z, r = line.split()
            entries.append(f"  - {{balls: [{{at: [0, 0, 0], radius: {r}}}], material: grain, "
                           f"instances: [{{position: [{x}, {y}, {z}]}}]}}\n")
    return f"{before}clumps:\n{''.join(entries)}{after}"


def sheared(scene):
    """The same, and the cell deforms."""
    return periodic(scene).replace(
        "axes: [x, y]", "axes: [x, y], velocity_gradient: [[0, 0.01, 0], [0, 0, 0], [0, 0, 0]]")


def parts(width):
    corners = f"[[-1, -1, 0], [{width + 1}, -1, 0], [{width + 1}, {width + 1}, 0], [-1, {width + 1}, 0]]"
    return [
        Part("the same again"),
        Part("without friction, so without rotation", law(friction=0)),
        Part("without local damping", ["damping.local=0"]),
        Part("small-angle forms", law(small_angle="true")),
        Part("increments at the end of the step", law(end_step="true")),
        Part("projected history", law(projected="true")),
        Part("levers to the surface", ["levers=surface"]),
        Part("dashpots along and across n", law(beta_n=0.2, beta_s=0.2)),
        Part("rolling and twisting resistance", law(rolling_friction=0.1, kr=0.1)),
        Part("parallel bonds at the touching contacts",
             ["contacts.0.bond={kind: parallel, kn: 1e9 Pa/m, ks: 5e8 Pa/m, radius: 0.5}"]),
        Part("contact bonds at the touching contacts", ["contacts.0.bond={kind: contact}"]),
        Part("Hertz contacts", ["contacts.0={between: [any, any], law: hertz, effective_young: 0.156 GPa, "
                                "effective_shear: 0.035 GPa, friction: 0.5}"]),
        Part("hysteretic springs", [
            "contacts.0={between: [any, any], law: hysteretic, kn: 1e5, restitution: 0.8, ks: 5e4, friction: 0.5}"]),
        Part("a force on each ball", ["balls.0.force=[1e-9, 0, 0]"]),
        Part("a local damping of their own", ["balls.0.damping=0.7"]),
        Part("radii that grow", ["balls.0.growth={factor: 1.0000001, over: 1 s}"]),
        Part("scaled masses", ["timestep={policy: bound}", f"mass_scaling={{form: differential, dt: {DT}}}"]),
        Part("a cell that repeats in x and y", edit=periodic),
        Part("the same cell in shear", edit=sheared),
        Part("each ball as a clump of one", edit=clumped),
        Part("a polygon as floor", edit=floor(f"polygon: {{corners: {corners}}}")),
        Part("a floor that moves", edit=floor(
            "plane: {point: [0, 0, 0], normal: [0, 0, 1]}, velocity: [0.01, 0, 0]")),
        Part("an energy ledger", ["histories=[{file: table.csv, every: 1000000, of: [ledger]}]"]),
    ]


class Runs:
    def __init__(self, options, folder):
        self.options, self.folder = options, folder
        self.scene = (TREE / f"examples/scenes/packing_{options.size}.yaml").read_text().replace(
            "../data", str(TREE / "examples/data"))

    def seconds(self, part):
        """Of a step, s."""
        file = self.folder / "scene.yaml"
        file.write_text(part.edit(self.scene) if part.edit else self.scene)
        report = self.folder / "report.json"
        command = [self.options.program, "run", str(file), "--json", str(report), "--output", str(self.folder / "out"),
                   "--threads", str(self.options.threads)]
        settings = ["timestep.policy=fixed", f"timestep.dt={DT}", f"run.steps={self.options.steps}", *part.settings]
        for setting in settings:
            command += ["--set", setting]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode != 0:
            raise RuntimeError(f"{part.name}: {' '.join(command)}\n{done.stdout}{done.stderr}")
        figures = json.loads(report.read_text())
        return figures["seconds"] / figures["steps"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--size", default="10k", choices=["10k", "100k"])
    parser.add_argument("--steps", type=int, default=1000)
    parser.add_argument("--repeat", type=int, default=5)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--program", default=str(TREE / "build/release/bin/eigengrain"))
    parser.add_argument("--out", type=Path)
    options = parser.parse_args()
    lines = ["| part | time of a step over the plain scene's | least–greatest | ns a ball |", "| --- | ---: | ---: | ---: |"]
    balls = {"10k": 10_000, "100k": 100_000}[options.size]
    failed = False
    with tempfile.TemporaryDirectory() as folder:
        runs = Runs(options, Path(folder))
        plain = Part("plain")
        width = {"10k": 0.21, "100k": 0.45}[options.size]
        for part in parts(width):
            try:
                pairs = [(runs.seconds(plain), runs.seconds(part)) for _ in range(options.repeat)]
            except RuntimeError as error:
                print(error, file=sys.stderr)
                failed = True
                continue
            ratios = [second / first for first, second in pairs]
            ns = statistics.median(second for _, second in pairs) / balls * 1e9
            lines.append(f"| {part.name} | {statistics.median(ratios):.2f} | {min(ratios):.2f}–{max(ratios):.2f} "
                         f"| {ns:.0f} |")
            print(lines[-1], file=sys.stderr, flush=True)
    report = "\n".join(lines) + "\n"
    if options.out:
        options.out.write_text(report)
    else:
        print(report, end="")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
