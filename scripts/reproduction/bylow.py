"""[B14] table I, figures 6 and 7, and scenes without structure or texture with all trackers."""
import math

from . import plots
from .document import Document, number, ratio
from .figures import ATE_PROTOCOL, STAND_IN_NOTE, Run, used
from .jobs import Job, with_needs
from .papers import ALPHAS, B14_TABLE1
from .sources import find, frames, others, run

QUICK_ALPHAS = [0.0, 0.1, 1.0]
SETTINGS = {"bylow2014": ("--config", "bylow2014"), "default": ()}


def alphas(bench):
    return QUICK_ALPHAS if bench.quick else ALPHAS


def table1_rows(bench):
    """(name in the paper or folder name, sequence, the paper's figures or None) for each available sequence."""
    rows = [(name, find(bench, name), values) for name, values in B14_TABLE1.items()]
    rows = [row for row in rows if row[1]] + [(extra.name, extra, None) for extra in others(bench)]
    return [row for row in rows if not bench.only or row[1].name in bench.only]


def alpha_job(bench, sequence, setting, alpha):
    options = (*SETTINGS[setting], "--tracker", "sdf", "--alpha", str(alpha))
    return run(bench, sequence, f"{setting}_alpha_{alpha}", *options)


def settings(bench):
    """Both settings, or the one chosen by --preset. The paper's settings take four times as long per frame."""
    return [bench.preset] if bench.preset else list(SETTINGS)


def table1_jobs(bench):
    jobs = []
    for _, sequence, _ in table1_rows(bench):
        for setting in settings(bench):
            jobs += [alpha_job(bench, sequence, setting, alpha) for alpha in alphas(bench)]
        jobs.append(alpha_job(bench, sequence, "default", "auto"))
    return jobs


def table1(bench):
    document = Document("[B14] Table I: ATE against the photometric weight alpha", "ATE RMSE in metres. The paper's "
                        "best and worst alpha are over its eleven values; \"auto\" is our default, with no fixed alpha.")
    document.notes = [STAND_IN_NOTE, ATE_PROTOCOL]
    summary, curves, detail = [], [], []
    for name, sequence, paper in table1_rows(bench):
        auto = Run(bench, alpha_job(bench, sequence, "default", "auto"))
        best_paper = min(paper) if paper else None
        for setting in settings(bench):
            runs = [Run(bench, alpha_job(bench, sequence, setting, alpha)) for alpha in alphas(bench)]
            whole = [r.ate_m for r in runs if r.tracked > 0.95]
            best, worst = (min(whole), max(whole)) if whole else (None, None)
            summary.append([name, used(sequence), setting, number(best_paper, 3), number(best), ratio(best, best_paper),
                            number(worst), auto.ate_cell(), ratio(auto.ate_m, best)])
            detail.append([name, setting, *(r.ate_cell() for r in runs)])
            curves.append((f"{sequence.name}, {setting}", alphas(bench), [r.ate_m for r in runs]))
        if paper:
            printed = [number(paper[ALPHAS.index(a)], 3) for a in alphas(bench)]
            detail.append([name, "the paper, on its own sequence", *printed])
    document.tables = [
        ("Best alpha of each sequence. Best and worst include only runs that tracked over 95 % of the frames.",
         ["sequence", "measured on", "settings", "[B14] best", "ours, best alpha", "ratio", "ours, worst alpha",
          "ours, auto", "auto / best"], summary),
        ("All values.", ["sequence", "settings", *(f"α = {a}" for a in alphas(bench))], detail)]
    missing = [name for name in B14_TABLE1 if name not in {row[0] for row in table1_rows(bench)}]
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
METHODS = [("sdf, alpha auto", ("--tracker", "sdf", "--alpha", "auto")),
           *((f"sdf, alpha {a}", ("--tracker", "sdf", "--alpha", str(a))) for a in (0.01, 0.03, 0.1, 0.3, 1.0)),
           ("sdf-geometric", ("--tracker", "sdf-geometric")),
           ("icp", ("--tracker", "icp")),
           ("icp-rgb", ("--tracker", "icp-rgb"))]


