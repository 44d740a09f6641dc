#!/usr/bin/env python3
"""Checks who includes whom, against the rules of docs/architecture.md.

    check_includes.py            the tree that this script stands in; prints each violation as file:line
    check_includes.py TREE       another tree
    check_includes.py --self-test

Exits 0 only if there is no violation.
"""
import re
import sys
import tempfile
from pathlib import Path

# ---- the rules -------------------------------------------------------------------------------------------

# Each folder may use the folders of the rows above its own; folders of one row do not know each other.
LAYERS = [
    ["base"],
    ["model", "report"],
    ["contact", "fem", "search"],
    ["assembly"],
    ["measures", "generate"],
    ["io"],
    ["cycle", "petsc"],
    ["timestep", "relaxation"],
    ["spectrum"],
    ["app", "python"],
]

# Where a folder may live; its headers are written "eigengrain/<folder>/..." if they are public.
ROOTS = ["include/eigengrain", "src", "solvers"]
# python/ stands on top of everything: only its use of PETSc is looked at.

# The headers of PETSc and SLEPc, and the only places that may include them. Public headers may not: who uses
# the library should not need PETSc's headers.
PETSC_HEADER = re.compile(r"(petsc|slepc)[^/]*\.h|(petsc|slepc)/.*\.h")
PETSC_ALLOWED = ["solvers/petsc", "solvers/timestep", "solvers/relaxation", "solvers/spectrum", "tests"]

# ---- the check -------------------------------------------------------------------------------------------

SOURCES = {".cpp", ".hpp", ".c", ".h", ".cc", ".hh", ".inl"}
INCLUDE = re.compile(r'\s*#\s*include\s*(["<])([^">]+)[">]')
ROW = {folder: row for row, folders in enumerate(LAYERS) for folder in folders}


def under(path, folder):
    return path.parts[: len(Path(folder).parts)] == Path(folder).parts


def folder_of(path):
    """The folder that a file of the tree counts to, None outside of ROOTS; "" for a file of no folder."""
    for root in ROOTS:
        if under(path, root):
            inside = path.parts[len(Path(root).parts):]
            return inside[0] if len(inside) > 1 else ""
    return None


def target_folder(tree, path, name, quoted):
    """The folder of ours that an include leads to; None if it leads out of the tree."""
    if name.startswith("eigengrain/"):
        return folder_of(Path("include") / name)
    if not quoted:
        return None
    beside = (tree / path).parent / name
    if beside.exists():
        return folder_of(beside.resolve().relative_to(tree))
    return name.split("/")[0] if "/" in name else folder_of(path)


def complaints(tree, path, name, quoted):
    """What is wrong with one include."""
    if PETSC_HEADER.fullmatch(name) and not any(under(path, place) for place in PETSC_ALLOWED):
        yield f"{name}: PETSc and SLEPc stay in {', '.join(PETSC_ALLOWED[:-1])}"
    mine = folder_of(path)
    if mine is None or mine not in ROW:
        return
    if quoted and under(path, "include") and not name.startswith("eigengrain/"):
        yield f"{name}: a public header includes only public headers, as eigengrain/..."
        return
    other = target_folder(tree, path, name, quoted)
    if other is None or other == mine:
        return
    if other not in ROW:
        yield f"{name}: {other} is no folder that this script knows (LAYERS)"
    elif ROW[other] >= ROW[mine]:
        allowed = ", ".join(folder for row in LAYERS[: ROW[mine]] for folder in row)
        yield f"{name}: {mine} may use only {allowed or 'nothing'}"


def violations(tree):
    tree = Path(tree).resolve()
    for top in ["include", "src", "solvers", "python", "tests", "examples"]:
        for file in sorted((tree / top).rglob("*")):
            if file.suffix not in SOURCES:
                continue
            path = file.relative_to(tree)
            mine = folder_of(path)
            if mine is not None and mine not in ROW:
                yield f"{path}:1: {mine or 'this place'} is no folder that this script knows (LAYERS)"
            for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
                include = INCLUDE.match(line)
                if include:
                    for what in complaints(tree, path, include[2], include[1] == '"'):
                        yield f"{path}:{number}: {what}"


# ---- the check of the check ------------------------------------------------------------------------------

GOOD = {
    "include/eigengrain/base/vec.hpp": "#include <Eigen/Core>\n",
    "include/eigengrain/model/bodies.hpp": '#include "eigengrain/base/vec.hpp"\n',
    "src/search/grid.hpp": "#include <vector>\n",
    "src/search/grid.cpp": '#include "grid.hpp"\n#include "eigengrain/model/bodies.hpp"\n',
    "solvers/petsc/handles.hpp": "#include <slepceps.h>\n",
    "solvers/timestep/truth.cpp": '#include "petsc/handles.hpp"\n#include "eigengrain/cycle/bounds.hpp"\n',
    "src/app/main.cpp": '#include "eigengrain/timestep/truth.hpp"\n#include "verbs.hpp"\n',
    "tests/unit/matrix_test.cpp": '#include <petscmat.h>\n#include "eigengrain/io/reader.hpp"\n',
}

# file: (text, line of the violation)
BAD = {
    "include/eigengrain/base/up.hpp": ('#include <span>\n#include "eigengrain/model/bodies.hpp"\n', 2),
    "include/eigengrain/petsc/open.hpp": ("#include <petscmat.h>\n", 1),
    "include/eigengrain/model/private.hpp": ('#include "secret.hpp"\n', 1),
    "include/eigengrain/nowhere/new.hpp": ("\n", 1),
    "src/contact/sibling.cpp": ('// first\n\n  #  include "eigengrain/search/grid.hpp"\n', 3),
    "src/contact/angle.cpp": ("#include <eigengrain/assembly/model.hpp>\n", 1),
    "src/model/sideways.cpp": ('#include "../search/grid.hpp"\n', 1),
    "src/io/petsc.cpp": ("#include <petscsys.h>\n", 1),
    "src/assembly/upward.cpp": ('#include "petsc/handles.hpp"\n', 1),
    "solvers/cycle/slepc.cpp": ('#include "slepc/private/epsimpl.h"\n#include <slepceps.h>\n', 2),
    "solvers/relaxation/sibling.cpp": ('#include "eigengrain/timestep/truth.hpp"\n', 1),
    "examples/demo.cpp": ("#include <petsc.h>\n", 1),
}


def self_test():
    def tree_with(files, folder):
        for name, text in files.items():
            file = Path(folder) / name
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text, encoding="utf-8")
        return list(violations(folder))

    failures = []
    with tempfile.TemporaryDirectory() as folder:
        failures += [f"should be allowed: {line}" for line in tree_with(GOOD, folder)]
    with tempfile.TemporaryDirectory() as folder:
        found = tree_with(GOOD | {name: text for name, (text, _) in BAD.items()}, folder)
        for name, (_, line) in BAD.items():
            if not any(violation.startswith(f"{name}:{line}: ") for violation in found):
                failures.append(f"not found: {name}:{line}")
        failures += [f"one too many: {v}" for v in found if v.split(":")[0] not in BAD]
    print("\n".join(failures) or f"all {len(BAD)} kinds of violation are found")
    return not failures


def main(arguments):
    if arguments == ["--self-test"]:
        return 0 if self_test() else 1
    tree = Path(arguments[0]) if arguments else Path(__file__).resolve().parents[2]
    if not (tree / "include").is_dir():
        print(f"{tree} has no folder include", file=sys.stderr)
        return 2
    found = list(violations(tree))
    for line in found:
        print(line)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
