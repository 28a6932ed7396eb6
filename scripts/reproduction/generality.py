"""Tests generality: all recordings at three speeds with all trackers, alpha auto against fixed alphas, and every
relevant constant multiplied and divided by 1.5. docs/generality.md has the protocol.
"""
import csv
import dataclasses
import math
import pathlib

from .document import Document, number, ratio
from .figures import Run
from .jobs import with_needs
from .sources import recorded, run, synthetic, wanted

RENDERED = ["desk", "corner", "floor", "wall", "room"]
STRIDES = [1, 2, 4]
METHODS = ["sdf", "sdf-geometric", "icp", "icp-rgb"]
ALPHAS = [0.01, 0.02, 0.05, 0.1, 0.2, 0.4]
FACTOR = 1.5
AS_GIVEN = "calibration.check=false"  # the camera as given, so that all runs use the same one
LEAST_FUSED = 0.98                 # of the frames that another method tracks well, or of those that the defaults fuse
ALPHA_RATIO, ALPHA_MM = 1.05, 0.1  # auto may be worse by one of these
BREAK_RATIO, BREAK_MM = 1.5, 1.0   # a changed constant breaks a recording if its ATE is worse by both of these


class FigureRun(Run):
    """A run whose mesh is deleted, because a table needs hundreds of runs."""

    def __init__(self, bench, job):
        super().__init__(bench, job)
        for file in ("mesh.ply", "preview.png"):
            (self.folder / file).unlink(missing_ok=True)
        self.job = job
        self.is_default = not {"--alpha", "--set"} & set(job.arguments[job.arguments.index(AS_GIVEN) + 1:])

    def cell(self):
        """ATE in mm. In brackets the shares tracked and fused, if not all frames were fused."""
        missing = f" ({percent(self.tracked)} % tracked, {percent(self.fused)} % fused)" if self.fused < 1 else ""
        return number(1000 * self.ate_m, 2) + missing

    def well_tracked(self):
        """Indices of the frames with status good."""
        with open(self.folder / "frames.csv", encoding="utf-8", newline="") as file:
            return {row["index"] for row in csv.DictReader(file) if row["status"] == "good"}

    def knows_its_pose(self):
        """If most frames are degenerate, the ATE is not meaningful."""
        return 2 * self.degenerate <= self.frames and not math.isnan(self.ate_m)


@dataclasses.dataclass(frozen=True)
class Constant:
    key: str
    is_count: bool

    def changed(self, value, factor):
        """The changed value in the format of --set."""
        return str(round(value * factor)) if self.is_count else f"{value * factor:.6g}"

    def tracker(self):
        return "icp-rgb" if ".icp." in self.key else "sdf"


def constants(path=pathlib.Path(__file__).with_name("constants.txt")):
    """The constants to change, from constants.txt."""
    rows = [line.split() for line in path.read_text(encoding="utf-8").splitlines() if line and line[0] != "#"]
    return [Constant(row[1], row[0] == "count") for row in rows if row[0] != "leave"]


def sequences(bench):
    found = recorded(bench) + [synthetic(bench, scene, "kinect") for scene in RENDERED]
    return [one for one in found if wanted(bench, one)]


def frames(bench, stride):
    """The same duration of each recording for every stride."""
    count = bench.sample.frames or bench.frames
    return ("--frames", str(math.ceil(count / stride))) if count else ()


def one_run(bench, sequence, label, tracker, *options, stride=1):
    sequence = dataclasses.replace(sequence, options=())
    speed = ("--stride", str(stride)) if stride > 1 else ()
    return FigureRun(bench, run(bench, sequence, f"generality/{label}", *speed, *frames(bench, stride), "--tracker", tracker,
                                "--set", AS_GIVEN, *options))


def default_run(bench, sequence, tracker="sdf", stride=1):
    return one_run(bench, sequence, f"{tracker}_{stride}", tracker, stride=stride)


def percent(share):
    return f"{100 * share:.1f}"


def trackers_table(bench, document, runs):
    """Part 1."""
    rows, misses = [], []
    for sequence in sequences(bench):
        for stride in STRIDES:
            by_method = {method: one_run(bench, sequence, f"{method}_{stride}_loops", method, "--loop-closure", "on",
                                         stride=stride) for method in METHODS}
            runs += by_method.values()
            rows.append([sequence.name, stride, by_method["sdf"].frames,
                         *(one.cell() for one in by_method.values())])
            ours, others = by_method["sdf"].well_tracked(), set()
            for method in METHODS[1:]:
                others |= by_method[method].well_tracked()
            share = len(ours & others) / max(1, len(others))
            if share < LEAST_FUSED:
                misses.append(f"{sequence.name}, stride {stride}: {percent(share)} %")
    document.tables.append((
        "Trackers and speeds: ATE in mm, and the shares tracked and fused if not every frame was fused.",
        ["recording", "stride", "frames", *METHODS], rows))
    document.notes.append(f"Recordings in which the default fuses less than {100 * LEAST_FUSED:.0f} % of the frames that any "
                          "other method tracks well: " + ("; ".join(misses) or "none") + ".")


