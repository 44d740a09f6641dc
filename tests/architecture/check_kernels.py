#!/usr/bin/env python3
"""Kernels are compiled for one instruction set each, into a program that also runs without it. A function that the
linker shares among objects (weak: inline functions and templates that were not inlined) could come from a kernel and
be called from anywhere, so kernels must not have any.

    check_kernels.py NM OBJECT...
"""
import subprocess
import sys


def shared_symbols(nm, path):
    listing = subprocess.run([nm, "-C", "--defined-only", path], check=True, capture_output=True, text=True).stdout
    lines = [line.split(maxsplit=2) for line in listing.splitlines()]
    return [name for _, kind, name in lines if kind in "WwVvu"]


def main():
    nm, objects = sys.argv[1], sys.argv[2:]
    if not objects:
        sys.exit("no kernel was given")
    shared = {path: shared_symbols(nm, path) for path in objects}
    for path, names in shared.items():
        for name in names:
            print(f"{path}: {name} is not inlined, so the linker may use it elsewhere; make it a part of the kernel")
    sys.exit(any(shared.values()))


main()
