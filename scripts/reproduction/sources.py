"""Sequences by their names in the papers: recordings in --tum if they are there, else made by `tessera synth`."""
import dataclasses
import functools
import re
import statistics

from .jobs import Job
from .papers import FOLDERS

TUM_FPS = 30
FEWEST_IMAGES = 30       # shorter folders are samples for tests
CUT_SHARE = 0.1          # the truth continues for this share of its length after the last image: the recording was cut


@dataclasses.dataclass(frozen=True)
class Sequence:
    """`name` is unique (the folder's); `kind` describes the data in a table cell; `options` select frames; `needs` has
    the job that makes a synthetic sequence; `recording` is the original name, and `part` what of it is here."""
    name: str
    path: str
    kind: str
    options: tuple = ()
    needs: tuple = ()
    recording: str = ""
    part: str = ""


# Name in the paper -> built-in scene, noise, options of `tessera run`.
STAND_INS = {
    "fr1 desk": ("desk", "kinect", ()),
    "fr1 desk2": ("desk", "kinect", ("--stride", "3")),
    "fr1 xyz": ("corner", "kinect", ()),
    "fr1 room": ("room", "kinect", ("--stride", "3")),
    "fr3 structure_texture": ("desk", "kinect", ()),
    "fr3 structure_no_texture": ("corner", "kinect", ()),
    "fr3 no_structure_texture": ("floor", "kinect", ()),
    "fr3 no_structure_no_texture": ("wall", "kinect", ()),
}


def synthetic(bench, scene, noise="none"):
    """The sequence of a built-in scene; its `needs` is the job that writes it."""
    folder = bench.folder(f"data/{scene}_{noise}")
    arguments = ["synth", scene, "--noise", noise, "--out", str(folder / "sequence")]
    job = Job(f"data/{scene}_{noise}", (*arguments, *frames(bench), *bench.sample.camera))
    return Sequence(f"{scene}_{noise}", str(folder / "sequence"), f"synthetic:{scene}, noise {noise}", needs=(job,))


def frames(bench):
    return ("--frames", str(bench.sample.frames)) if bench.sample.frames else ()


def recorded(bench):
    """Every folder in --tum with colour, depth and ground truth, under the name of the recording that rgb.txt states."""
    if not bench.tum:
        return []
    found = []
    for path in sorted(bench.tum.iterdir()):
        if all((path / file).is_file() for file in ("rgb.txt", "depth.txt", "groundtruth.txt")):
            name, part, images = described(path)
            if images >= FEWEST_IMAGES:
                kind = f"{name}, {part}" if part else name
                found.append(Sequence(path.name, str(path), kind, frames(bench), recording=name, part=part))
    return found


@functools.lru_cache(maxsize=None)
def described(path):
    """(name of the recording, which part of it is here or "", number of colour images) of a folder in TUM's layout."""
    header = path.joinpath("rgb.txt").read_text(encoding="utf-8").split("\n", 2)[:2]
    stated = re.search(r"rgbd_dataset_freiburg\w+?(?=\.bag)", "\n".join(header))
    name = path.name if path.name.startswith("rgbd_dataset_") or not stated else stated[0]
    colour_s, truth_s = stamps(path / "rgb.txt"), stamps(path / "groundtruth.txt")
    return name, part_of_recording(colour_s, truth_s) if name.startswith("rgbd_dataset_") else "", len(colour_s)


def part_of_recording(colour_s, truth_s):
    """TUM's camera has 30 Hz, and its ground truth covers the whole recording."""
    if len(colour_s) < 2 or not truth_s:
        return ""
    stride = round(TUM_FPS * statistics.median(b - a for a, b in zip(colour_s, colour_s[1:])))
    parts = [f"every {ordinal(stride)} frame"] if stride > 1 else []
    if truth_s[-1] - colour_s[-1] > CUT_SHARE * (truth_s[-1] - truth_s[0]):
        parts.append(f"first {len(colour_s)} frames")
    return ", ".join(parts)


def stamps(path):
    """The first number of each line in seconds. Raises ValueError with the file and line."""
    found = []
    for row, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        if line.strip() and not line.startswith("#"):
            try:
                found.append(float(line.replace(",", " ").split()[0]))
            except ValueError:
                raise ValueError(f"{path}:{row}: the line must begin with a time stamp in seconds") from None
    return found


def ordinal(number):
    return str(number) + {2: "nd", 3: "rd"}.get(number, "th")


def find(bench, name):
    """The sequence for a row of a paper: a recording in --tum, complete if possible, else its stand-in, else None."""
    for folder in FOLDERS.get(name, []):
        copies = [sequence for sequence in recorded(bench) if sequence.recording == folder]
        if copies:
            return min(copies, key=lambda sequence: sequence.part != "")
    if name not in STAND_INS:
        return None
    scene, noise, options = STAND_INS[name]
    made = synthetic(bench, scene, noise)
    every = f", every {ordinal(int(options[1]))} frame" if options else ""
    return dataclasses.replace(made, name=made.name + "_".join(options).replace("--stride_", "_every"),
                               kind=made.kind + every, options=options)


def rows(bench, printed):
    """(row name, sequence, the paper's figures or None): the sequences of a paper's table that can be had, then all
    other recordings. `printed`: name in the paper -> figures. Only those of --only, if given."""
    found = [(name, find(bench, name), figures) for name, figures in printed.items()]
    found = [row for row in found if row[1]]
    taken = {sequence.path for _, sequence, _ in found}
    found += [(short(one), one, None) for one in recorded(bench) if one.path not in taken]
    return [row for row in found if wanted(bench, row[1])]


def wanted(bench, sequence):
    return not bench.only or sequence.name in bench.only


def short(sequence):
    """rgbd_dataset_freiburg1_rpy is fr1 rpy, as in the papers; other recordings keep their folder's name."""
    return re.sub(r"^rgbd_dataset_freiburg(\d)_", r"fr\1 ", sequence.recording)


def run(bench, sequence, label, *options):
    """The job that runs `tessera run` on a sequence, as the papers do without loop closure unless an option says
    otherwise. `label` identifies its settings."""
    name = f"runs/{sequence.name}/{label}"
    loops = () if "--loop-closure" in options else ("--loop-closure", "off")
    return Job(name, ("run", sequence.path, *sequence.options, *options, *loops, "--out", str(bench.folder(name))),
               sequence.needs)
