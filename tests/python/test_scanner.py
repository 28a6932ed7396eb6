"""Tests of tessera.Scanner: the same bytes as the program, values, and errors."""
import gc
import threading
import unittest

import numpy as np

from small_scene import CAMERA, SETTINGS, SOURCE, InFolder, call_program, open_small, scan, small_frames, tessera


class TheProgramsBytes(InFolder):
    def check(self, count, **more_settings):
        settings = {**SETTINGS, "synthetic.frames": count, **more_settings}
        out = self.folder / "out"
        call_program("run", SOURCE, "--out", out, settings=settings)
        scanner, _ = scan(small_frames(count), **more_settings)
        snapshot = scanner.mesh()
        scanner.finish()
        scanner.mesh().write(self.folder / "mesh.ply")
        scanner.trajectory().write(self.folder / "trajectory.txt")
        self.assertGreater(len(scanner.mesh().triangles), 1000)
        self.assertEqual((self.folder / "mesh.ply").read_bytes(), (out / "mesh.ply").read_bytes())

        def poses(path):
            return [line for line in path.read_text().splitlines() if not line.startswith("#")]

        self.assertEqual(len(poses(out / "trajectory.txt")), count)
        self.assertEqual(poses(self.folder / "trajectory.txt"), poses(out / "trajectory.txt"))
        return snapshot, scanner.mesh()

    def test_frame_by_frame_is_the_same_as_tessera_run(self):
        snapshot, final = self.check(20)
        np.testing.assert_array_equal(snapshot.vertices, final.vertices)
        np.testing.assert_array_equal(snapshot.triangles, final.triangles)

    def test_with_another_method_and_one_thread(self):
        self.check(10, **{"tracking.method": "icp", "run.threads": "1"})

    def test_with_loops(self):
        try:
            tessera.Scanner(CAMERA, settings={"loops.enabled": True})
        except ValueError as without_ceres:
            self.skipTest(str(without_ceres))
        self.check(10, **{"loops.enabled": True})


