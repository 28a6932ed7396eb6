"""[D18] tables 1, 2, 4 and 5 with figures 11 and 12. Table 3 is in surface.py."""
import math

from . import plots, trajectories
from .bylow import commands
from .document import Document, number, ratio
from .figures import ATE_PROTOCOL, PART_NOTE, STAND_IN_NOTE, Run, used
from .jobs import Job
from .network import network_tables
from .papers import (D18_TABLE1, D18_TABLE1_RMSE_PERCENT_OF_WAY, D18_TABLE2, D18_TABLE2_SYSTEMS, D18_TABLE4,
                     D18_TABLE5, PUBLISHED_ELSEWHERE)
from .sources import frames, rows, run, synthetic

UNBOUNDED = ("--config", "diaz2018", "--set", "mapping.volume.bounded=false")
METHODS = {"diaz2018": UNBOUNDED, "icp": ("--tracker", "icp"), "icp-rgb": ("--tracker", "icp-rgb"), "sdf": ()}
METHODS_LINE = ("`diaz2018`: config/diaz2018.yaml, the paper's equations and 2.34 cm voxels, without the paper's "
                "volume bounds, which fit only its own scene. The others: our defaults (1 cm voxels) with this tracker; "
                "`sdf` is the default.")


def table1(bench):
    document = Document("[D18] Table 1, figures 11 and 12: camera pose accuracy, noise-free synthetic data")
    sequence = synthetic(bench, "desk")
    jobs = {label: run(bench, sequence, label, *options) for label, options in METHODS.items()}
    errors = {}
    for label, job in jobs.items():
        folder = bench.run(job)
        truth = trajectories.read(sequence.path + "/groundtruth.txt")
        errors[label] = trajectories.errors_from_first(truth, trajectories.read(folder / "trajectory.txt"))
    way_m = trajectories.path_length(truth)
    columns = {"Loc. [cm]": lambda row: 100 * row[1]}
    columns.update({f"Rot. {axis} [deg]": lambda row, k=k: row[2][k] for k, axis in enumerate("XYZ")})
    cells = []
    for index, (title, value) in enumerate(columns.items()):
        found = {label: trajectories.statistics_of([value(row) for row in errors[label]]) for label in errors}
        for name, printed in D18_TABLE1.items():
            comparable = name in ("RMSE", "Standard dev.")
            cells.append([title, name, number(printed[index])] + [number(found[label][name]) for label in errors]
                        + [ratio(found["diaz2018"][name], printed[index]) if comparable else "–",
                           ratio(found["sdf"][name], printed[index]) if comparable else "–"])
    shares = [number(100 * trajectories.rms([row[1] for row in e]) / way_m, 3) for e in errors.values()]
    cells.append(["Loc.", "RMSE, % of the path", number(D18_TABLE1_RMSE_PERCENT_OF_WAY, 2), *shares, "–", "–"])
    document.tables = [("", ["", "estimation", "[D18]", *(f"ours, {label}" for label in errors), "ratio, diaz2018",
                             "ratio, sdf"], cells)]
    document.notes = [f"Camera path: {way_m:.2f} m here, 7.27 m in the paper. Ratios between different scenes only "
                      "show whether the order of magnitude agrees.",
                      "We do not ship the paper's ray-traced desk; `synthetic:desk` is our own, without noise."]
    document.protocol = ["Both trajectories start at the same pose, without further alignment. Position: Euclidean "
                         "distance. Rotation: rotation vector of the error in camera axes.", METHODS_LINE]
    for file, label, value in [("d18-figure11.png", "position error [cm]", lambda row: 100 * row[1])] + [
            (f"d18-figure12{axis}.png", f"rotation error about {axis} [deg]", lambda row, k=k: row[2][k])
            for k, axis in enumerate("xyz")]:
        document.pictures += plots.curves(bench.out / file, "time [s]", label, [
            (method, [row[0] for row in e], [value(row) for row in e]) for method, e in errors.items()])
    document.commands = commands(bench, jobs.values())
    return document


def table2(bench):
    document = Document("[D18] Table 2: translation RMSE on TUM RGB-D")
    cells, jobs, names = [], [], []
    for name, sequence, printed in rows(bench, D18_TABLE2):
        wanted = [run(bench, sequence, label, *options) for label, options in METHODS.items()]
        wanted.append(run(bench, sequence, "sdf_loops", "--loop-closure", "on"))
        jobs += wanted
        names.append(name)
        runs = [Run(bench, job) for job in wanted]
        cells.append([name, used(sequence), *(number(p, 3) for p in printed or [None] * len(D18_TABLE2_SYSTEMS)),
                      *(r.ate_cell() for r in runs), ratio(runs[0].ate_m, printed and printed[0]),
                      ratio(runs[3].ate_m, printed and printed[0])])
    document.tables = [("ATE RMSE in metres. The ratios are relative to [D18].",
                        ["sequence", "measured on", *D18_TABLE2_SYSTEMS, *(f"ours, {m}" for m in METHODS),
                         "ours, sdf with loop closure", "ratio, diaz2018", "ratio, sdf"], cells)]
    document.notes = [STAND_IN_NOTE, PART_NOTE,
                      "Kintinuous, ElasticFusion, ORB-SLAM2 and RGBDTAM close loops or adjust globally.",
                      *(f"{name} is not in [D18]. {text}" for name, text in PUBLISHED_ELSEWHERE.items() if name in names)]
    document.protocol = [ATE_PROTOCOL, METHODS_LINE]
    document.commands = commands(bench, jobs)
    return document


