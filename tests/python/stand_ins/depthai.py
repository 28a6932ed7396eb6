"""Stands in for depthai 3, as its examples use it."""
import datetime
import enum
from types import SimpleNamespace

import numpy as np
from frames import CX, CY, FX, FY, STAMPS_S, colour_rgb, depth_mm

CameraBoardSocket = enum.Enum("CameraBoardSocket", "CAM_A CAM_B CAM_C")
node = enum.Enum("node", "Camera StereoDepth Sync")


class _Node:
    def __init__(self, pipeline):
        self._pipeline = pipeline
        self.left = self.right = self.inputAlignTo = self
        self.inputs = {"colour": self, "depth": self}
        self.depth = SimpleNamespace(link=lambda to: None)
        self.out = SimpleNamespace(createOutputQueue=lambda: pipeline)

    def build(self, _):
        return self

    def requestOutput(self, size, fps, enableUndistortion=False):
        return SimpleNamespace(link=lambda to: None)


class Pipeline:
    def __init__(self):
        self._next = 0

    def create(self, _):
        return _Node(self)

    def getDefaultDevice(self):
        K = [[FX, 0, CX], [0, FY, CY], [0, 0, 1]]
        return SimpleNamespace(readCalibration=lambda: SimpleNamespace(getCameraIntrinsics=lambda *_: K))

    def start(self):
        pass

    def isRunning(self):
        return self._next < len(STAMPS_S)

    def get(self):
        number, self._next = self._next, self._next + 1
        stamp = datetime.timedelta(seconds=STAMPS_S[number])
        bgr = np.ascontiguousarray(colour_rgb(number)[:, :, ::-1])
        return {"depth": SimpleNamespace(getTimestamp=lambda: stamp, getFrame=lambda: depth_mm(number)),
                "colour": SimpleNamespace(getCvFrame=lambda: bgr)}
