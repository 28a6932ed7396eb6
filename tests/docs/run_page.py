"""Runs the commands of a documentation page, as printed and in order, in a folder that acts as a fresh clone.

Usage: run_page.py PAGE.md TESSERA [--with TEXT=VALUE]... [--first COMMAND]... [--skip REGEX]

Commands are the indented lines that match COMMAND below, and the Python blocks. A line that ends in "\\" continues on
the next line. --with gives the values of the page's placeholders (SOURCE, ...). --first runs commands that the page
assumes were run before. --skip matches commands that need a camera, a network or a window. Fails at the first command
that does not exit with 0, if an output file of a command is missing, or if --skip matches nothing.
"""
import argparse
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

COMMAND = re.compile(r"    (?=(?:tessera|export|\./run|ninja|snakemake|[A-Z_]+=\S+|(?:build/|scripts/|bench/|/usr/bin/)\S+)(?: |$))")
WRITTEN_AFTER = ("--out", "--picture", "--mesh", "--cloud", "--grid", "--trajectory", "--kitti", "--frames", "--colmap", "--scan",
                 "--record")
CLONE = pathlib.Path(__file__).resolve().parents[2]


def parse():
    parser = argparse.ArgumentParser()
    parser.add_argument("page")
    parser.add_argument("tessera")
    parser.add_argument("--with", dest="values", metavar="TEXT=VALUE", action="append", default=[])
    parser.add_argument("--first", metavar="COMMAND", action="append", default=[])
    parser.add_argument("--skip", metavar="REGEX")
    return parser.parse_args()


def printed(page):
    """The commands and Python blocks of the page, in order. A block starts with its ```python line."""
    text = re.sub(r" *\\\n +", " ", pathlib.Path(page).read_text(encoding="utf-8"))
    lines = iter(text.splitlines())
    for line in lines:
        if line == "```python":
            block = [line]
            while (line := next(lines)) != "```":
                block.append(line)
            yield "\n".join(block)
        elif COMMAND.match(line):
            yield line.strip()


def commands_of(page, options):
    """The commands to run, with placeholders filled in."""
    found = list(printed(page))
    kept = [line for line in found if not (options.skip and re.search(options.skip, line))]
    if not kept or (options.skip and len(kept) == len(found)):
        sys.exit(f"{page}: {len(found)} commands, {len(found) - len(kept)} skipped")
    for setting in options.values:
        name, value = setting.split("=", 1)
        kept = [re.sub(rf"\b{re.escape(name)}\b", lambda _, value=value: value, line) for line in kept]
    return kept


def written(words):
    """The paths that a command writes according to its options. `--frames 20` is a number of frames, not a path."""
    return [value for option, value in zip(words, words[1:])
            if option in WRITTEN_AFTER and "eval" not in words and not value.isdigit()]


def lay_out(folder, tessera):
    """Links the parts of the clone into the folder. `build/release` is the build that contains TESSERA."""
    for part in CLONE.iterdir():
        if part.name in ("bench", "config", "python", "scripts"):
            (folder / part.name).symlink_to(part)
    (folder / "build").mkdir()
    (folder / "build/release").symlink_to(tessera.parents[1])


def main():
    options = parse()
    tessera = pathlib.Path(options.tessera).resolve()
    environment = {**os.environ, "PATH": f"{tessera.parent}{os.pathsep}{os.environ['PATH']}"}
    with tempfile.TemporaryDirectory() as folder:
        lay_out(pathlib.Path(folder), tessera)
        for command in options.first + commands_of(options.page, options):
            if command.startswith("export "):
                name, value = command.removeprefix("export ").split("=", 1)
                environment[name] = value.replace("$PWD", folder)
                continue
            block = command.removeprefix("```python\n")
            words = ["/usr/bin/python3", "-c", block] if block != command else ["bash", "-c", command]
            done = subprocess.run(words, cwd=folder, env=environment, capture_output=True, text=True)
            if done.returncode != 0:
                sys.exit(f"{options.page}: `{command}` exits with {done.returncode}:\n{done.stdout}{done.stderr}")
            for path in written(shlex.split(command, comments=True)) if block == command else []:
                if not os.path.exists(os.path.join(folder, path)):
                    sys.exit(f"{options.page}: `{command}` wrote no {path}")
            print(f"ok  {command}", flush=True)


main()
