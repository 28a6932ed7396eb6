"""[B14] table I, and scenes without structure or texture with all trackers."""
import math

from . import plots
from .document import Document, number, ratio
from .figures import ATE_PROTOCOL, STAND_IN_NOTE, Run, used
from .jobs import with_needs
from .papers import ALPHAS, B14_TABLE1
from .sources import find, rows, run, wanted

SETTINGS = {"bylow2014": ("--config", "bylow2014"), "default": ()}


def alpha_job(bench, sequence, setting, alpha):
    options = (*SETTINGS[setting], "--tracker", "sdf", "--alpha", str(alpha))
    return run(bench, sequence, f"{setting}_alpha_{alpha}", *options)


def settings(bench):
    """Both settings, or the one chosen by --preset. The paper's settings take four times as long per frame."""
    return [bench.preset] if bench.preset else list(SETTINGS)


def table1_jobs(bench):
    jobs = []
    for _, sequence, _ in rows(bench, B14_TABLE1):
        for setting in settings(bench):
            jobs += [alpha_job(bench, sequence, setting, alpha) for alpha in bench.sample.alphas]
        jobs.append(alpha_job(bench, sequence, "default", "auto"))
    return jobs


def table1(bench):
    document = Document("[B14] Table I: ATE against the photometric weight alpha", "ATE RMSE in metres. The paper's "
                        "best and worst alpha are over its eleven values; \"auto\" is our default, with no fixed alpha.")
    document.notes = [STAND_IN_NOTE, ATE_PROTOCOL]
    summary, curves, detail = [], [], []
    for name, sequence, paper in rows(bench, B14_TABLE1):
        auto = Run(bench, alpha_job(bench, sequence, "default", "auto"))
        best_paper = min(paper) if paper else None
        for setting in settings(bench):
            runs = [Run(bench, alpha_job(bench, sequence, setting, alpha)) for alpha in bench.sample.alphas]
            whole = [r.ate_m for r in runs if r.tracked > 0.95]
            best, worst = (min(whole), max(whole)) if whole else (None, None)
            summary.append([name, used(sequence), setting, number(best_paper, 3), number(best), ratio(best, best_paper),
                            number(worst), auto.ate_cell(), ratio(auto.ate_m, best)])
            detail.append([name, setting, *(r.ate_cell() for r in runs)])
            curves.append((f"{sequence.name}, {setting}", bench.sample.alphas, [r.ate_m for r in runs]))
        if paper:
            printed = [number(paper[ALPHAS.index(a)], 3) for a in bench.sample.alphas]
            detail.append([name, "the paper, on its own sequence", *printed])
    document.tables = [
        ("Best alpha of each sequence. Best and worst include only runs that tracked over 95 % of the frames.",
         ["sequence", "measured on", "settings", "[B14] best", "ours, best alpha", "ratio", "ours, worst alpha",
          "ours, auto", "auto / best"], summary),
        ("All values.", ["sequence", "settings", *(f"α = {a}" for a in bench.sample.alphas)], detail)]
    missing = [name for name in B14_TABLE1 if name not in {row[0] for row in rows(bench, B14_TABLE1)}]
    if missing:
        document.notes.append("Not measured here: " + ", ".join(missing) + ".")
    document.protocol = [
        "`--tracker sdf --alpha A` on every frame. Settings `bylow2014`: config/bylow2014.yaml, the paper's equations; "
        "`default`: our defaults, with our own lens, shutter, brightness and robust weights; alpha has the same unit "
        " (m² per squared intensity in [0, 1]).",
        "`fr3` sequences come as near and far. The paper does not say which was used; we use near if both are present."]
    document.pictures = plots.curves(bench.out / "b14-table1.png", "alpha", "ATE RMSE [m]", curves, log=True)
    document.commands = commands(bench, table1_jobs(bench))
    return document


def commands(bench, jobs):
    return [bench.shown(job) for job in with_needs(jobs)]


LOW_STRUCTURE = ["fr3 structure_texture", "fr3 structure_no_texture", "fr3 no_structure_texture",
                 "fr3 no_structure_no_texture"]
FIXED_ALPHAS = (0.01, 0.03, 0.1, 0.3, 1.0)


def low_structure_job(bench, sequence, method):
    """`method`: a tracker, or "sdf, alpha A"."""
    tracker, _, alpha = method.partition(", alpha ")
    if alpha:
        return alpha_job(bench, sequence, "default", alpha)
    return run(bench, sequence, tracker, "--tracker", tracker)


def low_structure(bench):
    document = Document("Scenes without structure, without texture, or without both",
                        "ATE RMSE in metres. In brackets, if any: the share of frames tracked and the number of "
                        "degenerate frames (some motion has a standard deviation above half a voxel).")
    cells, jobs = [], []
    sequences = [(name, find(bench, name)) for name in LOW_STRUCTURE]
    sequences = [(name, sequence) for name, sequence in sequences if wanted(bench, sequence)]
    auto_m, best_m = {}, {}
    # A short sample has only the fixed alphas that its other tables have.
    fixed = [a for a in FIXED_ALPHAS if not bench.sample.frames or a in bench.sample.alphas]
    for label in (*(f"sdf, alpha {a}" for a in ("auto", *fixed)), "sdf-geometric", "icp", "icp-rgb"):
        row = [label]
        for name, sequence in sequences:
            jobs.append(low_structure_job(bench, sequence, label))
            one = Run(bench, jobs[-1])
            held = f", {one.degenerate} of {one.frames} degenerate" if one.degenerate else ""
            row.append(one.ate_cell() + held)
            if label == "sdf, alpha auto":
                auto_m[name] = one.ate_m
            elif label.startswith("sdf, alpha") and one.ate_m < best_m.get(name, math.inf):
                best_m[name] = one.ate_m
        cells.append(row)
    header = ["method", *(name.removeprefix("fr3 ").replace("_", " ") for name, _ in sequences)]
    cells.insert(0, ["measured on", *(used(sequence) for _, sequence in sequences)])
    printed = [B14_TABLE1.get(name, [None]) for name, _ in sequences]
    cells.insert(1, ["[B14], best alpha", *(number(min(values), 3) for values in printed)])
    cells.insert(2, ["[B14], alpha 0", *(number(values[0], 3) for values in printed)])
    cells.append(["sdf, alpha auto / best fixed alpha", *(ratio(auto_m[name], best_m.get(name)) for name in auto_m)])
    document.tables = [("", header, cells)]
    document.notes = [STAND_IN_NOTE, "Without structure and texture no method can estimate the pose: the right result "
                      "is to report this and fuse nothing. The ATE there does not rank the methods."]
    document.protocol = [ATE_PROTOCOL, "Default settings except for the method and alpha; 1 cm voxels."]
    document.commands = commands(bench, jobs)
    return document
