"""Tests of files, sources, complete runs and metrics through the Python module."""
import json
import unittest
import warnings

import numpy as np

from small_scene import CAMERA, SETTINGS, SOURCE, InFolder, call_program, open_small, scan, small_frames, tessera


def line_path(step_m):
    """Ten poses along x, a tenth of a second apart, with a bend so that an alignment is unique."""
    poses = np.tile(np.eye(4), (10, 1, 1))
    poses[:, 0, 3] = step_m * np.arange(10)
    poses[5:, 1, 3] = step_m * np.arange(5)
    poses[7:, 2, 3] = step_m
    return tessera.Trajectory(0.1 * np.arange(10), poses)


class Trajectories(InFolder):
    def test_written_and_read_back(self):
        path = line_path(0.25)
        path.write(self.folder / "path.txt")
        again = tessera.read_trajectory(self.folder / "path.txt")
        np.testing.assert_allclose(again.stamps_s, path.stamps_s, atol=1e-6)
        np.testing.assert_allclose(again.T_world_camera, path.T_world_camera, atol=1e-9)
        self.assertEqual(len(again), 10)

    def test_what_is_no_trajectory(self):
        stamps, poses = np.arange(3.0), np.tile(np.eye(4), (3, 1, 1))
        not_rigid = r"T_world_camera\[0\]"
        for words, bad in [("shape", (stamps, poses[:2])), (r"stamps_s\[1\]", (np.zeros(3), poses)),
                           (not_rigid, (stamps, 2 * poses)), (not_rigid, (stamps, np.nan * poses))]:
            with self.assertRaisesRegex(ValueError, words):
                tessera.Trajectory(*bad)
        with self.assertRaisesRegex(TypeError, "float64"):
            tessera.Trajectory(stamps, poses.astype(np.float32))
        with self.assertRaisesRegex(ValueError, "nowhere.txt"):
            tessera.read_trajectory(self.folder / "nowhere.txt")

    def test_errors_of_a_known_path(self):
        path = line_path(0.25)
        turned = np.array([[0, -1, 0, 3], [1, 0, 0, -2], [0, 0, 1, 5], [0, 0, 0, 1.0]])
        moved = tessera.Trajectory(path.stamps_s, turned @ path.T_world_camera)
        ate = tessera.evaluate_ate(path, moved, frames=20)
        self.assertLess(ate["ate_rmse_m"], 1e-9)
        self.assertEqual((ate["pairs"], ate["tracked_fraction"], ate["alignment"]), (10, 0.5, "se3"))
        rpe = tessera.evaluate_rpe(path, moved, delta_s=0.2)
        self.assertLess(rpe["rpe_trans_rmse_m"], 1e-9)
        self.assertEqual(rpe["delta_s"], 0.2)
        # With steps twice as long, the error per step is one step on the straight part and more at the bend.
        self.assertGreater(tessera.evaluate_rpe(path, line_path(0.5), delta_s=0.1)["rpe_trans_rmse_m"], 0.25 - 1e-9)
        with self.assertRaisesRegex(ValueError, "delta_s"):
            tessera.evaluate_rpe(path, moved, delta_s=0)


class Meshes(InFolder):
    def test_written_read_back_and_changed(self):
        scanner, _ = scan(small_frames(2))
        mesh = scanner.mesh()
        mesh.colours[:] = (255, 128, 0)
        mesh.write(self.folder / "mesh.ply")
        again = tessera.read_mesh(self.folder / "mesh.ply")
        np.testing.assert_array_equal(again.vertices, mesh.vertices)
        np.testing.assert_array_equal(again.triangles, mesh.triangles)
        self.assertTrue((again.colours == (255, 128, 0)).all())
        with self.assertRaisesRegex(RuntimeError, "nowhere"):
            mesh.write(self.folder / "nowhere" / "mesh.ply")
        with self.assertRaisesRegex(ValueError, "nowhere.ply"):
            tessera.read_mesh(self.folder / "nowhere.ply")

    def test_labels_of_a_file(self):
        (self.folder / "labels.ply").write_text(
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
            "property uchar class\nproperty ushort instance\nelement face 1\n"
            "property list uchar int vertex_indices\nend_header\n"
            "0 0 0 1 300\n1 0 0 2 301\n0 1 0 0 0\n3 0 1 2\n")
        labels = tessera.read_mesh(self.folder / "labels.ply").labels
        self.assertEqual(labels["class_id"].tolist(), [1, 2, 0])
        self.assertEqual(labels["instance"].tolist(), [300, 301, 0])


