"""Tests of bench/compare that need neither Open3D nor a run of tessera: cameras, pairs, quaternions, bad input."""
import importlib.machinery
import importlib.util
import math
import pathlib
import subprocess
import sys
import tempfile
import unittest

FILE = pathlib.Path(__file__).resolve().parents[2] / "bench/compare"
sys.dont_write_bytecode = True
loader = importlib.machinery.SourceFileLoader("compare", str(FILE))
compare = importlib.util.module_from_spec(importlib.util.spec_from_loader("compare", loader))
loader.exec_module(compare)


class Compare(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.root = pathlib.Path(self.temporary.name)

    def tearDown(self):
        self.temporary.cleanup()

    def test_camera(self):
        (self.root / "camera.yaml").write_text("# a: b\nfx: 500 # px\nfy: 501\ncx: 319.5\ncy: 239.5\nfps: 30\n")
        camera, ideal = compare.read_camera(self.root)
        self.assertEqual((camera["fx"], camera["cy"], camera["width"], camera["depth_scale"]), (500, 239.5, 640, 5000))
        self.assertTrue(ideal)
        with (self.root / "camera.yaml").open("a") as file:
            file.write("distortion: [0, 0.1, 0, 0]  # k1\n")
        self.assertFalse(compare.read_camera(self.root)[1])

    def test_pairs_are_the_nearest_within_20_ms(self):
        (self.root / "rgb.txt").write_text("# c\n1.000 rgb/a.png\n1.030 rgb/b.png\n")
        (self.root / "depth.txt").write_text("1.018 depth/a.png\n1.060 depth/b.png\n0.990 depth/c.png\n")
        self.assertEqual(compare.read_pairs(self.root, None),
                         [(1.018, "depth/a.png", "rgb/b.png"), (0.990, "depth/c.png", "rgb/a.png")])
        self.assertEqual(len(compare.read_pairs(self.root, 1)), 1)

    def test_quaternions(self):
        half = math.sqrt(0.5)
        for T, expected in (([[1, 0, 0], [0, 1, 0], [0, 0, 1]], (0, 0, 0, 1)),
                            ([[0, -1, 0], [1, 0, 0], [0, 0, 1]], (0, 0, half, half)),
                            ([[1, 0, 0], [0, -1, 0], [0, 0, -1]], (1, 0, 0, 0)),
                            ([[0, 1, 0], [1, 0, 0], [0, 0, -1]], (half, half, 0, 0))):
            for found, wanted in zip(compare.quaternion(T), expected):
                self.assertAlmostEqual(found, wanted)

    def test_bad_input_is_one_line(self):
        done = subprocess.run([sys.executable, FILE, self.root], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 2)
        self.assertIn("camera.yaml", done.stderr)
        self.assertEqual(len(done.stderr.splitlines()), 1)


if __name__ == "__main__":
    unittest.main()
