"""Tests of scripts/placements without a run of tessera: a model's grid, depths in it, and where a motion is placed."""
import importlib.machinery
import importlib.util
import math
import pathlib
import sys
import tempfile
import unittest

try:
    import numpy as np
except ModuleNotFoundError:
    print("skipped: needs numpy (apt-get install python3-numpy)")
    sys.exit(77)

FILE = pathlib.Path(__file__).resolve().parents[2] / "scripts/placements"
sys.dont_write_bytecode = True
loader = importlib.machinery.SourceFileLoader("placements", str(FILE))
placements = importlib.util.module_from_spec(importlib.util.spec_from_loader("placements", loader))
loader.exec_module(placements)

# A room of 6 x 4 x 3 metres, its faces as rectangles.
ROOM = "".join(f"v {x} {y} {z}\n" for x in (0, 6) for y in (0, 4) for z in (0, 3)) + (
    "f 1 2 4 3\nf 5 6 8 7\nf 1/1 2/1 6/1 5/1\nf 3 4 8 7\nf 1 3 7 5\nf -7 -5 -1 -3\n")


class Placements(unittest.TestCase):
    def setUp(self):
        self.random = np.random.default_rng(1)
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "room.obj"
            path.write_text(ROOM)
            self.room = placements.Occupancy(path, self.random)

    def test_depths_end_at_the_walls(self):
        rays = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, 0, -1], [0.5, 0, 1]], float)
        depths = self.room.depths(np.array([2.0, 1.0, 1.5]), rays)
        self.assertTrue(np.abs(depths - [4, 2, 3, 1.5, 1.5]).max() < 0.1, depths)

    def test_the_camera_keeps_its_distance(self):
        self.assertTrue(self.room.clear(np.array([[3, 2, 1.5]])))
        for near in ([0.2, 2, 1.5], [3, 3.8, 1.5], [3, 2, 2.8], [9, 2, 1.5]):
            self.assertFalse(self.room.clear(np.array([[3, 2, 1.5], near])), near)

    def test_a_motion_is_moved_and_turned_as_a_whole(self):
        stamps = np.arange(0, 30, 0.02)
        q = np.array([0.1, 0.7, -0.1, 0.7]) / np.linalg.norm([0.1, 0.7, -0.1, 0.7])  # looks ahead and a little down
        motion = np.column_stack([stamps, 0.3 * np.sin(stamps), 0.2 * np.cos(stamps), 0.1 * np.sin(2 * stamps),
                                  np.tile(q, (len(stamps), 1))])
        placed = next(p for p in (placements.place([motion], self.room, self.random) for _ in range(3000))
                      if p is not None)
        self.assertTrue(self.room.clear(placed[:, 1:4]))
        first = next(i for i in range(len(motion)) if abs(
            np.linalg.norm(motion[i + 400, 1:4] - motion[i, 1:4]) -
            np.linalg.norm(placed[400, 1:4] - placed[0, 1:4])) < 1e-9)
        step = motion[first + 90, 1:4] - motion[first, 1:4]
        turn = placements.rotation(placed[0, 4:8]) @ placements.rotation(motion[first, 4:8]).T
        self.assertTrue(np.abs(turn @ step - (placed[90, 1:4] - placed[0, 1:4])).max() < 1e-9)
        self.assertAlmostEqual(turn[2, 2], 1)
        self.assertTrue(math.isclose(np.linalg.det(turn), 1))

    def test_a_model_without_faces_is_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "empty.obj"
            path.write_text("v 0 0 0\n")
            with self.assertRaisesRegex(ValueError, "no faces"):
                placements.Occupancy(path, self.random)


if __name__ == "__main__":
    unittest.main()
