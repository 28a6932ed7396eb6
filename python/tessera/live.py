"""A live scan from a program's own frames: `Live`. It runs the program `tessera` beside this one, with its threads,
window and files, and sends it the frames."""
import os
import shutil
import subprocess
import threading
from typing import Mapping, Optional, Sequence, Union

import numpy as np

from . import Camera, Mesh, Trajectory, read_mesh, read_trajectory
from .stream import FrameSender


class _GrowingLines:
    """The whole lines of a file that another program appends to, or begins again. What it has now is left out."""

    def __init__(self, path: str):
        self._path, self._file, self._rest = path, None, b""
        if self._reopen():
            self._file.seek(0, os.SEEK_END)

    def _reopen(self) -> bool:
        try:
            file = open(self._path, "rb")
        except FileNotFoundError:
            return False
        now = os.fstat(file.fileno())
        if self._file is not None:
            same = os.path.samestat(now, os.fstat(self._file.fileno())) and now.st_size >= self._file.tell()
            (file if same else self._file).close()
            if same:
                return True
        self._file, self._rest = file, b""
        return True

    def read(self) -> list:
        if not self._reopen():
            return []
        lines = (self._rest + self._file.read()).split(b"\n")
        self._rest = lines.pop()
        return lines


class Live:
    """Scans what is pushed, as `tessera run` does with a camera: frames that come faster than they are tracked are
    dropped.

    `camera`: of the colour image, to which depth is registered. `out`: folder for the results. `window`: opens the
    window. `settings` and `options`: as --set, and further words for the command line ("--scan", "room.scan").
    `depth_scale`: stored depth of one metre. `program`: where it is; by default the environment variable
    TESSERA_PROGRAM, or what PATH has. Raises FileNotFoundError if it is nowhere.

        with tessera.live.Live(camera, "scan", window=True) as live:
            live.push(depth, colour, stamp_s)       # from any thread
        print(live.trajectory())
    """

    def __init__(self, camera: Camera, out: Union[str, os.PathLike], window: bool = False,
                 settings: Optional[Mapping[str, object]] = None, options: Sequence[str] = (),
                 depth_scale: float = 1000.0, program: Optional[str] = None):
        program = program or os.environ.get("TESSERA_PROGRAM") or shutil.which("tessera")
        if program is None:
            raise FileNotFoundError("the program tessera is not on PATH; give program=, or set TESSERA_PROGRAM")
        words = [program, "run", "pipe:-", "--out", os.fspath(out), *(["--view"] if window else []), *options]
        for key, value in (settings or {}).items():
            words += ["--set", f"{key}={value}"]
        self._out = os.fspath(out)
        self._path = _GrowingLines(os.path.join(self._out, "trajectory.txt"))
        self._lock = threading.Lock()    # of what is sent
        self._ending = threading.Lock()  # of what the program says at its end
        self._process = subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=None)
        self._sender = None
        try:
            self._sender = FrameSender(self._process.stdin, camera.width, camera.height, camera.fx, camera.fy,
                                       camera.cx, camera.cy, depth_scale=depth_scale)
        except BrokenPipeError:  # the program has refused its options: finish says so
            pass

    def push(self, depth: np.ndarray, colour: Optional[np.ndarray], stamp_s: float) -> None:
        """Sends one frame: `depth` (height, width) uint16, 0 where nothing was measured; `colour` (height, width, 3)
        uint8 RGB or None. Thread-safe. Raises ValueError for other arrays, and BrokenPipeError if the scan has ended."""
        with self._lock:
            if self._sender is None:
                raise BrokenPipeError("the scan has ended")
            self._sender.send(stamp_s, depth, colour)

    def poses(self) -> np.ndarray:
        """Poses of the camera that have come since the last call, as tracked: (n, 8), a row for each tracked frame with
        stamp_s tx ty tz qx qy qz qw of T_world_camera, metres; a lost frame has none. Never waits. After a reset, and
        when loop closure has written the corrected path at the end, they begin again with the first. Not
        thread-safe."""
        lines = [line.split() for line in self._path.read() if not line.startswith(b"#")]
        return np.array(lines, dtype=float).reshape(-1, 8)

    def finish(self) -> str:
        """Ends the scan and waits until everything is written. Returns the program's summary. Raises RuntimeError if
        it did not succeed; its messages are on stderr."""
        with self._lock:
            self._sender = None
            if not self._process.stdin.closed:
                try:
                    self._process.stdin.close()
                except BrokenPipeError:
                    pass
        with self._ending:
            summary = self._process.stdout.read().decode() if not self._process.stdout.closed else ""
            self._process.stdout.close()
            code = self._process.wait()
        if code not in (0, 3):
            raise RuntimeError(f"tessera ended with exit code {code}")
        return summary

    def trajectory(self) -> Trajectory:
        """The camera's path, after `finish`."""
        return read_trajectory(os.path.join(self._out, "trajectory.txt"))

    def mesh(self) -> Mesh:
        """The mesh, after `finish`."""
        return read_mesh(os.path.join(self._out, "mesh.ply"))

    def __enter__(self):
        return self

    def __exit__(self, kind, *_):
        if kind is None:
            self.finish()
        else:
            self._process.terminate()
            self._process.wait()
