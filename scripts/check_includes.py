#!/usr/bin/env python3
"""Checks the include order of docs/design.md, section 1: lower folders never include higher ones, and folders of equal
rank do not include each other.

Usage: check_includes.py [ROOT]   Prints one line per violation; exits with 1 if there is any.
"""
import pathlib
import re
import sys

ORDER = [["core"], ["io", "mapping"], ["synth", "render", "recordings"], ["tracking", "semantics", "eval", "finish"], ["optimize", "report"], ["scan"],
         ["export"], ["plan", "system"], ["run", "viz", "cuda"], ["apps"]]
RANK = {folder: rank for rank, folders in enumerate(ORDER) for folder in folders}
SUFFIXES = {".h", ".cpp", ".cu", ".cuh", ".inl"}
INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]')


def folder_of(path, root):
    """The folder that determines the rank of a file, or None."""
    parts = path.relative_to(root).parts
    if parts[0] in ("apps", "cuda"):
        return parts[0]
    return parts[1] if len(parts) > 2 else None


def offences(root):
    for path in sorted([*(root / "src").rglob("*"), *(root / "apps").rglob("*"), *(root / "cuda").rglob("*")]):
        if path.suffix not in SUFFIXES:
            continue
        here = folder_of(path, root)
        where = path.relative_to(root)
        if here not in RANK:
            yield f"{where}: this folder is not in the include order"
            continue
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
            match = INCLUDE.match(line)
            if not match:
                continue
            there = match.group(1).split("/")[0]
            if match.group(1).startswith("."):
                yield f"{where}:{number}: include paths start at src/, not at '{there}'"
            elif there in RANK and there != here and RANK[there] >= RANK[here]:
                yield f"{where}:{number}: {here} must not include {there} ({match.group(1)})"


def main(arguments):
    root = pathlib.Path(arguments[0] if arguments else ".").resolve()
    found = list(offences(root))
    for line in found:
        print(line)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
