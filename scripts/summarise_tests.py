#!/usr/bin/env python3
"""Adds up ctest's JUnit files, one per stage; the last line is "N passed, M failed[, K skipped]".

Usage: summarise_tests.py STAGE...   reads STAGE.xml each. A stage without a readable file, or without a single test,
counts as one failure. Exits with 1 if anything failed.
"""
import os
import sys
import xml.etree.ElementTree as ET


def read_stage(path):
    """Returns (passed, failed names, skipped names) of one JUnit file."""
    passed, failed, skipped = 0, [], []
    for case in ET.parse(path).getroot().iter("testcase"):
        status = case.get("status")
        if case.find("skipped") is not None or status == "disabled":
            skipped.append(case.get("name"))
        elif case.find("failure") is not None or status != "run":
            failed.append(case.get("name"))
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
            stage_passed, stage_failed, stage_skipped = 0, ["the stage did not build or run"], []
        if not (stage_passed or stage_failed or stage_skipped):
            stage_failed = ["the stage ran no test"]
        print(f"{name}: {stage_passed} passed, {len(stage_failed)} failed, {len(stage_skipped)} skipped")
        for what, names in (("failed", stage_failed), ("skipped", stage_skipped)):
            for test in names:
                print(f"  {what}: {test}")
        passed += stage_passed
        failed += len(stage_failed)
        skipped += len(stage_skipped)
    print(f"{passed} passed, {failed} failed" + (f", {skipped} skipped" if skipped else ""))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
