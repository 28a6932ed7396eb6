"""What one finished run of tessera gives: its figures from run.json, and how a table's cell shows them."""
from .document import number


class Run:
    """`job` is finished on construction. ATE as `tessera eval ate` defines it; nan where too little was tracked."""

    def __init__(self, bench, job):
        self.folder = bench.run(job)
        self.json = bench.read(job, "run.json")
        self.busy_cores = bench.record(job).get("busy_cores", 0.0)
        counts = self.json["counts"]
        self.frames, self.degenerate = counts["frames"], counts["degenerate"]
        self.tracked = counts["tracked"] / max(1, counts["frames"])
        self.ate_m = (self.json.get("ate") or {}).get("ate_rmse_m", float("nan"))

    def ate_cell(self):
        """ATE in metres; with the share tracked where that is not all, as the error is over those frames only."""
        missing = "" if self.tracked == 1 else f" ({100 * self.tracked:.0f} % tracked)"
        return number(self.ate_m) + missing


def used(sequence):
    """A table's cell about the data."""
    return f"{sequence.kind} (stand-in)" if sequence.needs else sequence.kind


STAND_IN_NOTE = ("A stand-in is another scene than the paper's, so its ratio only says whether the order of size is "
                 "the paper's. With the TUM RGB-D sequence in `--tum` the same row is measured on that.")
ATE_PROTOCOL = ("ATE RMSE in metres, SE(3) alignment without scale, pairs within 0.02 s, all tracked frames; lockstep, "
                "so every frame and the same figures on every run and for any number of threads; no loop closure "
                "unless said.")