class Runs(InFolder):
    def test_a_run_leaves_the_programs_files(self):
        result = tessera.run(SOURCE, self.folder / "out", settings=SETTINGS, frames=5)
        self.assertEqual((result.frames, result.tracked, result.lost, result.skipped), (5, 5, 0, 0))
        self.assertLess(result.ate["ate_rmse_m"], 0.02)
        self.assertEqual(json.loads((self.folder / "out" / "timings.json").read_text())["frames"], 5)
        self.assertEqual(tessera.read_objects(self.folder / "out" / "objects.json"), [])
        self.assertEqual(len(tessera.read_trajectory(self.folder / "out" / "trajectory.txt")), 5)
        with self.assertRaisesRegex(ValueError, "not a built-in scene"):
            tessera.run("synthetic:nowhere")

    def test_a_run_that_fails_later_is_no_wrong_argument(self):
        out = self.folder / "out"
        (out / "mesh.ply" / "in_the_way").mkdir(parents=True)
        with self.assertRaisesRegex(ValueError, "mesh.ply: would be replaced"):
            tessera.run(SOURCE, out, settings=SETTINGS, frames=2)
        (out / "run.json").write_text("{}")
        with self.assertRaisesRegex(RuntimeError, "mesh.ply"):
            tessera.run(SOURCE, out, settings=SETTINGS, frames=2)

    def test_labels_can_be_none_as_for_the_program(self):
        tessera.run(SOURCE, self.folder / "out", settings=SETTINGS, frames=2, labels="none")
        self.assertFalse((self.folder / "out" / "detections.txt").exists())
        tessera.Scanner(CAMERA, settings=SETTINGS, labels="none").finish()

    def test_all_that_a_file_says_of_an_object(self):
        thing = {"id": 1, "class_id": 2, "class": "cup", "colour": "#010203", "probability": 0.5, "observations": 3,
                 "vertices": 40, "centroid": [0, 0, 1], "aabb_min": [0, 0, 0], "aabb_max": [1, 1, 2],
                 "obb_size": [1, 1, 2], "obb_centre": [0, 0, 1], "obb_quaternion_xyzw": [0, 0, 0, 1]}
        (self.folder / "objects.json").write_text(json.dumps([thing, {**thing, "embedding": [0.6, -0.8]}]))
        without, given = tessera.read_objects(self.folder / "objects.json")
        self.assertEqual((without.vertices, given.vertices), (40, 40))
        np.testing.assert_array_equal(without.embedding, np.zeros(0, np.float32))
        np.testing.assert_array_equal(given.embedding, np.array([0.6, -0.8], np.float32))

    def test_objects_of_a_run_with_labels(self):
        tessera.run(SOURCE, self.folder / "out", settings=SETTINGS, labels="synthetic")
        objects = tessera.read_objects(self.folder / "out" / "objects.json")
        mesh = tessera.read_mesh(self.folder / "out" / "mesh.ply")
        self.assertGreater(len(objects), 0)
        for thing in objects:
            self.assertIn(thing.id, mesh.labels["instance"])
            self.assertTrue((thing.box_min < thing.centroid).all() and (thing.centroid < thing.box_max).all(), thing)
            self.assertEqual(thing.T_world_oriented.shape, (4, 4))


class Sources(InFolder):
    def test_the_frames_of_a_source(self):
        frames = open_small(3)
        self.assertEqual((frames.kind, frames.frame_count), ("synthetic scene", 3))
        self.assertEqual(frames.camera, CAMERA)
        taken = list(frames)
        self.assertEqual([f.index for f in taken], [0, 1, 2])
        self.assertEqual((taken[0].depth_m.shape, taken[0].depth_m.dtype), ((120, 160), np.float32))
        self.assertEqual((taken[0].colour.shape, taken[0].colour.dtype), ((120, 160, 3), np.uint8))
        self.assertEqual(taken[0].T_world_camera.shape, (4, 4))
        self.assertEqual(list(frames), [])
        with self.assertRaisesRegex(ValueError, "no such folder"):
            tessera.frames(self.folder / "nowhere")

    def test_a_bad_image_is_a_warning_and_the_loop_goes_on(self):
        recorded = self.folder / "recorded"
        call_program("synth", "desk", "--out", recorded, "--frames", "3", settings=SETTINGS)
        bad = sorted((recorded / "depth").iterdir())[1]
        bad.write_bytes(bad.read_bytes()[:100])
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            self.assertEqual([frame.index for frame in tessera.frames(recorded)], [0, 2])
        self.assertEqual(len(caught), 1, [str(w.message) for w in caught])
        self.assertIn(bad.name, str(caught[0].message))


if __name__ == "__main__":
    unittest.main()
