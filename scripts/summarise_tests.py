#!/usr/bin/env python3
"""Adds up the results of test stages; the last line is "N passed, M failed[, K skipped]".

Usage: summarise_tests.py FOLDER...   one folder a stage, with ctest.xml (ctest's JUnit file) and the XML file of each
GoogleTest program, named as its ctest entry. A stage without a readable ctest.xml, or without a single test, counts as
one failure, and so does a program that failed without saying in which test (it crashed, or a sanitizer spoke at its
end). Exits with 1 if anything failed.
"""
import pathlib
import sys
import xml.etree.ElementTree as ET

LAST_CHARACTERS = 4000  # of a failed test's output


class Results:
    def __init__(self):
        self.passed, self.failed, self.skipped = 0, {}, []  # failed: name to the end of its output

    @property
    def empty(self):
        return not (self.passed or self.failed or self.skipped)


def read_program(path, results):
    """Adds the tests of a GoogleTest program. False: its file is missing or cannot be read."""
    try:
        suites = ET.parse(path).getroot()
    except (OSError, ET.ParseError):
        return False
    for case in suites.iter("testcase"):
        name = f"{case.get('classname')}.{case.get('name')}"
        failures = [failure.get("message", "") for failure in case.iter("failure")]
        if failures:
            results.failed[name] = "\n".join(failures)[-LAST_CHARACTERS:]
        elif case.get("status") == "notrun" or case.find("skipped") is not None:
            results.skipped.append(name)
        else:
            results.passed += 1
    return True


def read_stage(folder):
    """The results of one stage."""
    results = Results()
    for case in ET.parse(folder / "ctest.xml").getroot().iter("testcase"):
        name, status = case.get("name"), case.get("status")
        output = (case.findtext("system-out") or "")[-LAST_CHARACTERS:]
        before = len(results.failed)
        counted = read_program(folder / f"{name}.xml", results)
        if case.find("skipped") is not None or status == "disabled":
            results.skipped.append(name)
        elif case.find("failure") is not None or status != "run":
            if len(results.failed) == before:
                results.failed[name] = output
        elif not counted:
            results.passed += 1
    return results


def main(folders):
    total = Results()
    for folder in map(pathlib.Path, folders):
        try:
            results = read_stage(folder)
        except (OSError, ET.ParseError):
            results = Results()
            results.failed["the stage did not build or run"] = ""
        if results.empty:
            results.failed["the stage ran no test"] = ""
        print(f"{folder}: {results.passed} passed, {len(results.failed)} failed, {len(results.skipped)} skipped")
        for test, output in results.failed.items():
            print(output)
            print(f"  failed: {test}")
        for test in results.skipped:
            print(f"  skipped: {test}")
        total.passed += results.passed
        total.failed.update({f"{folder}: {name}": "" for name in results.failed})
        total.skipped += results.skipped
    skipped = f", {len(total.skipped)} skipped" if total.skipped else ""
    print(f"{total.passed} passed, {len(total.failed)} failed{skipped}")
    return 1 if total.failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
