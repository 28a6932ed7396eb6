"""Tests of scripts/reproduce: Markdown from fixed results, its own ATE against `tessera eval ate`, job reuse, the model
of [D18] table 3, the generality criteria, and two tables end to end on a few frames. Usage: test_reproduce.py TESSERA
"""
import io
import json
import math
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile
import types
import unittest
import unittest.mock

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
sys.dont_write_bytecode = True
from reproduction import bust, diaz, document, generality, surface, trajectories  # noqa: E402
from reproduction.jobs import Job, JobFailed, Workbench  # noqa: E402
from reproduction.sample import Sample  # noqa: E402

TESSERA = None


class Folder(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.root = pathlib.Path(self.temporary.name)

    def tearDown(self):
        self.temporary.cleanup()

    def bench(self):
        return Workbench(TESSERA, self.root / "out", log=io.StringIO())


class Markdown(unittest.TestCase):
    def test_canned_figures(self):
        one = document.Document("T", tables=[("Cap.", ["a", "paper", "ours", "ratio"], [
            ["x", document.number(0.2, 3), document.number(0.1), document.ratio(0.1, 0.2)],
            ["y", document.number(None), document.number(math.nan), document.ratio(math.nan, 0.2)]])],
            notes=["n"], protocol=["p"], commands=["tessera run X"], pictures=[("f.png", "F")])
        text = one.markdown("tessera 1")
        self.assertIn("Cap.\n\n| a | paper | ours | ratio |\n| --- | --- | --- | --- |\n"
                      "| x | 0.200 | 0.1000 | 0.50 |\n| y | – | – | – |\n", text)
        for part in ("# T\n", "![F](f.png)", "- n\n", "## Protocol\n\n- p\n", "    tessera run X\n",
                     "Versions: tessera 1;"):
            self.assertIn(part, text)

    def test_row_of_another_length_is_refused(self):
        with self.assertRaises(ValueError):
            document.table(["a", "b"], [["1"]])


class Trajectories(Folder):
    def walk(self, noise):
        """A random walk and an estimate of it: rotated, shifted and noisy, with clock errors within the pairing limit."""
        rng = random.Random(7)
        turn, offset = (0.1, 0.7, -0.5, 0.5), (3.0, -2.0, 0.5)
        norm = math.sqrt(sum(k * k for k in turn))
        turn = tuple(k / norm for k in turn)
        place, true, estimate = [0.0, 0.0, 0.0], [], []
        for i in range(300):
            place = [p + rng.gauss(0, 0.02) for p in place]
            true.append((100 + 0.01 * i, *place, 0, 0, 0, 1))
            if i % 3 == 0:
                moved = [a + o + rng.gauss(0, noise) for a, o in zip(trajectories.rotate(turn, place), offset)]
                estimate.append((100 + 0.01 * i + rng.uniform(-0.004, 0.004), *moved, *turn))
        for name, rows in (("true.txt", true), ("ours.txt", estimate)):
            (self.root / name).write_text("\n".join(" ".join(f"{v:.9f}" for v in row) for row in rows) + "\n")
        return [trajectories.read(self.root / name) for name in ("true.txt", "ours.txt")]

    def test_a_rigid_motion_is_no_error(self):
        self.assertLess(trajectories.rms(trajectories.ate(*self.walk(noise=0))), 1e-8)

    def test_same_as_tessera(self):
        ours = trajectories.ate(*self.walk(noise=0.03))
        out = self.root / "ate.json"
        subprocess.run([TESSERA, "eval", "ate", self.root / "true.txt", self.root / "ours.txt", "--json", out],
                       check=True, capture_output=True)
        theirs = json.loads(out.read_text())
        self.assertEqual(len(ours), theirs["pairs"])
        self.assertAlmostEqual(trajectories.rms(ours), theirs["ate_rmse_m"], delta=1e-6)
        self.assertAlmostEqual(max(ours), theirs["ate_max_m"], delta=1e-6)
        self.assertGreater(theirs["ate_rmse_m"], 0.03)

    def test_errors_from_the_first_pose(self):
        half = math.radians(1.0) / 2
        true = [(0, (0, 0, 0), (0, 0, 0, 1)), (1, (1, 0, 0), (0, 0, 0, 1))]
        ours = [(0, (5, 5, 5), (0, 0, 0, 1)), (1, (6, 5.01, 5), (0, math.sin(half), 0, math.cos(half)))]
        rows = trajectories.errors_from_first(true, ours)
        self.assertAlmostEqual(rows[1][1], 0.01)
        for found, wanted in zip(rows[1][2], (0, 1, 0)):
            self.assertAlmostEqual(found, wanted)

    def test_bad_line_is_named(self):
        (self.root / "bad.txt").write_text("# x\n1 2 3\n")
        with self.assertRaisesRegex(ValueError, "bad.txt:2"):
            trajectories.read(self.root / "bad.txt")


class Model(unittest.TestCase):
    def test_closed_and_facing_outwards(self):
        vertices, triangles = bust.vertices_and_triangles(10, 16)
        edges = {}
        for a, b, c in triangles:
            for edge in ((a, b), (b, c), (c, a)):
                edges[edge] = edges.get(edge, 0) + 1
        self.assertTrue(all(n == 1 and edges.get((b, a)) == 1 for (a, b), n in edges.items()))
        volume = 0.0
        for face in triangles:
            a, b, c = (vertices[i] for i in face)
            volume += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2])
                       + a[2] * (b[0] * c[1] - b[1] * c[0])) / 6
        self.assertTrue(0.05 < volume < 0.4, volume)

    def test_cameras_look_at_the_target_and_step_by_ten_degrees(self):
        views, target = surface.views(), (0.1, 0.2, 0.6)
        for view in views:
            numbers = [float(word) for word in surface.pose_line(0, *view, target, 1).split()]
            eye, q = numbers[1:4], numbers[4:8]
            seen = [e + surface.DISTANCE_M * k for e, k in zip(eye, trajectories.rotate(q, (0, 0, 1)))]
            self.assertLess(math.dist(seen, target), 1e-6)
            self.assertAlmostEqual(trajectories.rotate(q, (1, 0, 0))[2], 0, delta=1e-6)  # level
            self.assertLessEqual(trajectories.rotate(q, (0, 1, 0))[2], 1e-6)             # not upside down
        for (a, e), (b, f) in zip(views, views[1:]):
            turn = min(abs(a - b) % 360, 360 - abs(a - b) % 360)
            self.assertLessEqual(max(turn, abs(e - f)), 10, f"{a, e} to {b, f}")


