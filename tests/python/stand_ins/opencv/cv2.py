"""Stands in for OpenCV's VideoCapture of OpenNI2, as OpenCV's documentation describes it."""
import numpy as np
from frames import FX, STAMPS_S, colour_rgb, depth_mm

CAP_OPENNI2 = 1600
CAP_PROP_OPENNI2_MIRROR = 111
CAP_OPENNI_DEPTH_GENERATOR_FOCAL_LENGTH, CAP_OPENNI_DEPTH_GENERATOR_REGISTRATION = -2147483545, -2147483544
CAP_OPENNI_DEPTH_MAP, CAP_OPENNI_BGR_IMAGE = 0, 5


class VideoCapture:
    def __init__(self, interface):
        self._next, self._set = -1, {CAP_PROP_OPENNI2_MIRROR: 1}
        self._opened = interface == CAP_OPENNI2

    def isOpened(self):
        return self._opened

    def set(self, key, value):
        self._set[key] = value
        return True

    def get(self, key):
        return FX if key == CAP_OPENNI_DEPTH_GENERATOR_FOCAL_LENGTH else 0.0

    def grab(self):
        self._next += 1
        return self._next < 1 + len(STAMPS_S)

    def retrieve(self, image=None, flag=0):
        assert self._set == {CAP_PROP_OPENNI2_MIRROR: 0, CAP_OPENNI_DEPTH_GENERATOR_REGISTRATION: 1}
        if self._next == 0:  # the first images are not there yet
            return False, None
        number = self._next - 1
        return True, (depth_mm(number) if flag == CAP_OPENNI_DEPTH_MAP
                      else np.ascontiguousarray(colour_rgb(number)[:, :, ::-1]))
