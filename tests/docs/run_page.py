"""Runs the commands of a page of the documentation, as printed and in order, in an empty folder.

Usage: run_page.py PAGE.md TESSERA. Commands are the indented lines that begin with "tessera ". Fails at the first that does not
exit with 0, or if a file that it was told to write is not there.
"""
import os
import shlex
import subprocess
import sys
import tempfile

WRITTEN_AFTER = ("--out", "--picture", "--mesh", "--trajectory", "--scan")


def commands_of(page):
    with open(page, encoding="utf-8") as lines:
        return [line.strip() for line in lines if line.startswith("    tessera ")]


def main():
    page, tessera = sys.argv[1:]
    commands = commands_of(page)
    if not commands:
        sys.exit(f"{page}: has no command")
    environment = dict(os.environ, PATH=os.path.dirname(os.path.abspath(tessera)) + os.pathsep + os.environ["PATH"])
    with tempfile.TemporaryDirectory() as folder:
        for command in commands:
            words = shlex.split(command)
            done = subprocess.run(words, cwd=folder, env=environment, capture_output=True, text=True)
            if done.returncode != 0:
                sys.exit(f"{page}: `{command}` exits with {done.returncode}:\n{done.stdout}{done.stderr}")
            for option, value in zip(words, words[1:]):
                if option in WRITTEN_AFTER and words[1] != "eval" and not os.path.exists(os.path.join(folder, value)):
                    sys.exit(f"{page}: `{command}` wrote no {value}")
            print(f"ok  {command}", flush=True)


main()
