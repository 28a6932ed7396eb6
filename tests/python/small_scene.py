"""Shared by the tests of the Python module: a scene of a few small frames, and a temporary folder."""
import functools
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
import tessera  # noqa: E402

SOURCE = "synthetic:desk"
SETTINGS = {
    "synthetic.width": 160, "synthetic.height": 120, "synthetic.fx": 131, "synthetic.fy": 131, "synthetic.cx": 79.5,
    "synthetic.cy": 59.5, "synthetic.frames": 20, "mapping.voxel_size_m": 0.04, "mapping.truncation_m": 0.16,
}


CAMERA = tessera.Camera(160, 120, 131, 131, 79.5, 59.5)


def open_small(count):
    return tessera.frames(SOURCE, settings={**SETTINGS, "synthetic.frames": count})


@functools.cache
def all_frames():
    return list(open_small(20))


def small_frames(count=20):
    """The first frames of the scene, rendered once. Tests must not modify their arrays."""
    return all_frames()[:count]


def scan(frames, **more_settings):
    """A Scanner that has tracked all of these frames, and its results."""
    scanner = tessera.Scanner(CAMERA, settings={**SETTINGS, **more_settings})
    return scanner, [scanner.track(f.depth_m, f.colour, f.stamp_s, f.colour_stamp_s) for f in frames]


def call_program(*arguments, settings):
    sets = [word for key, value in settings.items() for word in ("--set", f"{key}={str(value).lower()}")]
    subprocess.run([os.environ["TESSERA_PROGRAM"], *arguments, *sets], check=True, capture_output=True)


class InFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
