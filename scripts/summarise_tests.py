#!/usr/bin/env python3
"""Summarises ctest's JUnit files, one per stage. The last line is "N passed, M failed[, K skipped]".

Usage: summarise_tests.py STAGE...   Reads STAGE.xml for each stage. A stage with no readable file or no tests counts as
one failure. Exits with 1 if anything failed.
"""
import os
import sys
import xml.etree.ElementTree as ET

LAST_CHARACTERS = 2000  # of a failed test's output


def read_stage(path):
    """Returns (passed, {failed name: end of its output}, skipped names) of one JUnit file."""
    passed, failed, skipped = 0, {}, []
    for case in ET.parse(path).getroot().iter("testcase"):
        status = case.get("status")
        if case.find("skipped") is not None or status == "disabled":
            skipped.append(case.get("name"))
        elif case.find("failure") is not None or status != "run":
            failed[case.get("name")] = (case.findtext("system-out") or "")[-LAST_CHARACTERS:]
        else:
            passed += 1
    return passed, failed, skipped


def main(stages):
    passed, failed, skipped = 0, 0, 0
    for stage in stages:
        name = os.path.basename(stage)
        try:
            stage_passed, stage_failed, stage_skipped = read_stage(stage + ".xml")
        except (OSError, ET.ParseError):
            stage_passed, stage_failed, stage_skipped = 0, {"the stage did not build or run": ""}, []
        if not (stage_passed or stage_failed or stage_skipped):
            stage_failed = {"the stage ran no test": ""}
        print(f"{name}: {stage_passed} passed, {len(stage_failed)} failed, {len(stage_skipped)} skipped")
        for test, output in stage_failed.items():
            print(output)
            print(f"  failed: {test}")
        for test in stage_skipped:
            print(f"  skipped: {test}")
        passed += stage_passed
        failed += len(stage_failed)
        skipped += len(stage_skipped)
    print(f"{passed} passed, {failed} failed" + (f", {skipped} skipped" if skipped else ""))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
