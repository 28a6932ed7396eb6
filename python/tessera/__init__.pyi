"""What `tessera` offers, typed. All arrays are NumPy's; poses are 4 x 4 matrices T_world_camera, metres."""
import os
from typing import Dict, Iterator, List, Mapping, Optional, Tuple, Union

import numpy as np
from numpy.typing import NDArray

Path = Union[str, "os.PathLike[str]"]
Settings = Mapping[str, Union[str, bool, int, float]]

__version__: str

class Camera:
    """An ideal pinhole in pixels; pixel (0, 0) is the centre of the top-left pixel. ValueError for values that no depth
    camera has. Images handed to a Scanner are undistorted, and colour and depth are in register."""

    def __init__(self, width: int, height: int, fx: float, fy: float, cx: float, cy: float) -> None: ...
    @property
    def width(self) -> int: ...
    @property
    def height(self) -> int: ...
    @property
    def fx(self) -> float: ...
    @property
    def fy(self) -> float: ...
    @property
    def cx(self) -> float: ...
    @property
    def cy(self) -> float: ...

class FrameResult:
    """What became of one frame."""

    @property
    def index(self) -> int:
        """Counted from 0 in the order of the calls."""
    @property
    def stamp_s(self) -> float: ...
    @property
    def tracked(self) -> bool:
        """There is a pose."""
    @property
    def fused(self) -> bool:
        """The frame is in the map; one that tracked badly is not."""
    @property
    def T_world_camera(self) -> Optional[NDArray[np.float64]]:
        """(4, 4). The world is the first frame's camera. None where the camera is lost."""
    @property
    def status(self) -> str:
        """"good", "poor" (tracked, not fused) or "lost"."""
    @property
    def reason(self) -> str:
        """Why it is not good; else empty."""
    @property
    def inlier_fraction(self) -> float:
        """Of the points that lie where the map is known, those that fit it, 0 to 1."""
    @property
    def milliseconds(self) -> float:
        """The whole frame: tracked, fused, loops."""
    @property
    def messages(self) -> List[str]:
        """What a person should know; mostly empty."""

class Trajectory:
    """Poses at times, as TUM files hold them."""

    def __init__(self, stamps_s: NDArray[np.float64], T_world_camera: NDArray[np.float64]) -> None:
        """(N,) strictly increasing seconds, and (N, 4, 4) rigid motions."""
    @property
    def stamps_s(self) -> NDArray[np.float64]:
        """(N,), a copy."""
    @property
    def T_world_camera(self) -> NDArray[np.float64]:
        """(N, 4, 4), a copy."""
    @property
    def notes(self) -> List[str]:
        """Of one that was read: which lines were skipped, and why."""
    def write(self, path: Path) -> None:
        """As a TUM file: stamp tx ty tz qx qy qz qw."""
    def __len__(self) -> int: ...

class Mesh:
    """Triangles, counter-clockwise seen from outside. The arrays are the mesh's own memory and keep it alive: what is
    written into them, `write` writes."""

    @property
    def vertices(self) -> NDArray[np.float32]:
        """(N, 3), metres."""
    @property
    def normals(self) -> NDArray[np.float32]:
        """(N, 3), unit length, out of the surface; (0, 3) if there are none."""
    @property
    def colours(self) -> NDArray[np.uint8]:
        """(N, 3), red first; (0, 3) if there are none."""
    @property
    def labels(self) -> NDArray[np.void]:
        """(N,) with the fields "class_id" (uint8) and "instance" (uint16), 0 = none; (0,) without labels."""
    @property
    def triangles(self) -> NDArray[np.int32]:
        """(M, 3), indices of vertices."""
    def write(self, path: Path) -> None:
        """As binary PLY."""

class MapObject:
    """A labelled object of a finished run, in its world, metres."""

    @property
    def id(self) -> int:
        """The instance number in Mesh.labels, from 1 on."""
    @property
    def class_id(self) -> int: ...
    @property
    def class_name(self) -> str: ...
    @property
    def colour(self) -> Tuple[int, int, int]:
        """Of its class, for pictures."""
    @property
    def probability(self) -> float: ...
    @property
    def observations(self) -> int:
        """Detections."""
    @property
    def centroid(self) -> NDArray[np.float64]: ...
    @property
    def box_min(self) -> NDArray[np.float64]: ...
    @property
    def box_max(self) -> NDArray[np.float64]: ...
    @property
    def T_world_oriented(self) -> NDArray[np.float64]:
        """(4, 4): centre and axes of the oriented box."""
    @property
    def oriented_size(self) -> NDArray[np.float64]:
        """Edge lengths of the oriented box along its axes."""

