"""Typed interface of `tessera`. Arrays are NumPy arrays; poses are 4 x 4 matrices T_world_camera, in metres."""
import os
from typing import Dict, Iterator, List, Mapping, Optional, Tuple, Union

import numpy as np
from numpy.typing import NDArray

Path = Union[str, "os.PathLike[str]"]
Settings = Mapping[str, Union[str, bool, int, float]]

__version__: str

class Camera:
    """A pinhole camera in pixels; (0, 0) is the centre of the top-left pixel. Raises ValueError for implausible values.
    Images passed to a Scanner must be undistorted, with colour registered to depth."""

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
    """The result for one frame."""

    @property
    def index(self) -> int:
        """Counted from 0 in the order of the calls."""
    @property
    def stamp_s(self) -> float: ...
    @property
    def tracked(self) -> bool:
        """Whether the frame has a pose."""
    @property
    def fused(self) -> bool:
        """Whether the frame was fused into the map. Poorly tracked frames are not."""
    @property
    def T_world_camera(self) -> Optional[NDArray[np.float64]]:
        """(4, 4). The world frame is the first frame's camera. None if the camera is lost."""
    @property
    def status(self) -> str:
        """"good", "poor" (tracked, not fused) or "lost"."""
    @property
    def reason(self) -> str:
        """Why the status is not "good"; else empty."""
    @property
    def inlier_fraction(self) -> float:
        """Fraction of inliers among the points where the map is known, 0 to 1."""
    @property
    def milliseconds(self) -> float:
        """Time for the whole frame: tracking, fusion and loop closure."""
    @property
    def messages(self) -> List[str]:
        """Messages for the user; usually empty."""

class Trajectory:
    """Poses with time stamps, as in a TUM file."""

    def __init__(self, stamps_s: NDArray[np.float64], T_world_camera: NDArray[np.float64]) -> None:
        """(N,) strictly increasing stamps in seconds, and (N, 4, 4) rigid transforms."""
    @property
    def stamps_s(self) -> NDArray[np.float64]:
        """(N,), a copy."""
    @property
    def T_world_camera(self) -> NDArray[np.float64]:
        """(N, 4, 4), a copy."""
    @property
    def notes(self) -> List[str]:
        """For a trajectory read from a file: which lines were skipped, and why."""
    def write(self, path: Path) -> None:
        """Writes a TUM file: stamp tx ty tz qx qy qz qw."""
    def __len__(self) -> int: ...

class Mesh:
    """A triangle mesh, counter-clockwise seen from outside. The arrays are views of the mesh's memory and keep it
    alive; `write` includes changes made through them."""

    @property
    def vertices(self) -> NDArray[np.float32]:
        """(N, 3), metres."""
    @property
    def normals(self) -> NDArray[np.float32]:
        """(N, 3), unit length, pointing out of the surface; (0, 3) if there are none."""
    @property
    def colours(self) -> NDArray[np.uint8]:
        """(N, 3), RGB; (0, 3) if there are none."""
    @property
    def labels(self) -> NDArray[np.void]:
        """(N,) with fields "class_id" (uint8) and "instance" (uint16), 0 = none; (0,) without labels."""
    @property
    def triangles(self) -> NDArray[np.int32]:
        """(M, 3), vertex indices."""
    def write(self, path: Path) -> None:
        """Writes binary PLY."""

class MapObject:
    """A labelled object of a finished run, in the run's world frame, metres."""

    @property
    def id(self) -> int:
        """The instance number in Mesh.labels, counted from 1."""
    @property
    def class_id(self) -> int: ...
    @property
    def class_name(self) -> str: ...
    @property
    def colour(self) -> Tuple[int, int, int]:
        """Display colour of the class, RGB."""
    @property
    def probability(self) -> float: ...
    @property
    def observations(self) -> int:
        """Number of detections."""
    @property
    def vertices(self) -> int:
        """Number of vertices in the mesh."""
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
    @property
    def embedding(self) -> NDArray[np.float32]:
        """(N,), of length 1; empty if the detector gives none."""

