#!/usr/bin/env python3
"""Checks the style rules of this project. Files over 250 lines give a warning, over 500 an error. Headers under src/
must not include heavy third-party headers, so that rebuilds stay short and the library interfaces independent. Source
files of one folder under src/ or apps/ must not define constants of the same name, because unity builds compile them
together, in batches that differ from build to build. C++ and CUDA must be formatted according to .clang-format. Only
Debian 12's clang-format 14 is used, because other versions differ; if it is missing, the check is skipped with a
warning.

Usage: check_style.py [ROOT]   Prints one line per finding; exits with 1 on any error.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

WARN_LINES = 250
FAIL_LINES = 500
FOLDERS = ["src", "apps", "drivers", "python", "tests", "bench", "cuda", "scripts", "cmake"]
FORMATTED = {".h", ".cpp", ".cu", ".cuh"}
SUFFIXES = FORMATTED | {".py", ".sh", ".cmake"}
FORMATTER_VERSION = 14
HEAVY = re.compile(r'^\s*#\s*include\s*[<"](opencv2|yaml-cpp|nlohmann|spdlog|CLI|embree3)/')


def files_of(root, suffixes):
    for folder in FOLDERS:
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in suffixes and path.is_file():
                yield path


def formatter():
    """Path of clang-format in the required version, or None."""
    for name in (f"clang-format-{FORMATTER_VERSION}", "clang-format"):
        path = shutil.which(name)
        if path is None:
            continue
        version = subprocess.run([path, "--version"], capture_output=True, text=True, check=False).stdout
        if f"version {FORMATTER_VERSION}." in version:
            return path
    return None


def format_findings(root):
    """Yields (is_failure, text) for each file that is not formatted."""
    program = formatter()
    if program is None:
        yield False, f"formatting not checked: install clang-format-{FORMATTER_VERSION}"
        return

    def unformatted(files):
        checked = subprocess.run([program, "--dry-run", "-Werror", *files], capture_output=True, text=True, check=False)
        return {line.split(":", 1)[0] for line in checked.stderr.splitlines() if "-Wclang-format-violations" in line}

    files = [str(path) for path in files_of(root, FORMATTED)]
    parts = os.cpu_count() or 1
    with ThreadPoolExecutor(parts) as pool:
        found = set().union(*pool.map(unformatted, [files[part::parts] for part in range(parts)]))
    for path in sorted(found):
        where = pathlib.Path(path).relative_to(root)
        yield True, f"{where}: not formatted: clang-format-{FORMATTER_VERSION} -i {where}"


def findings(root):
    """Yields (is_failure, text)."""
    for path in files_of(root, SUFFIXES):
        where = path.relative_to(root)
        lines = path.read_text(encoding="utf-8").splitlines()
        if len(lines) > WARN_LINES:
            yield len(lines) > FAIL_LINES, f"{where}: {len(lines)} lines (aim under {WARN_LINES}, at most {FAIL_LINES})"
        if path.suffix == ".h" and where.parts[0] == "src":
            for number, line in enumerate(lines, 1):
                match = HEAVY.match(line)
                if match:
                    yield True, f"{where}:{number}: {match.group(1)} belongs in the .cpp file"


def constants_of(text):
    """Names of the constants (kName) that a source file defines outside of functions and classes."""
    text = re.sub(r"//.*", "", text)
    for definition in re.findall(r"^(?:static )?(?:constexpr|const) [^;]*;", text, re.MULTILINE):
        yield from re.findall(r"\b(k[A-Z]\w*)(?:\[\w*\])*\s*[={]", definition)


def constant_findings(root):
    """Yields (is_failure, text) for each constant that another file of its folder defines, too."""
    first = {}
    for path in files_of(root, {".cpp"}):
        where = path.relative_to(root)
        if where.parts[0] not in ("src", "apps"):
            continue
        for name in constants_of(path.read_text(encoding="utf-8")):
            other = first.setdefault((path.parent, name), where)
            if other != where:
                yield True, f"{where}: {name} is also in {other.name}"


def main(arguments):
    root = pathlib.Path(arguments[0] if arguments else ".").resolve()
    failed = False
    for is_failure, text in [*findings(root), *constant_findings(root), *format_findings(root)]:
        print(("error: " if is_failure else "warning: ") + text)
        failed = failed or is_failure
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
