#!/usr/bin/python3
"""Speed and memory of Eigengrain's explicit cycle beside LAMMPS, LIGGGHTS and YADE, on one scene and in one run.

    run.py [--sizes 1k,10k,100k] [--cores 1,2] [--repeat 3] [--program PATH] [--lammps PATH] [--out FILE.md]
    run.py --check       only whether the codes agree on the forces; exit 77 if there is no other code

Runs the codes by turns, so that what else the machine does falls on all of them. See README.md.
"""
import argparse
import csv
import json
import os
import platform
import re
import shutil
import subprocess
import sys
import time
from collections import namedtuple
from functools import partial
from pathlib import Path
from statistics import median

HERE = Path(__file__).resolve().parent
TREE = HERE.parents[1]

# A few seconds each, some ten for YADE.
STEPS = {"tiny": 10_000, "1k": 5000, "10k": 1000, "100k": 150, "1M": 20}
DROP_STEPS = (240, 250, 280, 300, 310)  # when to look at the bed that falls; see README.md
YADE_VERLET = "5e-4"  # m; see README.md
# Of the floor force over weight; where they come from: README.md.
TOLERANCE = {"drop": 0.02, "1k": 0.005, "10k": 0.005, "100k": 0.005, "1M": 0.005}

Scene = namedtuple("Scene", "folder size box balls weight steps")
Result = namedtuple("Result", "speed floor peak version")  # particle-steps/s, floor force over weight, bytes, text


class Failed(Exception):
    """A code that ran and gave no result; the text is its command and its output."""


def say(*words, sep=" "):
    print(*words, file=sys.stderr, flush=True, sep=sep)


# --- one run -------------------------------------------------------------------------------------------------------


def peaks(pid, seen):
    """Notes in `seen` the peak resident set, in bytes, of a process and of those it started."""
    try:
        memory = re.search(r"VmHWM:\s*(\d+)", Path(f"/proc/{pid}/status").read_text())
        if memory:
            seen[pid] = int(memory[1]) * 1024
        for task in Path(f"/proc/{pid}/task").iterdir():
            for child in (task / "children").read_text().split():
                peaks(int(child), seen)
    except OSError:
        pass  # it ended meanwhile


def execute(command, scene, name):
    """(output, peak resident bytes) of a command.

    The peak is read from /proc while it runs. What wait4() reports would include this Python's own size, and of
    several MPI processes only the largest.
    """
    path = scene.folder / f"{name}.log"
    environment = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    if name in ("lammps", "liggghts"):
        environment["OMP_NUM_THREADS"] = "1"
    with open(path, "w") as log:
        process = subprocess.Popen(command, cwd=scene.folder, env=environment, stdin=subprocess.DEVNULL, stdout=log,
                                   stderr=subprocess.STDOUT)
        seen = {}
        while process.poll() is None:
            peaks(process.pid, seen)
            time.sleep(0.01)
    output = path.read_text(errors="replace")
    if process.returncode != 0:
        raise Failed(f"{' '.join(command)}\nexit {process.returncode}\n{output}")
    return output, sum(seen.values())


def found(pattern, output, command):
    match = re.search(pattern, output)
    if not match:
        raise Failed(f"{' '.join(command)}\nno `{pattern}` in\n{output}")
    return match[1]


def eigengrain(program, scene, cores):
    """All that this script knows of Eigengrain's command line and of what it writes."""
    out = scene.folder / "out"
    shutil.rmtree(out, ignore_errors=True)
    report = scene.folder / "eigengrain.json"
    report.unlink(missing_ok=True)
    command = [program, "run", f"{scene.size}.yaml", "--threads", str(cores), "--json", str(report),
               "--output", str(out)]
    output, peak = execute(command, scene, "eigengrain")
    try:
        figures = json.loads(report.read_text())
        with open(out / "walls.csv") as table:
            row = list(csv.DictReader(table))[-1]
        floor = next(float(row[k]) for k in row if "-z" in k and " z " in k and k.rstrip().endswith("[N]"))
        speed = scene.balls * figures["steps"] / figures["seconds"]
    except (OSError, ValueError, KeyError, IndexError, StopIteration) as error:
        raise Failed(f"{' '.join(command)}\n{type(error).__name__}: {error}\n{output}") from error
    return Result(speed, abs(floor) / scene.weight, peak, f"Eigengrain {figures.get('version', '')}".strip())


