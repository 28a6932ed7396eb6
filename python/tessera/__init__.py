"""Dense RGB-D SLAM: depth images in; camera poses and a coloured mesh out.

Scan frame by frame from NumPy arrays with `Scanner`, or a whole recording with `run`. Frames: right-handed, the camera
looks along +z, x right, y down; `p_world = T_world_camera @ p_camera`. Metres, seconds. What is wrong with what you
gave is a ValueError or a TypeError that says what to do; what breaks later (a source, a full disk) is a RuntimeError.
Everything is documented and typed in __init__.pyi beside this file, and on one page in docs/python.md.
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
    raise ImportError(f"tessera needs NumPy and the Python that it was built for ({built or 'not built'}); this is "
                      f"{sys.executable}, {sys.version.split()[0]}: {error}") from error

__all__ = [
    "Camera", "Frame", "FrameResult", "Frames", "MapObject", "Mesh", "RunResult", "Scanner", "Trajectory",
    "__version__", "evaluate_ate", "evaluate_rpe", "frames", "read_mesh", "read_objects", "read_trajectory", "run",
]
