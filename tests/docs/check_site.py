#!/usr/bin/env python3
"""Builds the site of the documentation and looks at what came out.

    check_site.py PROGRAM OUT

Every link between its pages leads to a page, and to a place in it that is there; every command of the documents names a
verb of the program and options that this verb has. PYTHONPATH has the package.
"""
import html
import os
import pathlib
import re
import shlex
import subprocess
import sys
import urllib.parse

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "docs/site"))
import program_help  # noqa: E402


class Page:
    """Links of a page, and the places in it that links can lead to."""

    def __init__(self, path):
        # What scripts write is theirs. By expressions, as a parser takes ten times as long for the pages of doxygen.
        text = re.sub(r"<script\b([^>]*)>.*?</script>", r"<script\1>", path.read_text(encoding="utf-8"), flags=re.S)
        self.links = [html.unescape(link) for link in re.findall(r'<[^>]*?\s(?:href|src)="([^"]*)"', text)]
        self.places = {html.unescape(place) for place in re.findall(r'<[^>]*?\s(?:id|name)="([^"]+)"', text)}


def broken_links(out):
    pages = {path: Page(path) for path in sorted(out.rglob("*.html"))}
    links, broken = 0, []
    for path, page in pages.items():
        for link in page.links:
            parts = urllib.parse.urlsplit(link)
            if parts.scheme or parts.netloc:
                continue
            links += 1
            target = path if not parts.path else (path.parent / urllib.parse.unquote(parts.path)).resolve()
            if target.is_dir():
                target = target / "index.html"
            if not target.exists():
                broken.append(f"{path.relative_to(out)}: {link}: there is no such file")
            # Scripts of doxygen's own make the anchors of its lists of pages.
            elif parts.fragment and target in pages and "cpp" not in target.relative_to(out).parts[:1]:
                if urllib.parse.unquote(parts.fragment) not in pages[target].places:
                    broken.append(f"{path.relative_to(out)}: {link}: there is no such place in that page")
    return links, broken


def commands(text):
    """(line, words) of the commands in blocks of code, fenced as sh or indented, and in code within a line."""
    fence = None
    lines = text.splitlines()
    k = 0
    while k < len(lines):
        line, number = lines[k], k + 1
        k += 1
        if mark := re.match(r"```(\w*)", line):
            fence = None if fence is not None else mark[1]
            continue
        if fence is None and not line.startswith("    "):
            for command in re.findall(r"`(eigengrain [a-z][^`]*)`", line):
                if command != "eigengrain state":  # the name of the format of states
                    yield number, command.split()
            continue
        if fence not in (None, "sh"):
            continue
        while line.endswith("\\") and k < len(lines):
            line, k = line[:-1] + lines[k], k + 1
        if re.match(r"\s*(?:[\w./$-]*/)?eigengrain(?= [a-z-])", line):
            try:
                yield number, shlex.split(line, comments=True)
            except ValueError:  # of several lines, as those of a table are
                continue


def wrong_commands(program):
    whole = program_help.read(program)
    verbs = {tuple(verb.words): verb for verb in whole.all()}
    documents = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").rglob("*.md"))]
    count, wrong = 0, []
    for document in documents:
        for number, words in commands(document.read_text(encoding="utf-8")):
            count += 1
            place = f"{document.relative_to(ROOT)}:{number}"
            verb, rest = whole, words[1:]
            while rest and (*verb.words, rest[0]) in verbs:
                verb, rest = verbs[(*verb.words, rest[0])], rest[1:]
            # `eigengrain compare` alone names the verb as such.
            if verb is whole and not rest[0].startswith("-") or verb.verbs and rest and not rest[0].startswith("-"):
                wrong.append(f"{place}: eigengrain has no verb \"{' '.join(words[1:3])}\"")
                continue
            for word in rest:
                name = word.partition("=")[0]
                if re.match(r"--?[a-z]", name) and name not in verb.option_names:
                    wrong.append(f"{place}: eigengrain {' '.join(verb.words)} has no option {name}")
    return count, wrong


def main():
    program, out = sys.argv[1], pathlib.Path(sys.argv[2]).resolve()
    built = subprocess.run([ROOT / "docs/build_site.sh", out], env=os.environ | {"PROGRAM": program, "INSTALL": "no"})
    links, broken = broken_links(out)
    count, wrong = wrong_commands(program)
    for line in broken + wrong:
        print(line)
    print(f"{links} links, {len(broken)} broken; {count} commands, {len(wrong)} wrong")
    # What finds nothing to look at has not looked.
    return 1 if built.returncode or broken or wrong or links < 1000 or count < 20 else 0


if __name__ == "__main__":
    sys.exit(main())
