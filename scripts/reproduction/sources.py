"""Sequences by their names in the papers: TUM RGB-D folders if --tum has them, else made by `tessera synth`."""
import dataclasses

from .jobs import Job
from .papers import FOLDERS

QUICK_FRAMES = 40


@dataclasses.dataclass(frozen=True)
class Sequence:
    """`kind` describes the data in a table cell; `options` select frames; `needs` has the job that makes a synthetic
    sequence."""
    name: str
    path: str
    kind: str
    options: tuple = ()
    needs: tuple = ()


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
    job = Job(f"data/{scene}_{noise}", (*arguments, *frames(bench)))
    return Sequence(f"{scene}_{noise}", str(folder / "sequence"), f"synthetic:{scene}, noise {noise}", needs=(job,))


def frames(bench):
    return ("--frames", str(QUICK_FRAMES)) if bench.quick else ()


def find(bench, name):
    """The sequence for a row of a paper: from TUM, else its stand-in, else None."""
    for folder in FOLDERS.get(name, []):
        if bench.tum and (bench.tum / folder).is_dir():
            return Sequence(folder, str(bench.tum / folder), folder, frames(bench))
    if name not in STAND_INS:
        return None
    scene, noise, options = STAND_INS[name]
    made = synthetic(bench, scene, noise)
    every = f", every {options[1]}rd frame" if options else ""
    return dataclasses.replace(made, name=made.name + "_".join(options).replace("--stride_", "_every"),
                               kind=made.kind + every, options=options)


def recorded(bench):
    """Every folder in --tum with colour, depth and ground truth."""
    if not bench.tum:
        return []
    return [Sequence(path.name, str(path), path.name, frames(bench)) for path in sorted(bench.tum.iterdir())
            if all((path / file).is_file() for file in ("rgb.txt", "depth.txt", "groundtruth.txt"))]


def others(bench):
    """Recorded sequences that are not in a paper: rows without a figure from a paper."""
    known = {folder for folders in FOLDERS.values() for folder in folders}
    return [sequence for sequence in recorded(bench) if sequence.name not in known]


def run(bench, sequence, label, *options):
    """The job that runs `tessera run` on a sequence. `label` identifies its settings."""
    name = f"runs/{sequence.name}/{label}"
    return Job(name, ("run", sequence.path, *sequence.options, *options, "--out", str(bench.folder(name))),
               sequence.needs)
