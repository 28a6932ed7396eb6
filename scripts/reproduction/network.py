"""[D18] Table 4 with a real network: --labels MODEL on rendered sequences that know every object."""
from .document import number
from .jobs import Job
from .sources import recorded, synthetic

ALIASES = "tv=computer tvmonitor=computer monitor=computer"
RARE = 0.01  # detections down to this probability count for AP50


def sequences(bench):
    """The rendered desk, and the recordings in --tum that name every pixel's object."""
    named = [s for s in recorded(bench) if (bench.tum / s.name / "objects.json").is_file()]
    return [synthetic(bench, "desk", "kinect"), *named]


def jobs(bench, sequence):
    """Scores of every detection, of those above 0.5, and of the labels that the latter leave in the map."""
    network, base = ("--labels", bench.network), f"network/{sequence.name}"
    seen = Job(f"{base}/all", ("run", sequence.path, *sequence.options, *network, "--set", "labels.classes=all", "--set",
                               f"labels.min_probability={RARE}", "--set", f"labels.aliases={ALIASES}", "--out",
                               str(bench.folder(f"{base}/all"))), sequence.needs, (bench.network,))
    labelled = Job(f"{base}/labelled", ("run", sequence.path, *sequence.options, "--config", "labels", *network, "--out",
                                        str(bench.folder(f"{base}/labelled"))), sequence.needs, (bench.network,))
    scored = score(bench, f"{base}/detections", "detections", sequence, seen, "--min-probability", "0.5")
    voted = score(bench, f"{base}/labels", "labels", sequence, labelled)
    return scored, voted


def score(bench, name, what, sequence, needed, *options):
    return Job(name, ("eval", what, sequence.path, str(bench.folder(needed.name)), *options, "--json",
                      str(bench.folder(name) / "scores.json")), (needed,))


def network_tables(bench):
    """Tables and jobs; none without --labels."""
    if not bench.network:
        return [], []
    classes, objects, votes, made = [], [], [], []
    for sequence in sequences(bench):
        scored, voted = jobs(bench, sequence)
        made += [scored, voted]
        found, labels = bench.read(scored, "scores.json"), bench.read(voted, "scores.json")
        for name, row in [*sorted(found["classes"].items()), ("all", found["all"])]:
            if row["visible"]:
                classes.append([sequence.name, name, row["visible"], number(row["ap50"], 3), number(row["precision"], 2),
                                number(row["recall"], 2)])
        objects += [[sequence.name, o["class"], o["visible"], number(100 * o["pt"], 1), number(100 * o["pc"], 1),
                     number(100 * o["probability"], 1)] for o in found["objects"]]
        votes.append([sequence.name, f"{100 * labels['accuracy']:.1f} %", f"{100 * labels['object_accuracy']:.1f} %",
                      number(labels["mean_iou"], 3), f"{labels['found_objects']} of {len(labels['instances'])}",
                      f"{labels['precision_25']:.2f}, {labels['recall_25']:.2f}"])
    return [
        ("A network, by class: box IoU 0.5; precision and recall of detections above 0.5, AP50 of all.",
         ["sequence", "class", "visible", "AP50", "precision", "recall"], classes),
        ("The same network by object, in the form of the paper's table.",
         ["sequence", "class", "visible", "Pt [%]", "Pc [%]", "prob. [%]"], objects),
        ("What voting makes of its detections above 0.5 (`--config labels`).",
         ["sequence", "correct vertices", "of those on objects", "mean IoU", "objects found",
          "precision, recall at 3D IoU 0.25"], votes)], made