def lammps(program, script, skin, scene, cores):
    """LAMMPS, or LIGGGHTS, which comes from it."""
    command = [program, "-in", str(HERE / script), "-log", "none"]
    variables = {"data": f"{scene.size}.data", "wx": scene.box[0], "wy": scene.box[1], "skin": skin,
                 "steps": scene.steps}
    for name, value in variables.items():
        command += ["-var", name, str(value)]
    if cores > 1:
        command = ["mpirun", "--bind-to", "none", "--oversubscribe", "-np", str(cores)] + command
    output, peak = execute(command, scene, script.removesuffix(".in"))
    seconds = float(found(r"Loop time of (\S+)", output, command))
    floor = float(found(r"floor over weight (\S+)", output, command))
    version = found(r"(LAMMPS \(.*?\)|LIGGGHTS-PUBLIC [^,]*)", output, command)
    return Result(scene.balls * scene.steps / seconds, floor, peak, version)


def yade(scene, cores):
    command = ["yade", f"-j{cores}", "-n", "-x", str(HERE / "yade_run.py"), f"{scene.size}.txt", str(scene.steps),
               YADE_VERLET]
    output, peak = execute(command, scene, "yade")
    figures = json.loads(found(r"RESULT (\{.*\})", output, command))
    speed = figures["balls"] * figures["steps"] / figures["seconds"]
    return Result(speed, figures["floor"], peak, found(r"Welcome to (Yade \S+)", output, command))


# --- all of them ---------------------------------------------------------------------------------------------------


def make_scene(folder, size, steps):
    """Writes the scene in a process of its own: a million balls would stay in this one's memory."""
    say(f"scene {size}, {steps} steps")
    subprocess.run([sys.executable, str(HERE / "packings.py"), str(folder), size, str(steps)], check=True)
    with open(folder / f"{size}.txt") as text:
        _, _, wx, wy, _, _, balls, _, weight = text.readline().split()
    return Scene(folder, size, (wx, wy), int(balls), float(weight), steps)


class Comparison:
    """The codes that are there, and what went wrong with them."""

    def __init__(self, program, folder, lammps_program="lmp"):
        self.folder = folder
        self.errors = []
        self.versions = {}
        self.codes = {"Eigengrain": partial(eigengrain, program)}
        for name, program in (("LAMMPS", lammps_program), ("LIGGGHTS", "liggghts")):
            if not shutil.which(program):
                say(f"skipped: {name}, no program `{program}` (Debian package {name.lower()})")
                continue
            own = partial(lammps, program, f"{name.lower()}.in")
            self.codes[f"{name}, skin 1 mm"] = partial(own, "1e-3")
            self.codes[f"{name}, skin 0.2 mm"] = partial(own, "2e-4")
        if shutil.which("yade"):
            self.codes["YADE"] = yade
        else:
            say("skipped: YADE, no program `yade` (Debian package yade)")

    def turns(self, scene, cores, repeat):
        """{code: results, one a round} of the codes that never failed."""
        results = {name: [] for name in self.codes}
        if cores > 1 and not shutil.which("mpirun"):
            say("skipped: LAMMPS and LIGGGHTS on several cores, no program `mpirun`")
            results = {name: [] for name in results if name in ("Eigengrain", "YADE")}
        for _ in range(repeat):
            for name in list(results):
                try:
                    result = self.codes[name](scene, cores)
                except Failed as failure:
                    self.errors.append(f"{name} failed, {scene.size}, {cores} cores")
                    say(f"{self.errors[-1]}:\n{failure}")
                    del results[name]
                    continue
                say(f"{scene.size:>5} {cores} {name:28} {result.speed / 1e6:8.3f} M/s  {result.peak / 2**20:8.1f} MiB"
                    f"  floor {result.floor:.5f}")
                results[name].append(result)
                self.versions[name.split(",")[0]] = result.version
        self.agree(scene, results)
        return results

    def agree(self, scene, results):
        """Notes an error where the floors differ from the first code's by more than the tolerance."""
        if scene.size not in TOLERANCE:  # ten balls that bounce: not a matter of forces
            return
        floors = {name: median(r.floor for r in rows) for name, rows in results.items() if rows}
        reference = next(iter(floors.values()), 0)
        for name, floor in floors.items():
            if not abs(floor - reference) <= TOLERANCE[scene.size] * reference:
                self.errors.append(f"{scene.size}, {scene.steps} steps: floor over weight {floor:.5f} in {name}, "
                                   f"{reference:.5f} in {next(iter(floors))}")
                say(self.errors[-1])

    def check(self, cores=1):
        """Floor over weight of the bed that falls: {code: [one for each of DROP_STEPS]}."""
        floors = {}
        for steps in DROP_STEPS:
            for name, rows in self.turns(make_scene(self.folder, "drop", steps), cores, 1).items():
                floors.setdefault(name, []).append(rows[0].floor)
        return floors


