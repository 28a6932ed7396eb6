"""Tests of scripts/degrade on a recording of twelve tiny images."""
import importlib.machinery
import importlib.util
import pathlib
import sys
import tempfile
import unittest

try:
    import numpy as np
    from PIL import Image
except ModuleNotFoundError:
    print("skipped: needs numpy and Pillow (apt-get install python3-numpy python3-pil)")
    sys.exit(77)

FILE = pathlib.Path(__file__).resolve().parents[2] / "scripts/degrade"
sys.dont_write_bytecode = True
loader = importlib.machinery.SourceFileLoader("degrade", str(FILE))
script = importlib.util.module_from_spec(importlib.util.spec_from_loader("degrade", loader))
loader.exec_module(script)

CAMERA = "width: 8\nheight: 6\nfx: 7\nfy: 7\ncx: 3.25\ncy: 2.5\ndistortion: [0.1, 0.2, 0.3, 0.4, 0.5]   # five\n"


class Degrade(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.root = pathlib.Path(holder.name)
        self.source = self.root / "source"
        for kind in ("rgb", "depth"):
            (self.source / kind).mkdir(parents=True)
            names = [f"{kind}/{i}.png" for i in range(12)]
            for i, name in enumerate(names):
                ramp = np.tile(np.arange(8), (6, 1)) + 20 * i + 30
                Image.fromarray(np.dstack([ramp] * 3).astype(np.uint8) if kind == "rgb" else
                                (100 * ramp).astype(np.uint16)).save(self.source / name)
            (self.source / f"{kind}.txt").write_text(
                "# comment\n" + "".join(f"{10 + i / 2} {name}\n" for i, name in enumerate(names)))
        (self.source / "groundtruth.txt").write_text(
            "".join(f"{10 + i / 2} {i} 2 3 0.1 0.2 0.3 0.9\n" for i in range(12)))
        (self.source / "camera.yaml").write_text(CAMERA)

    def make(self, name):
        out = self.root / name
        script.degrade(self.source, out, script.VARIANTS[name])
        return out

    def images(self, out, kind):
        return [np.asarray(Image.open(out / name)) for _, name in script.read(out / f"{kind}.txt")]

    def test_gaps_leave_out_both_images(self):
        out = self.make("gaps")
        stamps = [float(stamp) for stamp, _ in script.read(out / "depth.txt")]
        self.assertEqual(stamps, [10 + i / 2 for i in range(12) if i != 7])
        self.assertEqual(stamps, [float(stamp) for stamp, _ in script.read(out / "rgb.txt")])

    def test_images_change_when_they_should(self):
        change = script.every(4, 1, script.dazzled)
        variant = script.Variant("", colour=change)
        script.degrade(self.source, self.root / "white", variant)
        white = [bool((image == 255).all()) for image in self.images(self.root / "white", "rgb")]
        self.assertEqual(white, [i % 4 == 3 for i in range(12)])

    def test_a_frozen_camera_repeats_its_last_image(self):
        script.degrade(self.source, self.root / "frozen", script.Variant("", frozen=lambda i: 3 <= i < 6))
        shades = [int(image[0, 0, 0]) for image in self.images(self.root / "frozen", "rgb")]
        self.assertEqual(shades, [30 + 20 * (2 if 3 <= i < 6 else i) for i in range(12)])

    def test_reversed_plays_images_and_poses_backwards(self):
        out = self.make("reversed")
        self.assertEqual([int(image[0, 0]) for image in self.images(out, "depth")],
                         [100 * (30 + 20 * i) for i in reversed(range(12))])
        truth = script.read(out / "groundtruth.txt")
        self.assertEqual([float(words[0]) for words in truth], [10 + i / 2 for i in range(12)])
        self.assertEqual([float(words[1]) for words in truth], [11 - i for i in range(12)])

    # A point that the mirrored camera sees projects to the mirrored pixel, from the mirrored pose.
    def test_a_mirror_exchanges_left_and_right_everywhere(self):
        out = self.make("mirrored")
        self.assertEqual([int(v) for v in self.images(out, "depth")[0][0]], [100 * (37 - i) for i in range(8)])
        camera = (out / "camera.yaml").read_text()
        self.assertIn("cx: 3.75\n", camera)
        self.assertIn("distortion: [0.1, 0.2, 0.3, -0.4, 0.5]", camera)
        mirror = np.diag([-1.0, 1, 1])

        def rotation(words):
            x, y, z, w = np.array([float(v) for v in words[4:8]]) / np.linalg.norm([float(v) for v in words[4:8]])
            return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                             [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                             [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
        before, after = (script.read(folder / "groundtruth.txt")[4] for folder in (self.source, out))
        np.testing.assert_allclose(rotation(after), mirror @ rotation(before) @ mirror, atol=1e-12)
        self.assertEqual([float(v) for v in after[1:4]], [-4, 2, 3])

    def test_noise_leaves_holes_and_scatters_with_the_square_of_depth(self):
        depth = np.zeros((100, 100), np.uint16)
        depth[:50] = 2 * 5000
        noisy = script.noise(depth, 0, np.random.default_rng(1))
        self.assertTrue((noisy[50:] == 0).all())
        self.assertAlmostEqual(noisy[:50].std() / 5000, 0.3 * 2 * 2 / 42.75, delta=0.002)

    def test_flying_pixels_lie_between_the_surfaces_at_edges_only(self):
        depth = np.full((100, 100), 5000, np.uint16)
        depth[:, 50:] = 10000
        depth[:, 80:] = 0
        flown = script.flying(depth, 0, np.random.default_rng(1))
        changed = flown != depth
        self.assertEqual(set(np.nonzero(changed)[1]), {49, 50})
        self.assertAlmostEqual(changed.sum() / 200, 0.5, delta=0.1)
        self.assertTrue(((flown[changed] >= 5000) & (flown[changed] <= 10000)).all())


if __name__ == "__main__":
    unittest.main()
