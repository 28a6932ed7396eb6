#!/usr/bin/env python3
"""House rules that a machine can hold: files warn over 250 lines and fail over 500; headers under src/ do not include
heavy third-party headers, so that a rebuild stays short and libraries' interfaces stay ours.

Usage: check_style.py [ROOT]   Prints one line per finding; exits with 1 if there is any failure.
"""
import pathlib
import re
import sys

WARN_LINES = 250
FAIL_LINES = 500
FOLDERS = ["src", "apps", "python", "tests", "bench", "cuda", "scripts", "cmake"]
SUFFIXES = {".h", ".cpp", ".cu", ".cuh", ".py", ".sh", ".cmake"}
HEAVY = re.compile(r'^\s*#\s*include\s*[<"](opencv2|yaml-cpp|nlohmann|spdlog|CLI|embree3)/')


def findings(root):
    """Yields (is_failure, text)."""
    files = [path for folder in FOLDERS for path in sorted((root / folder).rglob("*"))]
    for path in files:
        if path.suffix not in SUFFIXES or not path.is_file():
            continue
        where = path.relative_to(root)
        lines = path.read_text(encoding="utf-8").splitlines()
        if len(lines) > WARN_LINES:
            yield len(lines) > FAIL_LINES, f"{where}: {len(lines)} lines (aim under {WARN_LINES}, at most {FAIL_LINES})"
        if path.suffix == ".h" and where.parts[0] == "src":
            for number, line in enumerate(lines, 1):
                match = HEAVY.match(line)
                if match:
                    yield True, f"{where}:{number}: {match.group(1)} belongs into the .cpp file"


def main(arguments):
    root = pathlib.Path(arguments[0] if arguments else ".").resolve()
    failed = False
    for is_failure, text in findings(root):
        print(("error: " if is_failure else "warning: ") + text)
        failed = failed or is_failure
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
