"""Dense RGB-D SLAM: depth images in; camera poses and a coloured mesh out.

Scan frame by frame from NumPy arrays with `Scanner`, or a whole recording with `run`. Coordinate frames are
right-handed; the camera looks along +z, with x right and y down; `p_world = T_world_camera @ p_camera`. Units are
metres and seconds. Bad arguments raise a ValueError or TypeError that says what to do. Later failures (a source, a full
disk) raise a RuntimeError. __init__.pyi beside this file has types and documentation; docs/python.md is an overview.
"""
try:
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
except ImportError as error:
    import pathlib
    import sys

    built = ", ".join(path.name for path in pathlib.Path(__file__).parent.glob("_tessera*"))
    raise ImportError(f"tessera needs NumPy and the Python it was built for ({built or 'not built'}); this is "
                      f"{sys.executable}, {sys.version.split()[0]}: {error}") from error

__all__ = [
    "Camera", "Frame", "FrameResult", "Frames", "MapObject", "Mesh", "RunResult", "Scanner", "Trajectory",
    "__version__", "evaluate_ate", "evaluate_rpe", "frames", "read_mesh", "read_objects", "read_trajectory", "run",
]
