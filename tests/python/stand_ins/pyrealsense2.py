"""Stands in for pyrealsense2, as its documentation describes it."""
import enum
from types import SimpleNamespace

from frames import CX, CY, FX, FY, HEIGHT, STAMPS_S, WIDTH, NoMoreFrames, colour_rgb, depth_mm

stream = enum.Enum("stream", "depth color")
format = enum.Enum("format", "z16 rgb8")
distortion = enum.Enum("distortion", "none brown_conrady inverse_brown_conrady")


class config:
    def enable_stream(self, kind, width, height, form, rate):
        assert (kind, form) in ((stream.depth, format.z16), (stream.color, format.rgb8))
        assert (width, height, rate) == (WIDTH, HEIGHT, 30)


class pipeline:
    def __init__(self):
        self._next = 0

    def start(self, _):
        lens = SimpleNamespace(width=WIDTH, height=HEIGHT, fx=FX, fy=FY, ppx=CX, ppy=CY, coeffs=[0.0] * 5,
                               model=distortion.inverse_brown_conrady)
        video = SimpleNamespace(get_intrinsics=lambda: lens)
        sensor = SimpleNamespace(get_depth_scale=lambda: 0.001)
        return SimpleNamespace(
            get_stream=lambda _: SimpleNamespace(as_video_stream_profile=lambda: video),
            get_device=lambda: SimpleNamespace(first_depth_sensor=lambda: sensor))

    def wait_for_frames(self):
        if self._next == len(STAMPS_S):
            raise NoMoreFrames
        number, self._next = self._next, self._next + 1
        image = lambda data: SimpleNamespace(get_data=lambda: data, get_timestamp=lambda: 1000 * STAMPS_S[number])
        return SimpleNamespace(get_depth_frame=lambda: image(depth_mm(number)),
                               get_color_frame=lambda: image(colour_rgb(number)))


class align:
    def __init__(self, to):
        assert to == stream.color

    def process(self, frames):
        return frames
