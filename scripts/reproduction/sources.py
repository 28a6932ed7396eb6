"""Sequences by the papers' names: TUM RGB-D folders where --tum has them, else ones made by `tessera synth`."""
import dataclasses

from .jobs import Job
from .papers import FOLDERS

QUICK_FRAMES = 40


@dataclasses.dataclass(frozen=True)
class Sequence:
    """`kind` says in a table's cell what it is; `options` select frames; `needs` makes it, if it is
    one of ours."""
    name: str
    path: str
    kind: str
    options: tuple = ()
    needs: tuple = ()


# The paper's name -> built-in scene, noise, options of `tessera run`.
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
    """The job that writes a built-in scene's sequence, and the sequence."""
    folder = bench.folder(f"data/{scene}_{noise}")
    arguments = ["synth", scene, "--noise", noise, "--out", str(folder / "sequence")]
    job = Job(f"data/{scene}_{noise}", (*arguments, *frames(bench)))
    return Sequence(f"{scene}_{noise}", str(folder / "sequence"), f"synthetic:{scene}, noise {noise}", needs=(job,))


def frames(bench):
    return ("--frames", str(QUICK_FRAMES)) if bench.quick else ()


def find(bench, name):
    """The sequence of a paper's row: TUM's, else its stand-in, else None."""
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
    """Every folder of --tum with colour, depth and truth."""
    if not bench.tum:
        return []
    return [Sequence(path.name, str(path), path.name, frames(bench)) for path in sorted(bench.tum.iterdir())
            if all((path / file).is_file() for file in ("rgb.txt", "depth.txt", "groundtruth.txt"))]


def others(bench):
    """Those that are no sequence of a paper: rows without a paper's figure."""
    known = {folder for folders in FOLDERS.values() for folder in folders}
    return [sequence for sequence in recorded(bench) if sequence.name not in known]


def run(bench, sequence, label, *options):
    """The job `tessera run` of a sequence; `label` tells its settings apart."""
    name = f"runs/{sequence.name}/{label}"
    return Job(name, ("run", sequence.path, *sequence.options, *options, "--out", str(bench.folder(name))),
               sequence.needs)
