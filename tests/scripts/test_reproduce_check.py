"""Tests of what surrounds the tables of scripts/reproduce: which recordings are recognised, what `check` reports, and
that tables of two programs are not listed together.
"""
import contextlib
import io
import json
import pathlib
import subprocess
import sys
import tempfile
import types
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
sys.dont_write_bytecode = True
from reproduction import check, index, papers, sources  # noqa: E402
from reproduction.document import Document  # noqa: E402
from reproduction.sample import CHECK, WHOLE  # noqa: E402


class Folder(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.root = pathlib.Path(self.temporary.name)

    def tearDown(self):
        self.temporary.cleanup()


class Recordings(Folder):
    def recording(self, folder, bag, images=60, gap_s=1 / 30, truth_s=None):
        """A folder in TUM's layout without images. The truth ends with the last image unless `truth_s` is given."""
        path = self.root / folder
        path.mkdir()
        stamps = [10 + gap_s * i for i in range(images)]
        truth_s = truth_s or stamps[-1] - stamps[0]
        (path / "rgb.txt").write_text(f"# color images\n# file: '{bag}.bag'\n" +
                                      "".join(f"{stamp:.6f} rgb/{stamp:.6f}.png\n" for stamp in stamps))
        (path / "depth.txt").write_text("")
        (path / "groundtruth.txt").write_text("# t\n" + "".join(
            f"{10 + truth_s * i / 100:.4f} 0 0 0 0 0 0 1\n" for i in range(101)))
        return path

    def bench(self):
        return types.SimpleNamespace(tum=self.root, only=(), sample=CHECK, folder=lambda name: self.root / "jobs" / name)

    def test_copies_are_recognised_by_the_bag_that_rgb_txt_names(self):
        self.recording("third", "rgbd_dataset_freiburg1_xyz", gap_s=0.1)
        self.recording("begin", "rgbd_dataset_freiburg3_teddy", truth_s=20)
        self.recording("whole", "rgbd_dataset_freiburg1_rpy")
        self.recording("home", "kitchen", gap_s=0.1)
        found = {one.name: one.kind for one in sources.recorded(self.bench())}
        self.assertEqual(found, {"third": "rgbd_dataset_freiburg1_xyz, every 3rd frame",
                                 "begin": "rgbd_dataset_freiburg3_teddy, first 60 frames",
                                 "whole": "rgbd_dataset_freiburg1_rpy", "home": "home"})

    def test_a_paper_row_takes_the_complete_copy(self):
        self.recording("a_third", "rgbd_dataset_freiburg1_xyz", gap_s=0.1)
        self.recording("rgbd_dataset_freiburg1_xyz", "rgbd_dataset_freiburg1_xyz")
        self.recording("z_rpy", "rgbd_dataset_freiburg1_rpy")
        rows = {(name, one.name): figures for name, one, figures in sources.rows(self.bench(), papers.D18_TABLE2)}
        self.assertEqual(rows["fr1 xyz", "rgbd_dataset_freiburg1_xyz"][0], 0.036)
        self.assertIsNone(rows["fr1 xyz", "a_third"])
        self.assertIsNone(rows["fr1 rpy", "z_rpy"])
        self.assertIn(("fr1 desk", "desk_kinect"), rows)  # the stand-in
        self.assertEqual(len(rows), 5)

    def test_samples_for_tests_are_no_rows(self):
        self.recording("ten", "rgbd_dataset_freiburg1_xyz", images=10)
        self.assertEqual(sources.recorded(self.bench()), [])

    def test_bad_list_is_named(self):
        path = self.recording("x", "rgbd_dataset_freiburg1_rpy")
        (path / "rgb.txt").write_text("# color\n\nfirst rgb/1.png\n")
        with self.assertRaisesRegex(ValueError, "rgb.txt:3"):
            sources.recorded(self.bench())


def figure(value, **more):
    return {"table": "t", "row": ["desk", "sdf"], "column": "ATE [m]", "value": value, "tolerance": "metres", **more}


RULES = {"metres": {"relative": 0.1, "least": 0.0002, "why": "w"}}


class Check(Folder):
    def table(self, cell):
        return Document("T", tables=[("", ["scene", "method", "ATE [m]"], [["desk", "sdf", cell], ["desk", "icp", "9"]]),
                                     ("", ["scene", "method", "fused"], [["desk", "sdf", "1"]])])

    def holds(self, cell, value):
        return check.compare(self.table(cell), [figure(value)], RULES)[0].holds()

    def test_tolerance(self):
        self.assertTrue(self.holds("0.0109", 0.01))
        self.assertTrue(self.holds("0.0110", 0.01))
        self.assertTrue(self.holds("0.0005", 0.0003))
        self.assertFalse(self.holds("0.0112", 0.01))
        self.assertFalse(self.holds("0.0088", 0.01))  # better is also a change
        self.assertTrue(self.holds("0.0006 (95 % tracked)", 0.0005))
        self.assertFalse(self.holds("0.0008, 3 of 9 degenerate", 0.0005))

    def test_the_line_has_everything(self):
        line = check.compare(self.table("0.02"), [figure(0.01)], RULES)[0].line()
        self.assertEqual(line, "t, desk, sdf, ATE [m]: expected 0.01, got 0.02, tolerance 0.001 (metres)")

    def test_a_figure_that_the_table_lacks_is_an_error(self):
        for change in ({"row": ["desk"]}, {"row": ["room"]}, {"column": "ATE"}):
            with self.assertRaisesRegex(check.NoSuchFigure, "such cells"):
                check.compare(self.table("0.02"), [figure(0.01, **change)], RULES)
        with self.assertRaisesRegex(check.NoSuchFigure, "no number"):
            check.compare(self.table("–"), [figure(0.01)], RULES)

    def test_missing_data_is_said_and_update_writes(self):
        path = self.root / "expected.json"
        check.write({"tolerances": RULES, "figures": [figure(0.01), figure(0.5, data="nowhere")]}, path)
        expected = check.read(path)
        bench = types.SimpleNamespace(tum=self.root, only=(), version="v")
        results, skipped = check.run(bench, {"t": lambda _: self.table("0.02")}, expected)
        self.assertEqual(skipped, ["skipped: nowhere is not in --tum"])
        self.assertEqual([result.holds() for result in results], [False])
        self.assertEqual(check.update(expected, results, path), ["t, desk, sdf, ATE [m]: 0.01 is now 0.02"])
        self.assertEqual([one["value"] for one in check.read(path)["figures"]], [0.02, 0.5])

    def test_bad_file_is_named(self):
        path = self.root / "expected.json"
        for text in ("{", "{}", json.dumps({"tolerances": {}, "figures": [figure(1)]})):
            path.write_text(text)
            with self.assertRaisesRegex(ValueError, "expected.json"):
                check.read(path)

    def test_every_table_but_times_is_checked(self):
        tables = {one["table"] for one in check.read()["figures"]}
        self.assertEqual(tables, {"b14-table1", "b14-figures", "d18-table1", "d18-table2", "d18-table3", "d18-table4",
                                  "d18-figures", "low-structure", "presets"})


class OneProgram(Folder):
    def make(self, name, program):
        (self.root / name).write_text(Document(name).markdown(program))

    def test_strangers_are_found(self):
        self.make("a.md", "tessera 1, sha256 aa")
        self.make("b.md", "tessera 1, sha256 bb")
        index.write(self.root, {"a": "A", "b": "B", "c": "C"}, "tessera 1, sha256 aa")
        self.assertEqual(index.strangers(self.root), [("b.md", "tessera 1, sha256 bb"), ("c.md", None)])

    def test_all_lists_what_it_made(self):
        reproduce = types.ModuleType("reproduce")
        reproduce.__file__ = str(ROOT / "scripts/reproduce")
        exec(compile((ROOT / "scripts/reproduce").read_text(), "reproduce", "exec"), reproduce.__dict__)
        reproduce.TABLES = {"a": lambda _: Document("Table A"), "b": lambda _: Document("Table B")}
        with contextlib.redirect_stdout(io.StringIO()):
            reproduce.write_all(types.SimpleNamespace(only=(), out=self.root, version="tessera 1, sha256 aa", sample=WHOLE))
        text = (self.root / index.FILE).read_text()
        self.assertIn("by one program: tessera 1, sha256 aa.", text)
        self.assertIn("| [b](b.md) | Table B |\n", text)
        self.assertEqual(index.strangers(self.root), [])

    def test_a_table_is_not_added_to_those_of_another_program(self):
        index.write(self.root, {}, "tessera 0, sha256 00")
        program = self.root / "tessera"  # knows its version and refuses all else
        program.write_text('#!/bin/sh\n[ "$1" = --version ] && echo tessera 1\n')
        program.chmod(0o755)
        done = subprocess.run([sys.executable, ROOT / "scripts/reproduce", "d18-table5", "--tessera", program, "--out",
                               self.root], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 2)
        self.assertRegex(done.stderr, "all.md: lists tables of another program")

    def test_the_published_tables_are_of_one_program(self):
        if not (ROOT / "docs/results" / index.FILE).is_file():
            self.skipTest("docs/results has no all.md: its tables were made one by one")
        self.assertEqual(index.strangers(ROOT / "docs/results"), [])


if __name__ == "__main__":
    unittest.main()
