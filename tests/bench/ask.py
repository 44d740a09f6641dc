"""One call of the program, for the benches: its JSON report."""
import json
import subprocess
import sys
from pathlib import Path

TREE = Path(__file__).resolve().parents[2]


def packing(size):
    """The scene of a settled packing of examples/."""
    return TREE / f"examples/scenes/packing_{size}.yaml"


def ask(program, verb, scene, folder, *options, may_fail=False):
    """What `program verb scene` reports, with its files in a folder; ends this program where it fails, unless it may."""
    report = Path(folder) / f"{verb}.json"
    command = [program, verb, str(scene), "--json", str(report), *options]
    print(" ".join(command), file=sys.stderr, flush=True)
    done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=None if may_fail else subprocess.PIPE, text=True,
                          check=False)
    if done.returncode != 0 and not may_fail:
        sys.exit(done.stderr)
    return json.loads(report.read_text())