class Scanner:
    """A scan driven frame by frame. Uses the lockstep engine of `tessera run`, so the same frames and settings give
    identical results. Calls release the GIL and are serialised between threads."""

    def __init__(self, camera: Camera, config: Optional[Path] = None, settings: Optional[Settings] = None,
                 labels: Optional[Path] = None) -> None:
        """`config`: a preset ("default", "bylow2014", "diaz2018", "labels") or a YAML file, like --config. `settings`:
        keys of docs/configuration.md, like --set. `labels`: a network, a detections file or "none", like
        --labels. Raises ValueError with the program's own error message."""
    @property
    def camera(self) -> Camera: ...
    def track(self, depth_m: NDArray[np.float32], colour: Optional[NDArray[np.uint8]], stamp_s: float,
              colour_stamp_s: Optional[float] = None) -> FrameResult:
        """Tracks and fuses one frame. `depth_m`: (height, width), metres along the optical axis; 0, nan and inf mean no
        measurement. `colour`: (height, width, 3), RGB, or None. Any strides; each image is copied once. Stamps must
        increase. `colour_stamp_s`: if the colour image has a different stamp. A lost camera is a result, not an
        error."""
    def mesh(self) -> Mesh:
        """The mesh so far, without small pieces. After `finish`, the final mesh, the same object each time."""
    def trajectory(self) -> Trajectory:
        """Poses of the tracked frames. After `finish`, corrected if loop closure is on ("loops.enabled")."""
    def finish(self) -> List[str]:
        """Call after the last frame: completes loop closure, builds the final mesh, returns messages for the user."""
    def objects(self) -> List[MapObject]:
        """Call after `finish`. Empty without labels."""

class Frame:
    """One frame of a source: undistorted, registered, in metres. Its arrays are views that keep the frame alive."""

    @property
    def index(self) -> int: ...
    @property
    def stamp_s(self) -> float:
        """Time stamp of the depth image."""
    @property
    def colour_stamp_s(self) -> float: ...
    @property
    def camera(self) -> Camera: ...
    @property
    def depth_m(self) -> NDArray[np.float32]:
        """(height, width), 0 = no measurement."""
    @property
    def colour(self) -> Optional[NDArray[np.uint8]]:
        """(height, width, 3), RGB; None if the source has no colour."""
    @property
    def T_world_camera(self) -> Optional[NDArray[np.float64]]:
        """Ground truth, (4, 4), if the source has it."""

class Frames(Iterator[Frame]):
    """Iterates once over the frames of a source. An unreadable image issues a RuntimeWarning and is skipped."""

    @property
    def source(self) -> str: ...
    @property
    def kind(self) -> str:
        """"TUM folder", "synthetic scene", ..."""
    @property
    def camera(self) -> Camera: ...
    @property
    def frame_count(self) -> Optional[int]:
        """None if not known in advance."""
    @property
    def notes(self) -> List[str]:
        """Notes about the source: unpaired images, repeated stamps, ..."""
    @property
    def warnings(self) -> List[str]:
        """Signs that the source is not read as it was meant: most images unused, ..."""
    def __next__(self) -> Frame: ...

class RunResult:
    """Statistics of a run."""

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
        """Same keys as evaluate_ate, if the source has ground truth."""
    @property
    def warnings(self) -> List[str]: ...

def frames(source: Path, config: Optional[Path] = None, settings: Optional[Settings] = None) -> Frames:
    """Opens any source of `tessera run`: a folder, FILE.oni, FILE.klg, FILE.scan, "openni2:", "synthetic:NAME"."""

def run(source: Path, out: Optional[Path] = None, config: Optional[Path] = None, settings: Optional[Settings] = None,
        labels: Optional[Path] = None, start: int = 0, frames: Optional[int] = None, stride: int = 1) -> RunResult:
    """Like `tessera run SOURCE --out OUT`: writes the same files to `out` (docs/outputs.md); None writes nothing.
    Ctrl-C ends the run after the current frame with complete files and then raises KeyboardInterrupt. Raises ValueError
    for a run that is refused, and RuntimeError for one that fails later: no frame can be read, the disk is full."""

def read_mesh(path: Path) -> Mesh:
    """Reads a PLY file."""

def read_trajectory(path: Path) -> Trajectory:
    """Reads a TUM file."""

def read_objects(path: Path) -> List[MapObject]:
    """Reads the objects.json of a run with labels."""

def evaluate_ate(reference: Trajectory, estimate: Trajectory, frames: Optional[int] = None,
                 max_difference_s: float = 0.02) -> Dict[str, Union[float, int, str]]:
    """Absolute trajectory error after rigid alignment. Same keys as `tessera eval ate --json`. `frames`: number of
    input frames of the run, for "tracked_fraction"."""

def evaluate_rpe(reference: Trajectory, estimate: Trajectory, delta_s: float = 1.0) -> Dict[str, float]:
    """Relative pose error over `delta_s`. Same keys as `tessera eval rpe --json`."""