def low_structure(bench):
    document = Document("Scenes without structure, without texture, or without both",
                        "ATE RMSE in metres. In brackets, if any: the share of frames tracked and the number of "
                        "degenerate frames (some motion has a standard deviation above half a voxel).")
    rows, jobs = [], []
    sequences = [(name, find(bench, name)) for name in LOW_STRUCTURE]
    auto_m, best_m = {}, {}
    for label, options in METHODS:
        row = [label]
        for name, sequence in sequences:
            jobs.append(run(bench, sequence, label.replace(", ", "_").replace(" ", "_"), *options))
            one = Run(bench, jobs[-1])
            held = f", {one.degenerate} of {one.frames} degenerate" if one.degenerate else ""
            row.append(one.ate_cell() + held)
            if label == "sdf, alpha auto":
                auto_m[name] = one.ate_m
            elif label.startswith("sdf, alpha") and one.ate_m < best_m.get(name, math.inf):
                best_m[name] = one.ate_m
        rows.append(row)
    header = ["method", *(name.removeprefix("fr3 ").replace("_", " ") for name, _ in sequences)]
    rows.insert(0, ["measured on", *(used(sequence) for _, sequence in sequences)])
    rows.insert(1, ["[B14], best alpha", "–", *(number(min(B14_TABLE1[name]), 3) for name, _ in sequences[1:])])
    rows.insert(2, ["[B14], alpha 0", "–", *(number(B14_TABLE1[name][0], 3) for name, _ in sequences[1:])])
    rows.append(["sdf, alpha auto / best fixed alpha", *(ratio(auto_m[name], best_m.get(name)) for name in auto_m)])
    document.tables = [("", header, rows)]
    document.notes = [STAND_IN_NOTE, "Without structure and texture no method can estimate the pose: the right result "
                      "is to report this and fuse nothing. The ATE there does not rank the methods."]
    document.protocol = [ATE_PROTOCOL, "Default settings except for the method and alpha; 1 cm voxels."]
    document.commands = commands(bench, jobs)
    return document


def figures(bench):
    document = Document("[B14] figures 6 and 7: a corridor, and a floor with and without colour")
    rows, jobs = [], []
    for scene, figure, options in (("corridor", 6, ("--stride", "4")), ("floor", 7, ())):
        for method in ("sdf", "sdf-geometric"):
            name = f"runs/{scene}_{method}"
            jobs.append(Job(name, ("run", f"synthetic:{scene}", *options, *frames(bench), "--tracker", method, "--out",
                                   str(bench.folder(name)))))
            one = Run(bench, jobs[-1])
            rows.append([figure, scene, "colour and depth" if method == "sdf" else "depth only", one.ate_cell(),
                         f"{one.json['counts']['lost']}", f"{one.degenerate} of {one.frames}"])
            jobs.append(picture(bench, jobs[-1], scene, method))
            bench.run(jobs[-1])
            file = f"b14-figure{figure}-{scene}-{method}.png"
            (bench.out / file).write_bytes((bench.folder(jobs[-1].name) / "picture.png").read_bytes())
            document.pictures.append((file, f"Figure {figure}: {scene}, {rows[-1][2]}"))
    header = ["figure", "scene", "tracked with", "ATE [m]", "frames lost", "degenerate"]
    document.tables = [("", header, rows)]
    document.notes = ["The paper's recordings are not public. We use built-in scenes with exact ground truth instead "
                      "(a corridor of 40 m, a patterned floor). The paper gives only pictures for these, no figures."]
    document.protocol = [ATE_PROTOCOL, "Corridor: every 4th frame, which is four times walking speed."]
    document.commands = commands(bench, jobs)
    return document


def picture(bench, job, scene, method):
    """The job that renders the mesh with the camera path."""
    name, folder = f"pictures/{scene}_{method}", bench.folder(job.name)
    return Job(name, ("render", str(folder / "mesh.ply"), "--trajectory", str(folder / "trajectory.txt"), "--out",
                      str(bench.folder(name) / "picture.png")), (job,))