def alpha_table(bench, document, runs):
    """Part 2."""
    rows, misses = [], []
    for sequence in sequences(bench):
        auto = default_run(bench, sequence)
        fixed = [one_run(bench, sequence, f"alpha_{alpha}", "sdf", "--alpha", str(alpha)) for alpha in ALPHAS]
        runs += [auto, *fixed]
        whole = [one.ate_m for one in fixed if one.tracked > 0.95 and not math.isnan(one.ate_m)]
        best = min(whole, default=math.nan)
        if not auto.knows_its_pose():
            verdict = "not meaningful"
        else:
            good = auto.ate_m <= ALPHA_RATIO * best or 1000 * (auto.ate_m - best) <= ALPHA_MM
            verdict = "yes" if good else "no"
        if verdict == "no":
            misses.append(sequence.name)
        rows.append([sequence.name, *(number(1000 * one.ate_m, 2) for one in fixed), number(1000 * auto.ate_m, 2),
                     ratio(auto.ate_m, best), verdict])
    document.tables.append((
        "alpha: ATE in mm.", ["recording", *(str(alpha) for alpha in ALPHAS), "auto", "auto / best fixed", "holds"], rows))
    document.notes.append(f"Recordings in which alpha auto has more than {ALPHA_RATIO} times the ATE of the best fixed alpha, "
                          f"and is more than {ALPHA_MM} mm worse: " + (", ".join(misses) or "none") + ".")


@dataclasses.dataclass
class Change:
    """One constant changed in one direction on one recording, compared with the defaults."""
    constant: Constant
    direction: str
    sequence: str
    default: FigureRun
    run: FigureRun

    def ate_ratio(self):
        """0 if the ATE is not meaningful."""
        return self.run.ate_m / self.default.ate_m if self.default.knows_its_pose() else 0.0

    def ate_change_mm(self):
        return 1000 * (self.run.ate_m - self.default.ate_m)

    def fused_change(self):
        return self.run.fused - self.default.fused

    def breaks(self):
        return (self.run.fused < LEAST_FUSED * self.default.fused or math.isnan(self.ate_ratio())
                or (self.ate_ratio() > BREAK_RATIO and self.ate_change_mm() > BREAK_MM))

    def where(self):
        return f"{self.sequence}, {self.direction}"


def changes(bench, constant):
    for sequence in sequences(bench):
        default = default_run(bench, sequence, constant.tracker())
        for direction, factor in (("x 1.5", FACTOR), ("/ 1.5", 1 / FACTOR)):
            value = constant.changed(default.json["configuration"][constant.key], factor)
            changed = one_run(bench, sequence, f"{constant.key}_{value}", constant.tracker(), "--set", f"{constant.key}={value}")
            yield Change(constant, direction, sequence.name, default, changed)


def constants_table(bench, document, runs):
    """Part 3."""
    rows, breaking = [], []
    for constant in constants():
        all_changes = list(changes(bench, constant))
        runs += [one for change in all_changes for one in (change.default, change.run)]
        if not all_changes:
            continue
        worst = max(all_changes, key=lambda change: math.inf if math.isnan(change.ate_ratio()) else change.ate_ratio())
        least = min(all_changes, key=Change.fused_change)
        broken = [change for change in all_changes if change.breaks()]
        breaking += [f"{constant.key} ({change.where()})" for change in broken]
        judged = worst.default.knows_its_pose()
        rows.append((worst.ate_ratio(), [
            f"`{constant.key}`", f"{worst.ate_ratio():.2f}" if judged else "–",
            f"{worst.ate_change_mm():+.2f}" if judged else "–", worst.where() if judged else "–",
            f"{100 * least.fused_change():+.1f}", least.where() if least.fused_change() < 0 else "–",
            len(broken)]))
    rows.sort(key=lambda row: -row[0])
    document.tables.append((
        "Constants multiplied and divided by 1.5: the worst result of all recordings, worst first. `tracking.icp` uses "
        "icp-rgb, all others the default tracker.",
        ["constant", "ATE ratio", "mm worse", "on", "share fused, points", "on", "broken runs"], [row for _, row in rows]))
    document.notes.append(f"Broken: fuses less than {100 * LEAST_FUSED:.0f} % of what the defaults fuse, or has more than "
                          f"{BREAK_RATIO} times their ATE and is over {BREAK_MM:.0f} mm worse: " + ("; ".join(breaking) or "none") + ".")


PARTS = {"methods": trackers_table, "alpha": alpha_table, "constants": constants_table}


def generality(bench):
    document = Document("Generality: all recordings, speeds and trackers, and sensitivity to constants")
    runs = []
    for part in bench.parts or PARTS:
        PARTS[part](bench, document, runs)
    document.protocol = [
        "ATE RMSE, SE(3) alignment without scale, all tracked frames. If more than half of the frames are degenerate, the "
        "ATE is not meaningful and is not judged. Cameras as given (`calibration.check=false`); lockstep. Trackers and speeds: "
        "with loop closure, which finds a lost camera; the others without, because a corrected path hides what they change."]
    document.notes.append(f"{len({one.job.name for one in runs})} runs.")
    document.commands = ["# runs with the defaults; the others add --alpha A or --set KEY=VALUE, see done.json in their folders",
                         *(bench.shown(job) for job in with_needs([one.job for one in runs if one.is_default]))]
    return document
