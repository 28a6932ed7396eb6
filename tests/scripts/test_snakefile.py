"""Checks that scripts/Snakefile plans one run per sequence and alpha and one table, and that planning writes nothing.
Usage: test_snakefile.py TESSERA
"""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
TESSERA = None


class Snakefile(unittest.TestCase):
    def test_plan(self):
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run(
                ["snakemake", "-n", "-s", ROOT / "scripts/Snakefile", "--cores", "2", "--directory", folder, "--config",
                 f"tessera={TESSERA}", f"out={folder}/out", "preset=default", "only=corner_kinect,floor_kinect"],
                capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 0, done.stderr)
            # Two sequences. Each is rendered once, then run at eleven alphas and at auto.
            self.assertRegex(done.stdout + done.stderr, re.compile(r"^job +26\b", re.MULTILINE))
            self.assertFalse((pathlib.Path(folder) / "out").exists())


if __name__ == "__main__":
    TESSERA = sys.argv.pop(1)
    if not shutil.which("snakemake"):
        print("skipped: needs snakemake")
        sys.exit(77)
    unittest.main()
