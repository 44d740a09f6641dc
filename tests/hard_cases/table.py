#!/usr/bin/env python3
"""The tables of docs/hard-cases.md: every scene of examples/scenes/hard_cases, every estimate.

    table.py build/release/bin/eigengrain            # writes them into docs/hard-cases.md
    table.py build/release/bin/eigengrain --print    # to the screen

Each scene is asked by `eigengrain timestep --empirical --json`; the words about it are the comment at its top.
"""
import argparse
import json
import pathlib
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).parents[2]
SCENES = ROOT / "examples/scenes/hard_cases"
PAGE = ROOT / "docs/hard-cases.md"
BEGIN = "<!-- tables: tests/hard_cases/table.py -->\n"
END = "<!-- end of tables -->\n"


def words(scene):
    """The comment at the top of a scene: what it is and why an estimate fails; and the closed form or reference."""
    lines = []
    for line in scene.read_text().splitlines():
        if not line.startswith("#"):
            break
        lines.append(line[1:].strip())
    text = " ".join(lines).replace("|", "\\|")
    for mark in ("Closed forms", "Closed form", "Reference"):
        if f" {mark}" in text:
            why, form = text.split(f" {mark}", 1)
            return why, (mark + form).split(": ", 1)[-1] if form.startswith(":") else mark + form
    raise SystemExit(f"{scene}: the comment at the top names no closed form and no reference")


def ask(program, scene):
    with tempfile.TemporaryDirectory() as folder:
        result = pathlib.Path(folder) / "result.json"
        subprocess.run([program, "timestep", str(scene), "--empirical", "--json", str(result)], check=True,
                       stdout=subprocess.DEVNULL)
        return json.loads(result.read_text())


def ratio(value):
    if value is None:
        return "–"
    text = f"{value:.4f}" if value < 100 else f"{value:.3g}"
    return f"**{text}**" if value > 1 + 1e-9 else text


def of_scenes(reports):
    yield "| | scene | why an estimate fails | closed form or reference |"
    yield "| ---: | --- | --- | --- |"
    for number, (scene, _) in enumerate(reports, 1):
        why, form = words(scene)
        yield f"| {number} | [{scene.stem}](../examples/scenes/hard_cases/{scene.name}) | {why} | {form} |"


def of_limits(reports):
    yield "| | scene | Δt true [s] | limit of the cycle / true | by running / limit | default step / limit | linear |"
    yield "| ---: | --- | ---: | ---: | ---: | ---: | --- |"
    for number, (scene, report) in enumerate(reports, 1):
        true = report["true"]
        if true["dt"] is None:
            yield f"| {number} | {scene.stem} | – | – | – | – | nothing touches at first |"
            continue
        runs = report["empirical"]
        yield (f"| {number} | {scene.stem} | {true['dt']:.6g} | {true['limit'] / true['dt']:.4f} "
               f"| {runs['ratio_to_limit']:.4f} | {ratio(report['policy']['ratio_to_limit'])} "
               f"| {'yes' if runs['linear'] else 'no'} |")


def of_estimates(reports):
    asked = [(number, report) for number, (_, report) in enumerate(reports, 1) if report["true"]["dt"] is not None]
    ratios = [{e["name"]: e["ratio_to_true"] for e in report["estimates"]} for _, report in asked]
    names = list(dict.fromkeys(name for of_scene in ratios for name in of_scene))  # a scene may not have all
    yield "| estimate | " + " | ".join(str(number) for number, _ in asked) + " |"
    yield "| --- |" + " ---: |" * len(asked)
    for name in names:
        yield f"| {name} | " + " | ".join(ratio(of_scene.get(name)) for of_scene in ratios) + " |"


def tables(program):
    reports = [(scene, ask(program, scene)) for scene in sorted(SCENES.glob("*.yaml"))]
    parts = [
        "## Scenes\n", *of_scenes(reports),
        "\n## Limits\n", *of_limits(reports),
        "\n## Each estimate over the truth\n",
        "Columns are the scenes by their numbers; **bold** is above the truth.\n", *of_estimates(reports),
    ]
    return "\n".join(parts) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--print", action="store_true", help="do not write the page")
    arguments = parser.parse_args()
    text = tables(arguments.program)
    if arguments.print:
        print(text, end="")
        return
    page = PAGE.read_text()
    PAGE.write_text(page[:page.index(BEGIN) + len(BEGIN)] + "\n" + text + "\n" + page[page.index(END):])


if __name__ == "__main__":
    main()