def labels_job(bench, rule, *options):
    """The evaluation of a labelled run of the desk scene with the simulated detector."""
    sequence, name, score = synthetic(bench, "desk"), f"runs/desk_labels_{rule}", f"scores/labels_{rule}"
    labelled = Job(name, ("run", "synthetic:desk", *frames(bench), *bench.sample.camera, "--labels", "synthetic",
                          *options, "--out", str(bench.folder(name))), sequence.needs)
    return Job(score, ("eval", "labels", sequence.path, str(bench.folder(name)), "--json",
                       str(bench.folder(score) / "labels.json")), (labelled,))


def detector_table(caption, classes):
    """A detector's scores by category beside the paper's. `classes`: name -> pt, pc and probability in [0, 1]."""
    cells = []
    for category, printed in D18_TABLE4.items():
        ours = classes.get(category)
        for label, pt, pc, probability in printed:
            cells.append([label, number(pt, 1), number(pc, 1), number(probability, 1)] + (
                [number(100 * ours[key], 1) for key in ("pt", "pc", "probability")] if ours else ["–"] * 3))
    return (caption, ["object", "[D18] Pt [%]", "[D18] Pc [%]", "[D18] prob. [%]", "ours, Pt", "ours, Pc",
                      "ours, prob."], cells)


def table4(bench):
    document = Document("[D18] Table 4: object detection and labels")
    jobs = {rule: labels_job(bench, rule, *options)
            for rule, options in (("segment", ()), ("mean-depth", ("--set", "labels.region=mean-depth")))}
    scores = {rule: bench.read(job, "labels.json") for rule, job in jobs.items()}
    document.tables = [
        detector_table("The detector, by category (the paper: single objects). Ours is the simulated detector, set to "
                       "miss 10 % and to misclassify 3 %. Pt and Pc measure that, not a network.",
                       scores["segment"]["classes"]),
        ("The labels in the map; the paper gives no figures. mean-depth is the paper's rule for an object's pixels.",
         ["rule", "correct vertices", "of those on objects", "mean IoU", "objects found",
          "precision, recall at 3D IoU 0.25", "centroid error, mean [cm]"],
         [[rule, f"{100 * s['accuracy']:.2f} %", f"{100 * s['object_accuracy']:.1f} %", number(s["mean_iou"], 3),
           f"{s['found_objects']} of {len(s['instances'])}", f"{s['precision_25']:.2f}, {s['recall_25']:.2f}",
           number(100 * (s["centroid_error_mean_m"] or math.nan), 2)] for rule, s in scores.items()])]
    tables, made = network_tables(bench)
    document.tables += tables
    if not tables:
        document.notes.append("A network's rows need --labels MODEL (scripts/fetch_models.sh).")
    document.protocol = ["`tessera eval labels` against the scene's true classes and instances. Pt: share of "
                         "detections in the frames that show the object with over 400 pixels. Pc: share of correct "
                         "classes in those."]
    document.commands = commands(bench, [*jobs.values(), *made])
    return document


def table5(bench):
    document = Document("[D18] Table 5: processing time of the main modules")
    sequence = synthetic(bench, "desk")
    jobs = {label: run(bench, sequence, label, *METHODS[label]) for label in ("diaz2018", "icp", "sdf")}
    columns, busy = {}, 0.0
    for label, job in jobs.items():
        one, stages = Run(bench, job), bench.read(job, "timings.json")["stages"]
        busy = max(busy, one.busy_cores)
        mean = {name: stage["mean_ms"] for name, stage in stages.items()}
        columns[label] = {"Marching cubes": mean.get("mesh"), "Fusion": mean["fuse"] + mean["allocate"],
                          "Rasterization": mean.get("rasterise"),
                          "Tracking": mean["track"] + mean["prepare"], "TOTAL": mean["frame"]}
    cells = []
    for name, printed in D18_TABLE5.items():
        ours = [columns[label].get(name) for label in columns]
        cells.append([name, number(printed, 1), *(number(value, 1) for value in ours),
                     *(ratio(value, printed) if name != "Marching cubes" else "–" for value in ours)])
    document.tables = [("Means in ms.", ["process", "[D18]", *(f"ours, {m}" for m in columns),
                                         *(f"ratio, {m}" for m in columns)], cells)]
    document.notes = [
        "[D18] used a GeForce 960M; ours runs on the CPU.",
        "Ours: tracking includes preparing the frame and the predicted view (rasterised with incremental meshing "
        "for `diaz2018`, ray cast for `icp`, none for `sdf`). Rasterization is a part of it: uploading, drawing and "
        "reading back. Marching cubes is the whole mesh once, after the last frame, so there is no ratio. TOTAL is from "
        "the completion of one frame to the next, including decoding. Stages overlap."]
    if busy > 0.2:
        document.notes.append(f"The machine was busy with other work during these measurements (up to {busy:.1f} cores "
                              "in use just before a run), so they are upper bounds. docs/benchmarks/README.md has "
                              "times from a quiet machine.")
    document.protocol = ["noise-free `synthetic:desk`, 640 x 480, every frame, lockstep, all cores.", METHODS_LINE]
    document.commands = commands(bench, jobs.values())
    return document
