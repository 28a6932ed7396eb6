"""Runs the commands of a page of the documentation, as printed and in order, in an empty folder.

Usage: run_page.py PAGE.md TESSERA [--with NAME=VALUE]... [--first COMMAND]... [--skip REGEX]

Commands are the indented lines that begin with "tessera ". The page's placeholders (SOURCE, ...) take the values of --with;
--first makes what the page takes for granted; --skip names what needs a camera, a network or a window. Fails at the first
command that does not exit with 0, if a file that it was told to write is not there, or if --skip skips nothing.
"""
import argparse
import os
import re
import shlex
import subprocess
import sys
import tempfile

WRITTEN_AFTER = ("--out", "--picture", "--mesh", "--cloud", "--grid", "--trajectory", "--kitti", "--frames", "--colmap", "--scan")


def parse():
    parser = argparse.ArgumentParser()
    parser.add_argument("page")
    parser.add_argument("tessera")
    parser.add_argument("--with", dest="values", metavar="NAME=VALUE", action="append", default=[])
    parser.add_argument("--first", metavar="COMMAND", action="append", default=[])
    parser.add_argument("--skip", metavar="REGEX")
    return parser.parse_args()


def commands_of(page, options):
    """The page's commands, placeholders filled in; those to skip left out."""
    with open(page, encoding="utf-8") as lines:
        printed = [line.strip() for line in lines if line.startswith("    tessera ")]
    kept = [line for line in printed if not (options.skip and re.search(options.skip, line))]
    if not kept or (options.skip and len(kept) == len(printed)):
        sys.exit(f"{page}: {len(printed)} commands, {len(printed) - len(kept)} skipped")
    for setting in options.values:
        name, value = setting.split("=", 1)
        kept = [re.sub(rf"\b{name}\b", lambda _, value=value: value, line) for line in kept]
    return kept


def written(words):
    """What a command's options say that it writes. `--frames 20` is a number of frames."""
    return [value for option, value in zip(words, words[1:])
            if option in WRITTEN_AFTER and words[1] != "eval" and not value.isdigit()]


def main():
    options = parse()
    environment = dict(os.environ)
    environment["PATH"] = os.path.dirname(os.path.abspath(options.tessera)) + os.pathsep + environment["PATH"]
    with tempfile.TemporaryDirectory() as folder:
        for command in options.first + commands_of(options.page, options):
            words = shlex.split(command, comments=True)
            done = subprocess.run(words, cwd=folder, env=environment, capture_output=True, text=True)
            if done.returncode != 0:
                sys.exit(f"{options.page}: `{command}` exits with {done.returncode}:\n{done.stdout}{done.stderr}")
            for path in written(words):
                if not os.path.exists(os.path.join(folder, path)):
                    sys.exit(f"{options.page}: `{command}` wrote no {path}")
            print(f"ok  {command}", flush=True)


main()
