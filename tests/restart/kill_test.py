#!/usr/bin/env python3
"""Kills a run with checkpoints at random moments (SIGKILL) and lets it go on: the newest state must open, and the
end must equal that of the uninterrupted run to the bit, on whatever number of threads the parts ran.

    kill_test.py PROGRAM [KILLS]      100 kills by default
"""
import pathlib
import random
import signal
import subprocess
import sys
import tempfile
import time

try:
    import h5py
    import numpy
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

PROGRAM = pathlib.Path(sys.argv[1])
KILLS = int(sys.argv[2]) if len(sys.argv) > 2 else 100

# Balls that fall into a box in a loose grid: contacts form, slide and open, and lists are renewed all the time.
SIDE, HEIGHT, RADIUS = 7, 9, 5e-3
SCENE = """
gravity: [0, 0, -9.81]
materials: [{name: grain, density: 2500}]
contacts: [{between: [grain, grain], law: linear, kn: 1e5, ks: 5e4, friction: 0.5}]
balls: [{file: balls.txt, material: grain}]
walls: [{box: {min: [0, 0, 0], max: [0.09, 0.09, 0.5], open: [+z]}, material: grain}]
damping: {local: 0.1}
run: {steps: 1500}
outputs: {checkpoint: 50, series: 250}
histories: [{file: energy.csv, every: 10, of: [energies, unbalanced, walls]}]
"""


def write_scene(folder):
    chance = random.Random(1)
    with open(folder / "balls.txt", "w") as out:
        for k in range(HEIGHT):
            for j in range(SIDE):
                for i in range(SIDE):
                    x, y, z = (12e-3 * n + 8e-3 + chance.uniform(-5e-4, 5e-4) for n in (i, j, k))
                    out.write(f"{x!r} {y!r} {z!r} {RADIUS * chance.uniform(0.9, 1.0)!r}\n")
    scene = folder / "fall.yaml"
    scene.write_text(SCENE)
    return scene


def command(source, output, threads):
    return [PROGRAM, "run", source, "--output", output, "--threads", str(threads)]


def contents(state):
    """Every dataset of a state file, and the attributes of its groups (not of its root: date, threads)."""
    found = {}

    def visit(name, thing):
        if isinstance(thing, h5py.Dataset):
            found[name] = thing[()].tobytes() if isinstance(thing[()], numpy.ndarray) else thing[()]
        for key, value in thing.attrs.items():
            if name != "provenance":
                found[f"{name}@{key}"] = numpy.asarray(value).tobytes()

    with h5py.File(state, "r") as file:
        file.visititems(visit)
        for key in ("time", "step", "dt", "next_dt"):
            found[key] = numpy.asarray(file.attrs[key]).tobytes() if key in file.attrs else found.get(key)
    return found


def require(condition, what):
    if not condition:
        print(what)
        sys.exit(1)


def main():
    chance = random.Random(2)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        scene = write_scene(folder)
        started = time.monotonic()
        subprocess.run(command(scene, folder / "whole", 1), check=True, capture_output=True)
        duration = time.monotonic() - started
        whole = contents(folder / "whole" / "fall.h5")
        require(len(whole) > 10, f"only {len(whole)} parts in the state: {sorted(whole)}")
        history = (folder / "whole" / "energy.csv").read_bytes()
        series = (folder / "whole" / "fall.pvd").read_bytes()

        before_first_state = interrupted = 0
        for kill in range(KILLS):
            parts = folder / f"parts{kill}"
            running = subprocess.Popen(command(scene, parts, chance.choice([1, 2])), stdout=subprocess.DEVNULL,
                                       stderr=subprocess.DEVNULL)
            time.sleep(chance.uniform(0, duration))
            running.send_signal(signal.SIGKILL)
            interrupted += running.wait() == -signal.SIGKILL
            state = parts / "fall.h5"
            source = state if state.exists() else scene
            before_first_state += source == scene
            done = subprocess.run(command(source, parts, chance.choice([1, 2, 4])), capture_output=True, text=True)
            require(done.returncode == 0, f"kill {kill}: the run did not go on:\n{done.stderr}")
            ended = contents(state)
            for part in sorted(whole.keys() | ended.keys()):
                require(whole.get(part) == ended.get(part), f"kill {kill}: {part} differs")
            require((parts / "energy.csv").read_bytes() == history, f"kill {kill}: the history differs")
            require((parts / "fall.pvd").read_bytes() == series, f"kill {kill}: the series differs")
    print(f"{KILLS} kills, {interrupted} of them during the run, {before_first_state} before its first state: "
          "all ended with the same bits")
    require(interrupted > KILLS // 4, "most kills came too late; the test shows nothing")


if __name__ == "__main__":
    main()
