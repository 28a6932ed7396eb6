"""Stands in for pyorbbecsdk, as its stubs describe it."""
import enum
from types import SimpleNamespace

from frames import CX, CY, FX, FY, HEIGHT, STAMPS_S, WIDTH, NoMoreFrames, colour_rgb, depth_mm

OBAlignMode = enum.Enum("OBAlignMode", "DISABLE HW_MODE SW_MODE")
OBFormat = enum.Enum("OBFormat", "RGB Y16")
OBSensorType = enum.Enum("OBSensorType", "COLOR_SENSOR DEPTH_SENSOR")


class Config:
    def __init__(self):
        self.streams, self.align = [], OBAlignMode.DISABLE

    def enable_stream(self, profile):
        self.streams.append(profile)

    def set_align_mode(self, mode):
        self.align = mode


class Pipeline:
    def __init__(self):
        self._next = -1  # the first wait gives nothing

    def get_stream_profile_list(self, sensor):
        return SimpleNamespace(get_video_stream_profile=lambda *which: (sensor, which),
                               get_default_video_stream_profile=lambda: (sensor, None))

    def enable_frame_sync(self):
        pass

    def start(self, config):
        assert config.align == OBAlignMode.SW_MODE and len(config.streams) == 2

    def get_camera_param(self):
        return SimpleNamespace(rgb_intrinsic=SimpleNamespace(fx=FX, fy=FY, cx=CX, cy=CY))

    def wait_for_frames(self, _):
        number, self._next = self._next, self._next + 1
        if number < 0:
            return None
        if number == len(STAMPS_S):
            raise NoMoreFrames

        def image(data):
            return SimpleNamespace(get_data=lambda: data.tobytes(), get_width=lambda: WIDTH,
                                   get_height=lambda: HEIGHT, get_depth_scale=lambda: 1.0,
                                   get_timestamp=lambda: round(1000 * STAMPS_S[number]))
        return SimpleNamespace(get_depth_frame=lambda: image(depth_mm(number)),
                               get_color_frame=lambda: image(colour_rgb(number)))