class Jobs(Folder):
    def test_finished_jobs_are_reused_and_changed_ones_repeated(self):
        bench = self.bench()
        jobs = [Job("corner", ("synth", "corner", "--frames", str(n), "--set", "synthetic.fps=10", "--out",
                               str(bench.folder("corner") / "s"))) for n in (2, 3)]
        bench.run(jobs[0])
        stamp = (bench.folder("corner") / "done.json").stat().st_mtime_ns
        bench.run(jobs[0])
        self.assertEqual((bench.folder("corner") / "done.json").stat().st_mtime_ns, stamp)
        self.assertFalse(bench.is_done(jobs[1]))
        bench.run(jobs[1])
        self.assertTrue(bench.is_done(jobs[1]))
        self.assertNotIn(str(self.root), bench.shown(jobs[1]))

    def test_a_program_built_anew_is_refused(self):
        program = self.root / "tessera"
        shutil.copy(TESSERA, program)
        bench = Workbench(program, self.root / "out", log=io.StringIO())
        with open(program, "ab") as file:
            file.write(b"x")
        with self.assertRaisesRegex(JobFailed, "built anew"):
            bench.run(Job("x", ("config",)))

    def test_refusal_is_passed_on(self):
        with self.assertRaisesRegex(JobFailed, "nowhere"):
            self.bench().run(Job("x", ("run", "nowhere")))