def spread(values, digits):
    low, middle, high = min(values), median(values), max(values)
    return f"{middle:.{digits}f}" + (f" ({low:.{digits}f}–{high:.{digits}f})" if len(values) > 1 else "")


def table_rows(scene, cores, results, bare):
    """Lines of the report for one scene and one number of cores."""
    own = results.get("Eigengrain")
    for name, rows in results.items():
        ratio = pairs = "–"
        if own and rows is not own:
            ratio = f"{median(r.speed for r in own) / median(r.speed for r in rows):.2f}"
            pairs = spread([a.speed / b.speed for a, b in zip(own, rows)], 2)
        memory = "–"
        # Below 10k balls the parts of a code that do not grow with them differ by more than the balls take.
        if scene.balls >= 10_000 and bare.get(name):
            memory = f"{(max(r.peak for r in rows) - bare[name][0].peak) / scene.balls:,.0f}"
        cells = [f"{scene.balls:,}", str(cores), name, spread([r.speed / 1e6 for r in rows], 2), ratio, pairs, memory,
                 f"{median(r.floor for r in rows):.4f}"]
        yield "| " + " | ".join(cells) + " |"


def machine():
    info = Path("/proc/cpuinfo").read_text()
    model = re.search(r"model name\s*: (.*)", info)
    return f"{os.cpu_count()} processors ({model[1] if model else platform.machine()})"


def measure(comparison, sizes, cores_list, repeat):
    """The report, in Markdown."""
    load = os.getloadavg()[0]
    dropped = comparison.check()
    tiny = make_scene(comparison.folder, "tiny", STEPS["tiny"])
    bare = {cores: comparison.turns(tiny, cores, 1) for cores in cores_list}
    lines = []
    for size in sizes:
        scene = make_scene(comparison.folder, size, STEPS[size])
        for cores in cores_list:
            rows = list(table_rows(scene, cores, comparison.turns(scene, cores, repeat), bare[cores]))
            say(*rows, sep="\n")  # a million balls take long: what is known is not lost if they are given up
            lines += rows
    head = [
        f"{machine()}, load {load:.1f} at the start. {', '.join(comparison.versions.values())}. "
        f"Medians (least–greatest) of {repeat} rounds, by turns. Bytes: peak resident set above that on 10 balls.",
        "",
        "| balls | cores | code | million particle-steps/s | Eigengrain / it | of neighbouring runs | bytes a ball "
        "| floor force / weight |",
        "| ---: | ---: | --- | ---: | ---: | ---: | ---: | ---: |",
    ]
    tail = ["", "1,000 balls that fall by 0.2 mm, floor force / weight after "
            f"{', '.join(map(str, DROP_STEPS))} steps: "
            + "; ".join(f"{name} {', '.join(f'{f:.4f}' for f in floors)}" for name, floors in dropped.items()) + "."]
    return "\n".join(head + lines + tail + [f"\n**{error}**" for error in comparison.errors]) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sizes", default="1k,10k,100k", help="out of 1k,10k,100k,1M")
    parser.add_argument("--cores", default="1,2")
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--program", default=str(TREE / "build/release/bin/eigengrain"))
    parser.add_argument("--lammps", default="lmp", help="another LAMMPS, e.g. one built for this processor")
    parser.add_argument("--out", help="the report; default: stdout")
    parser.add_argument("--work", type=Path, default=TREE / "build/peers", help="folder of scenes and logs")
    parser.add_argument("--check", action="store_true", help="only whether the codes agree")
    arguments = parser.parse_args()
    sizes, cores = arguments.sizes.split(","), [int(c) for c in arguments.cores.split(",")]
    if not set(sizes) <= {"1k", "10k", "100k", "1M"}:
        parser.error("--sizes: out of 1k, 10k, 100k, 1M")

    program = shutil.which(arguments.program)
    if not program:
        sys.exit(f"no program {arguments.program}: build the preset release, or say --program PATH")
    comparison = Comparison(os.path.abspath(program), arguments.work.resolve(), arguments.lammps)
    if arguments.check:
        if len(comparison.codes) == 1:
            return 77
        comparison.check()
    else:
        report = measure(comparison, sizes, cores, arguments.repeat)
        if arguments.out:
            Path(arguments.out).write_text(report)
        else:
            print(report, end="")
    return 1 if comparison.errors else 0


if __name__ == "__main__":
    sys.exit(main())
