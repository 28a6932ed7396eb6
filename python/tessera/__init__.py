"""Dense RGB-D SLAM: depth images in; camera poses and a coloured mesh out.

Scan frame by frame from NumPy arrays with `Scanner`, or a whole recording with `run`. Frames: right-handed, the camera
looks along +z, x right, y down; `p_world = T_world_camera @ p_camera`. Metres, seconds. What is wrong with what you
gave is a ValueError or a TypeError that says what to do; what breaks later (a source, a full disk) is a RuntimeError.
Everything is documented and typed in __init__.pyi beside this file, and on one page in docs/python.md.
"""
from ._tessera import (
    Camera,
    Frame,
    FrameResult,
    Frames,
    MapObject,
    Mesh,
    RunResult,
    Scanner,
    Trajectory,
    __version__,
    evaluate_ate,
    evaluate_rpe,
    frames,
    read_mesh,
    read_objects,
    read_trajectory,
    run,
)

__all__ = [
    "Camera", "Frame", "FrameResult", "Frames", "MapObject", "Mesh", "RunResult", "Scanner", "Trajectory",
    "__version__", "evaluate_ate", "evaluate_rpe", "frames", "read_mesh", "read_objects", "read_trajectory", "run",
]