class Generality(Folder):
    def canned(self, ate_m, fused, degenerate=0):
        return types.SimpleNamespace(ate_m=ate_m, fused=fused, knows_its_pose=lambda: degenerate == 0)

    def change(self, default, changed):
        return generality.Change(None, "x 1.5", "somewhere", self.canned(*default), self.canned(*changed))

    def test_what_breaks_a_recording(self):
        for default, changed, breaks in (((0.010, 1.0), (0.0149, 0.985), False),
                                         ((0.010, 1.0), (0.0151, 1.0), True),
                                         ((0.001, 1.0), (0.0019, 1.0), False),       # less than a millimetre
                                         ((0.010, 1.0), (0.010, 0.97), True),
                                         ((0.010, 0.5), (0.010, 0.495), False),      # relative to the defaults
                                         ((0.010, 1.0), (math.nan, 1.0), True),
                                         ((0.300, 1.0, 1), (0.900, 1.0), False),     # degenerate: ATE is random
                                         ((0.300, 1.0, 1), (0.300, 0.5), True)):
            self.assertEqual(self.change(default, changed).breaks(), breaks, (default, changed))

    def test_constants_are_changed_as_they_are_written(self):
        by_key = {constant.key: constant for constant in generality.constants()}
        self.assertGreater(len(by_key), 30)
        self.assertNotIn("tracking.sdf.levels", by_key)
        self.assertEqual(by_key["mapping.voxel_size_m"].changed(0.01, 1.5), "0.015")
        self.assertEqual(by_key["tracking.icp.fine_iterations"].changed(4, 1 / 1.5), "3")
        self.assertEqual(by_key["tracking.icp.fine_iterations"].tracker(), "icp-rgb")

    def test_the_tables(self):
        bench = Workbench(TESSERA, self.root / "out", sample=Sample(frames=8), log=io.StringIO())
        bench.only = ["corner_kinect"]
        few = [constant for constant in generality.constants() if constant.key == "mapping.voxel_size_m"]
        with unittest.mock.patch.multiple(generality, STRIDES=[1, 2], ALPHAS=[0.05], constants=lambda: few):
            text = generality.generality(bench).markdown(bench.version)
        self.assertRegex(text, r"\| corner_kinect \| 1 \| 8 \|( \d\.\d\d \|){4}\n\| corner_kinect \| 2 \| 4 \|( \d\.\d\d \|){4}\n")
        self.assertRegex(text, r"\| corner_kinect \| \d\.\d\d \| \d\.\d\d \| \d\.\d\d \| (yes|no) \|\n")
        self.assertRegex(text, r"\| `mapping.voxel_size_m` \| \d\.\d\d \| [+-]\d\.\d\d \| corner_kinect, [x/] 1.5 \| \+0.0 \| – \| 0 \|\n")
        self.assertIn("- 12 runs.\n", text)
        self.assertNotIn("voxel_size_m=", text)  # only the commands of the defaults are listed
        self.assertFalse(list(self.root.rglob("mesh.ply")))


class EndToEnd(Folder):
    def test_a_table(self):
        bench = Workbench(TESSERA, self.root / "out", sample=Sample(frames=10), log=io.StringIO())
        text = diaz.table5(bench).markdown(bench.version)
        self.assertRegex(text, r"\| Tracking \| 68.4 \|( \d+\.\d \|){3}( \d+\.\d\d \|){3}\n")
        self.assertRegex(text, r"\| Rasterization \| 8.7 \| (\d+\.\d|–) \| – \| – \|")
        self.assertIn("tessera synth desk --noise none --out $OUT/jobs/data/desk_none/sequence --frames 10\n", text)
        self.assertNotIn(str(self.root), text)

    def test_bad_input_is_one_line(self):
        for options, expected in ((["--tum", "/nowhere"], "--tum /nowhere"), (["--job", "none"], "--job none")):
            done = subprocess.run([sys.executable, ROOT / "scripts/reproduce", "b14-table1", "--tessera", TESSERA,
                                   "--out", self.root, *options], capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 2)
            self.assertIn(expected, done.stderr)
            self.assertEqual(len(done.stderr.strip().splitlines()), 1)


if __name__ == "__main__":
    TESSERA = sys.argv.pop(1)
    unittest.main()
