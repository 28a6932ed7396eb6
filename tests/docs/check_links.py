#!/usr/bin/env python3
"""Checks that every local link and image of the README and the pages under docs/ leads to a file.

Usage: check_links.py PROJECT_ROOT. Prints one line per dead link and exits with 1 if there are any.
"""
import pathlib
import re
import sys

LINK = re.compile(r"\]\(([^)#\s]+)")


def dead_links(root):
    for page in [root / "README.md", *sorted(root.glob("docs/**/*.md"))]:
        for target in LINK.findall(page.read_text()):
            if "://" not in target and not (page.parent / target).exists():
                yield f"{page.relative_to(root)}: {target} does not exist"


if __name__ == "__main__":
    dead = list(dead_links(pathlib.Path(sys.argv[1])))
    print("\n".join(dead) or "every link leads to a file")
    sys.exit(bool(dead))
