"""Tests of scripts/walker on a recording of nine tiny images of a wall."""
import importlib.machinery
import importlib.util
import pathlib
import sys
import tempfile
import unittest
import unittest.mock

try:
    import numpy as np
    from PIL import Image
except ModuleNotFoundError:
    print("skipped: needs numpy and Pillow (apt-get install python3-numpy python3-pil)")
    sys.exit(77)

FILE = pathlib.Path(__file__).resolve().parents[2] / "scripts/walker"
sys.dont_write_bytecode = True
loader = importlib.machinery.SourceFileLoader("walker", str(FILE))
script = importlib.util.module_from_spec(importlib.util.spec_from_loader("walker", loader))
loader.exec_module(script)

WIDTH, HEIGHT = 65, 49
CAMERA = f"width: {WIDTH}\nheight: {HEIGHT}\nfx: 60\nfy: 60\ncx: 32\ncy: 24\ndepth_scale: 1000\n"
STORED_PER_M = 1000
CHEST_M, TO_THE_ARM_M = 1.17, 0.25 + 0.055   # the height of the chest; from its middle to the outside of an arm


class Walker(unittest.TestCase):
    """The camera stands still at the height of the chest and looks along x. A second has two images."""

    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.source = pathlib.Path(holder.name) / "source"
        self.out = pathlib.Path(holder.name) / "out"

    def walk(self, wall_m, distance):
        for kind in ("rgb", "depth"):
            (self.source / kind).mkdir(parents=True, exist_ok=True)
            for i in range(9):
                image = np.full((HEIGHT, WIDTH, 3), 200, np.uint8) if kind == "rgb" else \
                    np.full((HEIGHT, WIDTH), int(STORED_PER_M * wall_m), np.uint16)
                Image.fromarray(image).save(self.source / f"{kind}/{i}.png")
            (self.source / f"{kind}.txt").write_text("".join(f"{10 + i / 2} {kind}/{i}.png\n" for i in range(9)))
        (self.source / "groundtruth.txt").write_text(
            "".join(f"{10 + i / 2} 3 -2 {CHEST_M} -0.5 0.5 -0.5 0.5\n" for i in range(9)))
        (self.source / "camera.yaml").write_text(CAMERA)
        covered = script.walk(self.source, self.out, distance, every=4, speed=1)

        def images(kind):
            return [np.asarray(Image.open(self.out / name)).astype(float)
                    for _, name in script.read(self.out / f"{kind}.txt")]
        masks = [np.asarray(Image.open(path)) == 255 for path in sorted((self.out / "moving").iterdir())]
        return covered, images("depth"), images("rgb"), masks

    def test_crosses_the_view_at_its_distance(self):
        covered, depth, colour, masks = self.walk(wall_m=2, distance=1)
        self.assertEqual([share > 0 for share in covered], [False] * 3 + [True] * 3 + [False] * 3)
        near = depth[4] / STORED_PER_M
        self.assertAlmostEqual(np.median(near[22:27, 30:35]), 1 - TO_THE_ARM_M, delta=0.01)
        self.assertTrue(masks[4][24, 32] and not masks[4][:, :10].any() and not masks[4][:, 55:].any())
        self.assertTrue((colour[4][24, 30:35, 2] > colour[4][24, 30:35, 0] + 30).all())   # a blue shirt
        columns = [np.nonzero(mask.any(0))[0].mean() for mask in masks[3:6]]
        self.assertAlmostEqual(columns[1], 32, delta=1)
        self.assertAlmostEqual(abs(columns[0] - 32), 60 * 0.5 / 1, delta=8)
        self.assertAlmostEqual(columns[0] - 32, 32 - columns[2], delta=3)

    def test_the_rest_stays_but_for_the_shadow(self):
        _, depth, colour, masks = self.walk(wall_m=2, distance=1)
        rest = depth[4][~masks[4]]
        self.assertTrue(set(rest) == {0, 2 * STORED_PER_M})
        shadow = (depth[4] == 0) & ~masks[4]
        self.assertGreater(np.nonzero(shadow.any(0))[0].min(), 32)   # to the right of the chest's middle
        self.assertTrue((colour[4][~masks[4]] == 200).mean() > 0.95)
        self.assertTrue((depth[0] == 2 * STORED_PER_M).all())

    def test_what_is_nearer_hides_the_person(self):
        covered, depth, _, _ = self.walk(wall_m=0.5, distance=1)
        self.assertEqual(covered.max(), 0)
        self.assertTrue((depth[4] == 0.5 * STORED_PER_M).all())

    def test_says_what_the_camera_lacks(self):
        self.walk(wall_m=2, distance=1)
        (self.source / "camera.yaml").write_text(CAMERA.replace("fx: 60\n", ""))
        with self.assertRaisesRegex(SystemExit, "camera.yaml: no number for fx"):
            script.Camera(self.source)

    def test_a_walk_that_the_next_would_cut_short_is_refused(self):
        self.walk(wall_m=2, distance=1)
        given = [str(FILE), str(self.source), "--out", str(self.out), "--speed", "0.5", "--every", "6"]
        with unittest.mock.patch.object(sys, "argv", given), self.assertRaisesRegex(SystemExit, "takes 6.4 s"):
            script.main()


if __name__ == "__main__":
    unittest.main()
