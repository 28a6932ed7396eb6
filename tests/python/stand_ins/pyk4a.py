"""Stands in for pyk4a, as its documentation describes it."""
import enum
from types import SimpleNamespace

import numpy as np
from frames import CX, CY, FX, FY, STAMPS_S, NoMoreFrames, colour_rgb, depth_mm

CalibrationType = enum.Enum("CalibrationType", "DEPTH COLOR")
ColorResolution = enum.Enum("ColorResolution", "RES_720P")
DepthMode = enum.Enum("DepthMode", "NFOV_UNBINNED")
Config = SimpleNamespace


class PyK4A:
    def __init__(self, config):
        assert config.synchronized_images_only
        self._next = 0
        self.calibration = SimpleNamespace(
            get_camera_matrix=lambda _: np.array([[FX, 0, CX], [0, FY, CY], [0, 0, 1]]),
            get_distortion_coefficients=lambda _: np.zeros(8))

    def start(self):
        pass

    def get_capture(self):
        if self._next == len(STAMPS_S):
            raise NoMoreFrames
        number, self._next = self._next, self._next + 1
        rgb = colour_rgb(number, 1280, 720)
        bgra = np.dstack([rgb[:, :, ::-1], np.full(rgb.shape[:2], 255, np.uint8)])
        return SimpleNamespace(transformed_depth=depth_mm(number, 1280, 720), color=np.ascontiguousarray(bgra),
                               depth_timestamp_usec=round(1e6 * STAMPS_S[number]))