class Results(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.frames = small_frames(8)
        cls.scanner, cls.results = scan(cls.frames)

    def test_a_frame(self):
        first, last = self.results[0], self.results[-1]
        np.testing.assert_array_equal(first.T_world_camera, np.eye(4))
        self.assertEqual((last.index, last.stamp_s, last.status, last.reason), (7, self.frames[7].stamp_s, "good", ""))
        self.assertIs(last.tracked, True)
        self.assertIs(last.fused, True)
        self.assertGreater(last.milliseconds, 0)
        self.assertEqual(last.T_world_camera.dtype, np.float64)
        truth = np.linalg.inv(self.frames[0].T_world_camera) @ self.frames[7].T_world_camera
        self.assertLess(np.abs(truth - last.T_world_camera).max(), 0.02)

    def test_the_path(self):
        path = self.scanner.trajectory()
        np.testing.assert_array_equal(path.stamps_s, [f.stamp_s for f in self.frames])
        np.testing.assert_array_equal(path.T_world_camera, [r.T_world_camera for r in self.results])

    def test_the_mesh(self):
        mesh = self.scanner.mesh()
        count = len(mesh.vertices)
        self.assertEqual(mesh.vertices.shape, (count, 3))
        self.assertEqual(mesh.vertices.dtype, np.float32)
        self.assertEqual(mesh.triangles.dtype, np.int32)
        self.assertEqual((mesh.colours.shape, mesh.colours.dtype), ((count, 3), np.uint8))
        self.assertEqual(mesh.labels.shape, (0,))
        self.assertLess(mesh.triangles.max(), count)
        np.testing.assert_allclose(np.linalg.norm(mesh.normals, axis=1), 1, atol=1e-4)

    def test_a_lost_camera_is_a_value(self):
        scanner, _ = scan(self.frames[:2])
        blind = scanner.track(np.zeros((120, 160), np.float32), None, self.frames[2].stamp_s)
        self.assertIs(blind.tracked, False)
        self.assertIsNone(blind.T_world_camera)
        self.assertEqual(blind.status, "lost")
        self.assertNotEqual(blind.reason, "")
        self.assertEqual(len(scanner.trajectory()), 2)


class Arrays(unittest.TestCase):
    def test_any_strides_and_bad_depths_give_the_same(self):
        frames = small_frames(4)
        _, expected = scan(frames)
        scanner = tessera.Scanner(CAMERA, settings=SETTINGS)
        for frame, result in zip(frames, expected):
            depth = np.asfortranarray(frame.depth_m)
            depth[depth == 0] = np.nan
            depth[0, 0] = -1 if frame.depth_m[0, 0] == 0 else depth[0, 0]
            blue_first = np.ascontiguousarray(frame.colour[..., ::-1])
            got = scanner.track(depth, blue_first[..., ::-1], frame.stamp_s, frame.colour_stamp_s)
            np.testing.assert_array_equal(got.T_world_camera, result.T_world_camera)

    def test_they_outlive_what_gave_them(self):
        frame = next(open_small(1))
        scanner, _ = scan([frame])
        depth, vertices = frame.depth_m, scanner.mesh().vertices
        expected = depth.copy(), vertices.copy()
        del frame, scanner
        gc.collect()
        rubbish = [np.full(depth.shape, 7, np.float32) for _ in range(50)]
        self.assertEqual(len(rubbish), 50)
        np.testing.assert_array_equal(depth, expected[0])
        np.testing.assert_array_equal(vertices, expected[1])


class Refused(unittest.TestCase):
    def setUp(self):
        self.scanner = tessera.Scanner(CAMERA, settings=SETTINGS)
        self.depth = np.ones((120, 160), np.float32)

    def refuse(self, kind, words, call, *arguments, **named):
        with self.assertRaisesRegex(kind, words) as caught:
            call(*arguments, **named)
        self.assertNotIn("\n", str(caught.exception))

    def test_arrays(self):
        track = self.scanner.track
        colour = np.zeros((120, 160, 3), np.uint8)
        for other in ("uint16", "float64", ">f4"):
            self.refuse(TypeError, f"depth_m: expected float32 in metres, got {other}", track, self.depth.astype(other),
                        None, 0)
        self.refuse(TypeError, "colour: expected uint8", track, self.depth, colour.astype(np.float32), 0)
        self.refuse(ValueError, r"depth_m: expected shape \(120, 160\), got \(160, 120\)", track, self.depth.T, None, 0)
        self.refuse(ValueError, "colour: expected shape", track, self.depth, colour[..., :2], 0)
        self.refuse(ValueError, "colour: expected shape", track, self.depth, colour[..., 0], 0)
        self.assertEqual(len(self.scanner.trajectory()), 0)

    def test_stamps(self):
        self.refuse(ValueError, "finite", self.scanner.track, self.depth, None, float("nan"))
        self.scanner.track(self.depth, None, 1.5)
        self.refuse(ValueError, "1.500000 is not later than", self.scanner.track, self.depth, None, 1.5)
        self.assertEqual(self.scanner.track(self.depth, None, 1.6).index, 1)

    def test_settings(self):
        new = tessera.Scanner
        self.refuse(ValueError, "mapping.voxel_size_m", new, CAMERA, settings={"mapping.voxel_size_mm": 1})
        self.refuse(ValueError, "nowhere.yaml", new, CAMERA, "nowhere.yaml")
        self.refuse(ValueError, "memory_limit_mb", new, CAMERA, settings={"mapping.memory_limit_mb": 64})
        self.refuse(ValueError, "nowhere.onnx", new, CAMERA, labels="nowhere.onnx")
        self.refuse(ValueError, "fx: 0 is not plausible", tessera.Camera, 640, 480, 0, 525, 319.5, 239.5)

    def test_calls_out_of_order(self):
        self.refuse(RuntimeError, "finish", self.scanner.objects)
        self.assertEqual(self.scanner.finish(), [])
        self.assertEqual(self.scanner.finish(), [])
        self.assertEqual(self.scanner.objects(), [])
        self.assertEqual(self.scanner.mesh().vertices.shape, (0, 3))
        self.refuse(RuntimeError, "is finished", self.scanner.track, self.depth, None, 9)


class Threads(unittest.TestCase):
    def test_two_scans_at_once_are_as_one_after_the_other(self):
        frames = small_frames(6)
        _, expected = scan(frames)
        results = [None, None]

        def work(i):
            results[i] = scan(frames)[1]

        threads = [threading.Thread(target=work, args=(i,)) for i in range(2)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for result in results:
            np.testing.assert_array_equal([r.T_world_camera for r in result], [r.T_world_camera for r in expected])

    def test_the_interpreter_goes_on_while_a_frame_is_tracked(self):
        frame = small_frames(1)[0]
        depth, colour = (image.repeat(4, axis=0).repeat(4, axis=1) for image in (frame.depth_m, frame.colour))
        camera = tessera.Camera(640, 480, 524, 524, 319.5, 239.5)
        scanner = tessera.Scanner(camera, settings={"mapping.voxel_size_m": 0.005, "mapping.truncation_m": 0.02})
        done, beats = threading.Event(), []

        def beat():
            while not done.is_set():
                beats.append(1)
                done.wait(0.001)

        thread = threading.Thread(target=beat)
        thread.start()
        before = len(beats)
        scanner.track(depth, colour, 0.0)
        during = len(beats) - before
        done.set()
        thread.join()
        self.assertGreater(during, 3)  # about one if track() held the GIL all the time


if __name__ == "__main__":
    unittest.main()
