"""The papers' presets and our defaults on the same recordings."""
from .bylow import commands
from .document import Document
from .figures import ATE_PROTOCOL, PART_NOTE, Run
from .diaz import METHODS
from .sources import rows, run, synthetic, wanted

SETTINGS = {"bylow2014": ("--config", "bylow2014"), "diaz2018": METHODS["diaz2018"], "defaults": ()}


def presets(bench):
    document = Document("Presets against defaults")
    rendered = synthetic(bench, "desk", "kinect")
    sequences = [(rendered.name, rendered, None)] if wanted(bench, rendered) else []
    cells, jobs = [], []
    for name, sequence, _ in sequences + rows(bench, {}):
        for setting, options in SETTINGS.items():
            jobs.append(run(bench, sequence, "sdf" if setting == "defaults" else setting, *options))
            one = Run(bench, jobs[-1])
            cells.append([name, sequence.kind, setting, one.ate_cell(), percent(one.tracked), percent(one.fused),
                          f"{one.degenerate} of {one.frames}"])
    document.tables = [("", ["sequence", "measured on", "settings", "ATE [m]", "tracked", "fused", "degenerate"], cells)]
    document.notes = [PART_NOTE, "The ATE covers only the frames that were tracked. A degenerate frame leaves some motion "
                      "unknown to half a voxel, so this depends on the preset's voxels."]
    document.protocol = [
        ATE_PROTOCOL, "`bylow2014` and `diaz2018`: the papers' equations and numbers (config/), the latter without its "
        "volume bounds, which fit only its own scene."]
    document.commands = commands(bench, jobs)
    return document


def percent(share):
    return f"{100 * share:.1f} %"
