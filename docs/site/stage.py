#!/usr/bin/env python3
"""Lays out the sources of the site for Sphinx: stage.py PROGRAM FOLDER.

Documents stay readable where they are, on a code host; here their links are changed for those of the site. Pages that
say what the program says are written from it: its commands, the keys of a scene, the tutorials. A source file that a
document links to becomes a page.
"""
from __future__ import annotations

import os
import pathlib
import re
import shutil
import subprocess
import sys

import program_help

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCRIPTS = ["few_balls", "timesteps", "heap", "triaxial", "jamming", "moduli", "bonded_beam"]
LANGUAGES = {".hpp": "cpp", ".cpp": "cpp", ".py": "python", ".yaml": "yaml", ".sh": "sh", ".txt": "none"}


class Stage:
    def __init__(self, folder: pathlib.Path) -> None:
        self.folder = folder
        self.written: set[pathlib.Path] = set()
        #: place in the repository -> page of the site
        self.pages = {path.relative_to(ROOT): path.stem for path in sorted((ROOT / "docs").glob("*.md"))}
        self.pages |= {path.relative_to(ROOT): path.stem for path in sorted((ROOT / "docs/site").glob("*.md"))}
        self.pages |= {pathlib.Path(f"examples/scripts/{name}.py"): f"tutorials/{name}" for name in SCRIPTS}
        self.pages |= {pathlib.Path("CONTRIBUTING.md"): "contributing", pathlib.Path("CHANGELOG.md"): "changelog",
                       pathlib.Path("README.md"): "index", pathlib.Path("docs/report"): "reports"}
        self.files: set[pathlib.Path] = set()

    def write(self, name: str, text: str) -> None:
        """Only where something changed: Sphinx reads again what is newer."""
        path = self.folder / name
        self.written.add(path)
        path.parent.mkdir(parents=True, exist_ok=True)
        if not path.exists() or path.read_text() != text:
            path.write_text(text)

    def copy(self, source: pathlib.Path, name: str) -> None:
        path = self.folder / name
        self.written.add(path)
        path.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(source, path)

    def document(self, source: pathlib.Path) -> None:
        self.write(f"{self.pages[source]}.md", self.with_links(source, (ROOT / source).read_text()))

    def with_links(self, source: pathlib.Path, text: str) -> str:
        """The links of a document, from where it is in the repository, as links of the page that it becomes."""
        page = pathlib.Path(self.pages[source])

        def changed(link: re.Match[str]) -> str:
            target, mark, anchor = link[1].partition("#")
            if not target or re.match(r"[a-z]+:", target):
                return link[0]
            place = pathlib.Path(os.path.normpath(source.parent / target))
            if not (ROOT / place).exists():
                raise SystemExit(f"{source}: a link to {target}, which is not there")
            if place in self.pages:
                to = f"{self.pages[place]}.md"
            elif place.suffix == ".png":
                to = str(place.relative_to("docs"))
            else:
                self.files.add(place)
                to = f"files/{place}.md"
            return f"]({os.path.relpath(to, page.parent)}{mark}{anchor})"

        parts = re.split(r"(^```.*?^```$|`[^`\n]+`)", text, flags=re.S | re.M)
        # A link may have code as its text, `[` and `](` then stand in two parts.
        return "".join(part if k % 2 else re.sub(r"\]\(([^()\s]+)\)", changed, part) for k, part in enumerate(parts))

    def file_pages(self) -> None:
        for place in sorted(self.files):
            language = LANGUAGES.get(place.suffix, "none")
            fence = "`" * 5
            self.write(f"files/{place}.md", f"---\norphan: true\n---\n\n# {place.name}\n\n`{place}`\n\n"
                                            f"{fence}{language}\n{(ROOT / place).read_text().rstrip()}\n{fence}\n")

    def clean(self) -> None:
        for path in self.folder.rglob("*"):
            if path.is_file() and path not in self.written:
                path.unlink()


def commands(program: str) -> str:
    """The verbs of the program, from its help."""
    whole = program_help.read(program)
    lines = ["# Commands", "", "From `--help` of each, as the program was when this page was built. What they are for: "
             "[user guide](user-guide.md).", ""]
    lines += ["| | |", "| --- | --- |"]
    lines += [f"| [`{' '.join(verb.words)}`](#eigengrain-{'-'.join(verb.words)}) | {cell(verb.says)} |"
              for verb in whole.all()[1:]]
    for verb in whole.all():
        lines += ["", f"## eigengrain {' '.join(verb.words)}".rstrip(), "", f"{verb.says[:1].upper()}{verb.says[1:].rstrip('.')}.", "",
                  "```none", verb.usage, "```", ""]
        for rows in (verb.positionals, verb.options):
            for written, meaning in rows:
                name, _, value = written.partition(" ")
                value = re.sub(r"(Needs|Excludes): (\S+)", lambda m: f"— {m[1].lower()} `{m[2]}`", value)
                lines += [f"`{name}` {escaped(value.replace(' REQUIRED', ''))}", f": {escaped(meaning) or 'see below'}", ""]
    return "\n".join(lines)


def cell(text: str) -> str:
    return escaped(text).replace("|", "\\|")


def escaped(text: str) -> str:
    """Plain text as Markdown; code stays code."""
    return "".join(part if k % 2 else re.sub(r"([<>*\[\]|])", r"\\\1", part)
                   for k, part in enumerate(re.split(r"(`[^`]*`)", text)))


