"""The papers' pictures of reconstructions: [B14] figures 6 to 8, [D18] figures 7, 8, 10, 13 and 17."""
import dataclasses
import pathlib
import shutil

from .bylow import commands
from .diaz import labels_job
from .document import Document
from .figures import ATE_PROTOCOL, PART_NOTE, Run
from .jobs import Job
from .sources import find, frames, run

SIZE = ("--width", "640", "--height", "480")
# [B14] figure, built-in scene, tracker, options.
WALKS = [("6, 8", "corridor", "sdf", ("--stride", "4")), ("7", "floor", "sdf", ()), ("7", "floor", "sdf-geometric", ())]
CORRIDOR_POSE = 220  # a third of the way
DESK_POSE = 60       # this one sees the whole desk


def render(bench, run_job, file, *options):
    """The job that renders a run's mesh to a JPEG. `file`: its name beside the document."""
    folder, name = bench.folder(run_job.name), f"pictures/{pathlib.Path(file).stem}"
    return Job(name, ("render", str(folder / "mesh.ply"), *options, "--out", str(bench.folder(name) / file)), (run_job,))


def from_pose(bench, run_job, pose):
    """Options for the view of one of the run's cameras."""
    last = Run(bench, run_job).frames - 1
    return ("--trajectory", str(bench.folder(run_job.name) / "trajectory.txt"), "--pose", str(min(pose, last)), *SIZE)


def add(bench, document, job, caption):
    """Runs a job of `render` and adds its picture to the document. Returns the job."""
    source = pathlib.Path(job.arguments[-1])
    bench.run(job)
    shutil.copyfile(source, bench.out / source.name)
    document.pictures.append((source.name, caption))
    return job


def b14_figures(bench):
    document = Document("[B14] figures 6 to 8: a corridor, and a floor with and without colour")
    cells, jobs = [], []
    for figure, scene, method, options in WALKS:
        name = f"runs/{scene}_{method}"
        walk = Job(name, ("run", f"synthetic:{scene}", *options, *frames(bench), *bench.sample.camera, "--tracker", method,
                          "--out", str(bench.folder(name))))
        one, used = Run(bench, walk), "colour and depth" if method == "sdf" else "depth only"
        cells.append([figure, scene, used, one.ate_cell(), one.json["counts"]["lost"],
                      f"{one.degenerate} of {one.frames}"])
        path = ("--trajectory", str(bench.folder(name) / "trajectory.txt"), "--width", "800", "--height", "600")
        jobs += [walk, add(bench, document, render(bench, walk, f"b14-figure{figure[0]}-{scene}-{method}.jpg", *path),
                           f"Figure {figure[0]}: {scene}, {used}")]
        if scene == "corridor":
            zoom = render(bench, walk, "b14-figure8-corridor.jpg", *from_pose(bench, walk, CORRIDOR_POSE))
            jobs.append(add(bench, document, zoom, "Figure 8: inside the reconstructed corridor"))
    document.tables = [("", ["figure", "scene", "tracked with", "ATE [m]", "frames lost", "degenerate"], cells)]
    document.notes = ["The paper's recordings are not public. We use built-in scenes with exact ground truth instead "
                      "(a corridor of 40 m, a patterned floor). The paper gives only pictures for these, no figures."]
    document.protocol = [ATE_PROTOCOL, "Corridor: every 4th frame, which is four times walking speed."]
    document.commands = commands(bench, jobs)
    return document


def d18_figures(bench):
    document = Document("[D18] figures 7, 8, 10, 13 and 17: detections, and reconstructions by object")
    desk = labels_job(bench, "segment").needs[0]
    cells = [described(bench, "7, 8, 10", "synthetic:desk, no noise", desk)]
    frame = min(DESK_POSE, Run(bench, desk).frames - 1)
    seen = Job("pictures/d18-figure7", ("inspect", "synthetic:desk", *bench.sample.camera, "--labels", "synthetic", "--frame",
                                        str(frame), "--out", str(bench.folder("pictures/d18-figure7") / "d18-figure7.jpg")))
    jobs = [desk, add(bench, document, seen, "Figures 7 (first row) and 8 (right column): the detections, the object image "
                      "made of them, and the one predicted from the map")]
    view = from_pose(bench, desk, DESK_POSE)
    jobs += both_shadings(bench, document, desk, view, "d18-figure10", "Figure 10: the rendered desk")
    real = recorded_desk(bench)
    if real:
        scanned = run(bench, real, "sdf")
        if bench.network:
            labelled = run(bench, real, "network", "--labels", bench.network)
            scanned = dataclasses.replace(labelled, inputs=(bench.network,))
        cells.append(described(bench, "13, 17", real.kind, scanned))
        view, jobs = from_pose(bench, scanned, 0), [*jobs, scanned]
        if bench.network:
            jobs += both_shadings(bench, document, scanned, view, "d18-figure17", "Figures 13 and 17: the real desk")
        else:
            picture = render(bench, scanned, "d18-figure13.jpg", *view)
            jobs.append(add(bench, document, picture, "Figure 13: the real desk, the scene's colours"))
    document.tables = [("", ["figure", "measured on", "ATE [m]", "objects in the map"], cells)]
    document.notes = [PART_NOTE] + ([] if real else ["Figures 13 and 17 need fr1 desk or fr1 xyz (the same desk) in "
                                                     "--tum."])
    if real and not bench.network:
        document.notes.append("Figure 17 needs a network: --labels MODEL (scripts/fetch_models.sh).")
    document.protocol = [ATE_PROTOCOL, "Figure 10: the simulated detector. Figure 17: the network of --labels. The view is "
                         "that of one of the run's own cameras."]
    document.commands = commands(bench, jobs)
    return document


def both_shadings(bench, document, run_job, view, stem, caption):
    """Pictures with the scene's colours and by object. Returns their jobs."""
    return [add(bench, document, render(bench, run_job, f"{stem}{letter}.jpg", *view, "--shading", shading),
                f"{caption}, ({letter}) {what}")
            for letter, shading, what in (("a", "colour", "the scene's colours"), ("b", "label", "by object"))]


def described(bench, figure, kind, job):
    return [figure, kind, Run(bench, job).ate_cell(), len(bench.read(job, "objects.json"))]


def recorded_desk(bench):
    """The recording of TUM's desk in --tum, or None."""
    found = [find(bench, name) for name in ("fr1 desk", "fr1 xyz")]
    return next((sequence for sequence in found if sequence.recording), None)