class Scanner:
    """A scan that is driven frame by frame: the lockstep engine of `tessera run`, so that the same frames and settings
    give the same bytes. Calls release the interpreter's lock; from several threads they wait for one another."""

    def __init__(self, camera: Camera, config: Optional[Path] = None, settings: Optional[Settings] = None,
                 labels: Optional[Path] = None) -> None:
        """`config`: a preset ("default", "bylow2014", "diaz2018", "labels") or a YAML file, as --config. `settings`:
        keys of docs/configuration.md, as --set. `labels`: a network or a file of detections, as --labels. ValueError
        for what the program refuses, in the same words."""
    @property
    def camera(self) -> Camera: ...
    def track(self, depth_m: NDArray[np.float32], colour: Optional[NDArray[np.uint8]], stamp_s: float,
              colour_stamp_s: Optional[float] = None) -> FrameResult:
        """Tracks and fuses one frame. `depth_m`: (height, width), metres along the optical axis; 0, nan and inf are no
        measurement. `colour`: (height, width, 3), red first, or None. Any strides; each image is copied once. Stamps
        grow; `colour_stamp_s` where the colour image was taken at another time. A lost camera is a result, not an
        error."""
    def mesh(self) -> Mesh:
        """The surface so far, small pieces left out; after `finish` the final one, the same object each time."""
    def trajectory(self) -> Trajectory:
        """The frames that were tracked; after `finish` corrected, if loops are closed ("loops.enabled")."""
    def finish(self) -> List[str]:
        """No more frames: closes the last loops and makes the final mesh. Returns what a person should know."""
    def objects(self) -> List[MapObject]:
        """After `finish`; empty without labels."""

class Frame:
    """One frame of a source: undistorted, in register, metres. Its arrays are its own memory and keep it alive."""

    @property
    def index(self) -> int: ...
    @property
    def stamp_s(self) -> float:
        """The depth image's time."""
    @property
    def colour_stamp_s(self) -> float: ...
    @property
    def camera(self) -> Camera: ...
    @property
    def depth_m(self) -> NDArray[np.float32]:
        """(height, width), 0 = no measurement."""
    @property
    def colour(self) -> Optional[NDArray[np.uint8]]:
        """(height, width, 3), red first; None if the source has none."""
    @property
    def T_world_camera(self) -> Optional[NDArray[np.float64]]:
        """The source's ground truth, (4, 4), if it has one."""

class Frames(Iterator[Frame]):
    """The frames of a source, once. An image that cannot be read is a RuntimeWarning; the loop goes on."""

    @property
    def source(self) -> str: ...
    @property
    def kind(self) -> str:
        """"TUM folder", "synthetic scene", ..."""
    @property
    def camera(self) -> Camera: ...
    @property
    def frame_count(self) -> Optional[int]:
        """None if it is not known beforehand."""
    @property
    def notes(self) -> List[str]:
        """What a person should know: unpaired images, repeated stamps, ..."""
    def __next__(self) -> Frame: ...

class RunResult:
    """A run's figures."""

    @property
    def frames(self) -> int: ...
    @property
    def tracked(self) -> int: ...
    @property
    def fused(self) -> int: ...
    @property
    def lost(self) -> int: ...
    @property
    def skipped(self) -> int:
        """Frames that could not be read."""
    @property
    def wall_s(self) -> float: ...
    @property
    def fps(self) -> float: ...
    @property
    def ate(self) -> Optional[Dict[str, Union[float, int, str]]]:
        """As evaluate_ate's, where the source brings its own truth."""
    @property
    def warnings(self) -> List[str]: ...

def frames(source: Path, config: Optional[Path] = None, settings: Optional[Settings] = None) -> Frames:
    """Opens what `tessera run` opens: a folder, FILE.oni, FILE.scan, "openni2:", "synthetic:NAME"."""

def run(source: Path, out: Optional[Path] = None, config: Optional[Path] = None, settings: Optional[Settings] = None,
        labels: Optional[Path] = None, start: int = 0, frames: Optional[int] = None, stride: int = 1) -> RunResult:
    """As `tessera run SOURCE --out OUT`: the same files in `out` (docs/outputs.md); None writes nothing. Control-C ends
    the run after the present frame, its files whole, and then raises KeyboardInterrupt."""

def read_mesh(path: Path) -> Mesh:
    """A PLY file."""

def read_trajectory(path: Path) -> Trajectory:
    """A TUM file."""

def read_objects(path: Path) -> List[MapObject]:
    """The objects.json of a run with labels."""

def evaluate_ate(reference: Trajectory, estimate: Trajectory, frames: Optional[int] = None,
                 max_difference_s: float = 0.02) -> Dict[str, Union[float, int, str]]:
    """Absolute trajectory error after one rigid alignment: the keys of `tessera eval ate --json`. `frames`: how many
    the run was given, for "tracked_fraction"."""

def evaluate_rpe(reference: Trajectory, estimate: Trajectory, delta_s: float = 1.0) -> Dict[str, float]:
    """Relative pose error over `delta_s`: the keys of `tessera eval rpe --json`."""