def schema(program: str) -> str:
    """The keys of a scene: the program's own table, a section for each first word, a key an entry."""
    text = subprocess.run([program, "schema"], check=True, capture_output=True, text=True).stdout
    head, table, rest = re.split(r"^## Keys\n\n\|.*\n\| ---.*\n((?:\|.*\n)+)", text, maxsplit=1, flags=re.M)
    head = head.replace("Generated from the tables in `src/io/scene_keys_*.cpp` that the reader itself uses; a test keeps "
                        "the two equal.", "From `eigengrain schema`, as the program was when this page was built.")
    lines, section = [head.rstrip(), ""], ""
    for row in table.splitlines():
        key, value, default, example, meaning = (part.strip() for part in split_row(row))
        first = re.split(r"[.\[]", key.strip("`"))[0]
        if first != section:
            section = first
            lines += [f"## {section}", ""]
        facts = [value] + {"": [], "required": ["**required**"]}.get(default, [f"default {default}"])
        lines += [key, f": {'; '.join(facts)}. Example: {example}" if example else f": {'; '.join(facts)}",
                  f": {meaning[:1].upper()}{meaning[1:]}", ""]
    return "\n".join(lines) + rest


def split_row(row: str) -> list[str]:
    """Cells of a row of a Markdown table."""
    return [part.replace("\\|", "|") for part in re.split(r"(?<!\\)\|", row.strip())[1:-1]]


def tutorial(name: str) -> str:
    """A script as text: what it says of itself, its comments between its parts, its code, its pictures."""
    source = (ROOT / f"examples/scripts/{name}.py").read_text()
    _, said, code = source.split('"""', 2)
    title, _, text = said.partition("\n")
    lines = [f"# {title.rstrip('.')}", "", text.strip("\n"), "", f"The script: `examples/scripts/{name}.py`.", ""]
    shown: set[str] = set()
    for comment, part in parts_of(code):
        if comment:
            lines += [comment, ""]
        lines += ["```python", part, "```", ""]
        for picture in re.findall(r'"(\w+\.png)"', part):
            if (ROOT / "docs/pictures" / picture).exists() and picture not in shown:
                shown.add(picture)
                lines += [f"![{picture}](../pictures/{picture})", ""]
    return "\n".join(lines)


def parts_of(code: str) -> list[tuple[str, str]]:
    """(comment, code) from one comment at the margin, behind an empty line, to the next."""
    parts, comment, lines = [], [], []

    def close() -> None:
        text = "\n".join(lines).strip("\n")
        if text:
            parts.append((" ".join(comment), text))

    before = ""
    for line in code.splitlines():
        if line.startswith("# ") and (not before or comment and not lines):
            if lines:
                close()
                comment, lines = [], []
            comment.append(line[2:])
        else:
            lines.append(line)
        before = line
    close()
    return parts


def gallery(stage: Stage) -> str:
    """Pages in three dimensions, where the package can write them."""
    import eigengrain

    folder = stage.folder / "extra/pages"
    folder.mkdir(parents=True, exist_ok=True)
    bed = eigengrain.load(ROOT / "examples/scenes/packing_10k.yaml")
    packing = eigengrain.load(ROOT / "examples/scenes/dense_packing.yaml")
    drum = eigengrain.load(ROOT / "examples/scenes/drum.yaml")
    drum.run(time=0.2)
    system = packing.system()
    shown = [("modes", "The slowest modes of a dense packing", lambda path: eigengrain.page(system, path, mode=system.lowest_modes(6))),
             ("drum", "A drum that turns, balls by speed", lambda path: eigengrain.page(drum, path, colour="speed")),
             ("bed", "10,000 settled balls and their contact forces", lambda path: eigengrain.page(bed, path))]
    lines = []
    for name, title, write in shown:
        path = folder / f"{name}.html"
        try:
            write(path)
        except RuntimeError as missing:  # three.js
            return f"None here: {missing}."
        stage.written.add(path)
        lines += [f"## {title}", "", f'<iframe src="pages/{name}.html" title="{title}" loading="lazy"></iframe>', "",
                  f'<a href="pages/{name}.html">By itself</a>', ""]
    return "\n".join(lines)


def main() -> None:
    program, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    stage = Stage(folder)
    for source in stage.pages:
        if source.suffix == ".md" and source.name not in ("README.md", "gallery.md", "scene-schema.md"):
            stage.document(source)
    text = (ROOT / "docs/site/gallery.md").read_text()
    stage.write("gallery.md", stage.with_links(pathlib.Path("docs/site/gallery.md"), text).replace("{{PAGES}}", gallery(stage)))
    stage.write("scene-schema.md", stage.with_links(pathlib.Path("docs/scene-schema.md"), schema(program)))
    stage.write("commands.md", commands(program))
    for name in SCRIPTS:
        stage.write(f"tutorials/{name}.md", tutorial(name))
    stage.file_pages()
    for picture in (ROOT / "docs/pictures").iterdir():
        stage.copy(picture, f"pictures/{picture.name}")
    for report in (ROOT / "docs/report").iterdir():  # as they are
        stage.copy(report, f"extra/report/{report.name}")
    stage.clean()


if __name__ == "__main__":
    main()
