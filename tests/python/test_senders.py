"""The senders in python/examples, each against a stand-in for its camera's package."""
import os
import pathlib
import struct
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
EXAMPLES = ROOT / "python/examples"
sys.path[:0] = [str(ROOT / "tests/python/stand_ins"), str(EXAMPLES)]

import frames  # noqa: E402
from stream import FrameSender  # noqa: E402


def run_example(name, *more_paths):
    """Returns what the example sends, in a process of its own."""
    script = (f"import sys, runpy; sys.path[:0] = {[*more_paths, *sys.path[:2]]!r}; sys.argv = ['x', '-']\n"
              f"from frames import NoMoreFrames\n"
              f"try:\n    runpy.run_path({str(EXAMPLES / name)!r})\nexcept NoMoreFrames:\n    pass\n")
    return subprocess.run([sys.executable, "-c", script], stdout=subprocess.PIPE, check=True).stdout


def parse(stream):
    """Returns the camera's lines and the frames (stamp in seconds, depth, colour) of a stream."""
    assert stream[:8] == b"TESSERA1", stream[:20]
    length, = struct.unpack_from("<I", stream, 8)
    camera = dict(line.split(": ") for line in stream[12:12 + length].decode().splitlines())
    size = (int(camera["height"]), int(camera["width"]))
    at, found = 12 + length, []
    while at < len(stream):
        stamp_us, depth_bytes, colour_bytes = struct.unpack_from("<qii", stream, at)
        at += 16
        depth = np.frombuffer(stream, np.uint16, depth_bytes // 2, at).reshape(size)
        colour = np.frombuffer(stream, np.uint8, colour_bytes, at + depth_bytes).reshape(size + (3,))
        at += depth_bytes + colour_bytes
        found.append((1e-6 * stamp_us, depth, colour))
    return camera, found


class Senders(unittest.TestCase):
    def check(self, name, width=frames.WIDTH, height=frames.HEIGHT):
        camera, found = parse(run_example(name))
        self.assertEqual((int(camera["width"]), int(camera["height"])), (width, height))
        self.assertEqual([float(camera[key]) for key in ("fx", "fy", "cx", "cy")],
                         [frames.FX, frames.FY, frames.CX, frames.CY])
        self.assertEqual(float(camera["depth_scale"]), 1000)
        self.assertNotIn("distortion", camera)
        self.assertEqual(len(found), 2)
        for number, (stamp_s, depth, colour) in enumerate(found):
            self.assertAlmostEqual(stamp_s, frames.STAMPS_S[number], places=5)
            np.testing.assert_array_equal(depth, frames.depth_mm(number, width, height))
            np.testing.assert_array_equal(colour, frames.colour_rgb(number, width, height))

    def test_realsense(self):
        self.check("realsense.py")

    def test_azure_kinect(self):
        try:
            import cv2  # noqa: F401
        except ImportError:
            self.skipTest("no OpenCV for Python: apt-get install python3-opencv")
        self.check("azure_kinect.py", 1280, 720)

    def test_opencv_capture(self):
        before_s = time.time()
        camera, found = parse(run_example("opencv_capture.py", str(ROOT / "tests/python/stand_ins/opencv")))
        self.assertEqual([float(camera[key]) for key in ("width", "height", "fx", "fy", "cx", "cy", "depth_scale")],
                         [frames.WIDTH, frames.HEIGHT, frames.FX, frames.FX, 319.5, 239.5, 1000])
        self.assertEqual(len(found), 2)
        self.assertLess(before_s, found[0][0])
        self.assertLess(found[0][0], found[1][0])
        for number, (_, depth, colour) in enumerate(found):
            np.testing.assert_array_equal(depth, frames.depth_mm(number))
            np.testing.assert_array_equal(colour, frames.colour_rgb(number))

    def test_orbbec(self):
        self.check("orbbec.py")

    def test_oak(self):
        self.check("oak.py")

    def test_ros2_topics(self):
        self.check("ros2_topics.py")
        os.environ["ROS_CASE"] = "alpha"
        self.addCleanup(os.environ.pop, "ROS_CASE")
        self.check("ros2_topics.py")
        os.environ["ROS_CASE"] = "grey"
        for number, (_, _, colour) in enumerate(parse(run_example("ros2_topics.py"))[1]):
            grey = frames.colour_rgb(number)[:, :, :1]
            np.testing.assert_array_equal(colour, np.repeat(grey, 3, axis=2))

    def test_ros2_topics_says_what_it_cannot_send(self):
        script = (f"import sys, runpy; sys.path[:0] = {sys.path[:2]!r}; sys.argv = ['x', '-']\n"
                  f"runpy.run_path({str(EXAMPLES / 'ros2_topics.py')!r})\n")
        for case, words, code in (("bayer", "/camera/color/image_raw: the encoding bayer_rggb8 is not one of rgb8", 1),
                                  ("size", "image_raw: images of 320 x 240, but /camera/color/camera_info says 640 x 480",
                                   1),
                                  ("fisheye", "the lens model equidistant is not sent", 1),  # ends with NoMoreFrames
                                  ("gone", "", 0)):
            done = subprocess.run([sys.executable, "-c", script], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                  check=False, env={**os.environ, "ROS_CASE": case})
            self.assertEqual(done.returncode, code, case)
            self.assertIn(words, done.stderr.decode())
            self.assertEqual("Traceback" in done.stderr.decode(), case == "fisheye")
            self.assertTrue(words or not done.stderr)


class Sender(unittest.TestCase):
    def test_wrong_arrays_are_named(self):
        with tempfile.TemporaryFile() as file:
            sender = FrameSender.__new__(FrameSender)
            sender._size, sender._compress, sender._file = (4, 6), False, file
            for depth, colour, word in ((np.zeros((4, 6)), None, "depth"),
                                        (np.zeros((6, 4), np.uint16), None, "depth"),
                                        (np.zeros((4, 6), np.uint16), np.zeros((4, 6), np.uint8), "colour")):
                with self.assertRaisesRegex(ValueError, word):
                    sender.send(0, depth, colour)

    def test_lines_of_a_file_that_grows(self):
        from tessera.live import _GrowingLines
        with tempfile.TemporaryDirectory() as folder:
            path = folder + "/path.txt"
            late = _GrowingLines(path)
            self.assertEqual(late.read(), [])
            with open(path, "wb") as file:
                file.write(b"old\n")
            new = _GrowingLines(path)
            self.assertEqual((late.read(), new.read()), ([b"old"], []))
            with open(path, "ab") as file:
                file.write(b"one\ntw")
            self.assertEqual((late.read(), new.read()), ([b"one"], [b"one"]))
            with open(path, "ab") as file:
                file.write(b"o\n")
            self.assertEqual((late.read(), late.read()), ([b"two"], []))
            with open(path, "wb") as file:  # begun again in place
                file.write(b"x\ny")
            self.assertEqual(late.read(), [b"x"])
            os.rename(path, folder + "/earlier.txt")
            with open(path, "wb") as file:  # another file
                file.write(b"a much longer line than before\n")
            self.assertEqual((late.read(), new.read()), ([b"a much longer line than before"],) * 2)

    def test_a_live_scan(self):
        import tessera.live
        size = {"synthetic.width": 160, "synthetic.height": 120, "synthetic.fx": 131, "synthetic.fy": 131,
                "synthetic.cx": 79.5, "synthetic.cy": 59.5}
        scene = list(tessera.frames("synthetic:desk", settings={"synthetic.frames": 12, **size}))
        with tempfile.TemporaryDirectory() as folder:
            out = folder + "/o"
            os.mkdir(out)
            with open(out + "/trajectory.txt", "w", encoding="ascii") as earlier:
                earlier.write("1 0 0 0 0 0 0 1\n")
            with open(out + "/run.json", "w", encoding="ascii") as mark:
                mark.write("{}")
            with tessera.live.Live(scene[0].camera, out, options=["--mode", "lockstep"], depth_scale=5000,
                                   settings={"mapping.voxel_size_m": 0.04, "mapping.truncation_m": 0.16}) as live:
                for frame in scene:
                    live.push(np.round(5000 * frame.depth_m).astype(np.uint16), frame.colour, frame.stamp_s)
            self.assertEqual(len(live.trajectory().stamps_s), 12)
            poses = live.poses()
            self.assertEqual(list(poses[:, 0]), list(live.trajectory().stamps_s))
            np.testing.assert_allclose(poses[:, 1:4], live.trajectory().T_world_camera[:, :3, 3], atol=1e-6)
            self.assertGreater(len(live.mesh().triangles), 1000)
            with self.assertRaisesRegex(BrokenPipeError, "the scan has ended"):
                live.push(np.zeros((120, 160), np.uint16), None, 99.0)
            failing = tessera.live.Live(scene[0].camera, out, options=["--tracker", "none"])
            with self.assertRaisesRegex(RuntimeError, "exit code 2"):
                failing.finish()

    def test_a_push_while_a_live_scan_ends_does_not_wait_for_it(self):
        """The program, a script here, says that its input has ended, and then takes long to end."""
        import tessera.live
        with tempfile.TemporaryDirectory() as folder:
            program, ended, may_end = (os.path.join(folder, name) for name in ("program", "ended", "may_end"))
            os.mkfifo(ended)
            os.mkfifo(may_end)
            with open(program, "w", encoding="ascii") as script:
                script.write(f"#!/bin/sh\ncat > /dev/null\n: > {ended}\ncat {may_end}\necho done\n")
            os.chmod(program, 0o700)
            live = tessera.live.Live(tessera.Camera(64, 48, 50, 50, 31.5, 23.5), folder + "/o", program=program)
            summaries, refused = [], threading.Event()

            def push():
                try:
                    live.push(np.zeros((48, 64), np.uint16), None, 1.0)
                except BrokenPipeError:
                    refused.set()

            ending = threading.Thread(target=lambda: summaries.append(live.finish()), daemon=True)
            ending.start()
            with open(ended, "rb") as file:
                file.read()
            threading.Thread(target=push, daemon=True).start()
            was_refused = refused.wait(30)
            self.assertEqual(summaries, [])
            with open(may_end, "wb"):
                pass
            ending.join()
            self.assertTrue(was_refused)
            self.assertEqual(summaries, ["done\n"])

    def test_the_program_scans_what_is_sent(self):
        """Over a socket, with compressed depth, in both modes."""
        import tessera
        settings = {"synthetic.frames": 12, "synthetic.width": 160, "synthetic.height": 120, "synthetic.fx": 131,
                    "synthetic.fy": 131, "synthetic.cx": 79.5, "synthetic.cy": 59.5}
        scene = list(tessera.frames("synthetic:desk", settings=settings))
        with tempfile.TemporaryDirectory() as folder:
            socket = os.path.join(folder, "camera.sock")
            program = subprocess.Popen(
                [os.environ["TESSERA_PROGRAM"], "run", f"pipe:{socket}", "--frames", "12", "--mode", "lockstep",
                 "--set", "mapping.voxel_size_m=0.04", "--set", "mapping.truncation_m=0.16", "--out", folder + "/o"],
                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
            sender = FrameSender(socket, 160, 120, 131, 131, 79.5, 59.5, depth_scale=5000, compress=True)
            for frame in scene:
                sender.send(frame.stamp_s, np.round(5000 * frame.depth_m).astype(np.uint16), frame.colour)
            out, err = program.communicate()
            self.assertEqual(program.returncode, 0, err)
            self.assertIn("12 frames, 12 tracked", out)
            self.assertEqual(len(tessera.read_trajectory(folder + "/o/trajectory.txt").stamps_s), 12)


if __name__ == "__main__":
    unittest.main()
