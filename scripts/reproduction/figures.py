"""The figures of one finished run of tessera, from run.json, and their table cells."""
from .document import number


class Run:
    """Runs `job` on construction. ATE as `tessera run` prints it; nan if too little was tracked."""

    def __init__(self, bench, job):
        self.folder = bench.run(job)
        self.json = bench.read(job, "run.json")
        self.busy_cores = bench.record(job).get("busy_cores", 0.0)
        counts = self.json["counts"]
        self.frames, self.degenerate = counts["frames"], counts["degenerate"]
        self.tracked = counts["tracked"] / max(1, counts["frames"])
        self.fused = counts["fused"] / max(1, counts["frames"])
        self.ate_m = (self.json.get("ate") or {}).get("ate_rmse_m", float("nan"))

    def ate_cell(self):
        """ATE in metres. Adds the share of frames tracked if not all were, because the ATE covers only those."""
        missing = "" if self.tracked == 1 else f" ({100 * self.tracked:.0f} % tracked)"
        return number(self.ate_m) + missing


def used(sequence):
    """Table cell that describes the data."""
    return f"{sequence.kind} (stand-in)" if sequence.needs else sequence.kind


STAND_IN_NOTE = ("A stand-in is a different scene from the paper's, so its ratio only shows whether the order of "
                 "magnitude agrees. If the TUM RGB-D sequence is in `--tum`, the row is measured on it.")
PART_NOTE = ("A recording of which only a part is here says so in \"measured on\". The papers' figures are for the whole "
             "recording.")
ATE_PROTOCOL = ("ATE RMSE in metres, SE(3) alignment without scale, ground truth interpolated to each frame's time, all "
                "tracked frames; lockstep, so every frame is used and the figures are the same on every run and for any "
                "number of threads; no loop closure unless stated.")
