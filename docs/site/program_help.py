"""What `--help` of the program says, in parts."""
from __future__ import annotations

import re
import subprocess
from dataclasses import dataclass, field


@dataclass
class Verb:
    """A verb, e.g. ["compare", "steps"]; [] is the program itself."""

    words: list[str]
    says: str = ""  #: in one line
    usage: str = ""
    positionals: list[tuple[str, str]] = field(default_factory=list)  #: (name and value, meaning)
    options: list[tuple[str, str]] = field(default_factory=list)
    verbs: list[Verb] = field(default_factory=list)

    @property
    def option_names(self) -> set[str]:
        return {name for written, _ in self.options for name in re.findall(r"(?<![\w-])--?\w[\w-]*", written.split(" ")[0])}

    def all(self) -> list[Verb]:
        """This one and those below, in the order of the program."""
        return [self] + [one for verb in self.verbs for one in verb.all()]


def read(program: str, words: tuple[str, ...] = ()) -> Verb:
    """The whole tree of verbs, by asking each for its help."""
    text = subprocess.run([program, *words, "--help"], check=True, capture_output=True, text=True).stdout
    verb = Verb(list(words))
    rows: list[tuple[str, str]] = []
    lists = {"Positionals:": verb.positionals, "Options:": verb.options, "Subcommands:": (below := [])}
    for line in text.splitlines():
        if line in lists:
            rows = lists[line]
        elif line.startswith("Usage: "):
            verb.usage = line.removeprefix("Usage: ")
        elif line.startswith(" " * 30) and rows:  # where a name leaves no room beside it
            name, meaning = rows[-1]
            rows[-1] = name, f"{meaning} {line.strip()}".strip()
        elif line.startswith("  "):
            # The name and what it takes end at two blanks, or at column 30.
            name, _, meaning = line.strip().partition("  ")
            if not meaning and len(line) > 30 and line[29] == " ":
                name, meaning = line[:30].strip(), line[30:]
            rows.append((name, meaning.strip()))
        elif line and not verb.usage:
            verb.says = line
    verb.verbs = [read(program, (*words, name)) for name, _ in below]
    return verb
