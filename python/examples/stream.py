"""Sends frames to `tessera run pipe:...` from any program that has them as NumPy arrays.

This file needs nothing else of Tessera: copy it to where the camera is. docs/camera.md describes the stream.
"""
import socket
import struct
import sys
import time
import zlib

import numpy as np


class FrameSender:
    """A stream of frames. Not thread-safe.

    `to`: the path of the program's socket, "-" for standard output, or a binary file that is open. Waits up to `wait_s` for the socket to be there.
    `fx` to `cy`: pixels; `distortion`: k1, k2, p1, p2 and perhaps k3, as OpenCV has them; `depth_scale`: stored depth of
    one metre. `compress`: depth goes through zlib, for networks.
    """

    def __init__(self, to, width, height, fx, fy, cx, cy, distortion=(), depth_scale=1000.0, fps=30.0, compress=False,
                 wait_s=60.0):
        self._size = (height, width)
        self._compress = compress
        self._file = (sys.stdout.buffer if to == "-" else
                      self._connect(to, wait_s) if isinstance(to, str) else to)
        lens = f"distortion: [{', '.join(str(float(k)) for k in distortion)}]\n" if any(distortion) else ""
        camera = (f"width: {width}\nheight: {height}\nfx: {float(fx)}\nfy: {float(fy)}\ncx: {float(cx)}\n"
                  f"cy: {float(cy)}\n{lens}depth_scale: {float(depth_scale)}\nfps: {float(fps)}\n").encode()
        self._file.write(b"TESSERA1" + struct.pack("<I", len(camera)) + camera)
        self._file.flush()

    @staticmethod
    def _connect(path, wait_s):
        until = time.monotonic() + wait_s
        while True:
            connection = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
            try:
                connection.connect(path)
                return connection.makefile("wb", buffering=0)
            except OSError:
                connection.close()
                if time.monotonic() > until:
                    raise
                time.sleep(0.1)

    def send(self, stamp_s, depth, colour=None):
        """Sends one frame: `depth` (height, width) uint16, 0 where nothing was measured; `colour` (height, width, 3)
        uint8 RGB, the bytes of a JPEG, or None. Raises ValueError for other shapes or types, and OSError
        (BrokenPipeError) when the program has gone."""
        depth = np.ascontiguousarray(depth)
        if depth.shape != self._size or depth.dtype != np.uint16:
            raise ValueError(f"depth: {depth.shape} {depth.dtype}, expected {self._size} uint16")
        if isinstance(colour, np.ndarray):
            if colour.shape != self._size + (3,) or colour.dtype != np.uint8:
                raise ValueError(f"colour: {colour.shape} {colour.dtype}, expected {self._size + (3,)} uint8")
            colour = np.ascontiguousarray(colour).data
        packed = zlib.compress(depth.data, 1) if self._compress else depth.data
        colour = memoryview(colour or b"").cast("B")
        packed = memoryview(packed).cast("B")
        self._write(struct.pack("<qii", round(1e6 * stamp_s), packed.nbytes, colour.nbytes))
        self._write(packed)
        self._write(colour)
        self._file.flush()

    def _write(self, data):
        view = memoryview(data)
        while view.nbytes:
            view = view[self._file.write(view):]

    def close(self):
        self._file.close()
