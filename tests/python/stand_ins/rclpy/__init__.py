"""Stands in for rclpy; message_filters.py and sensor_msgs are beside it."""
import os
from types import SimpleNamespace

import numpy as np
from frames import CX, CY, FX, FY, HEIGHT, STAMPS_S, WIDTH, NoMoreFrames, colour_rgb, depth_mm

call = None  # what message_filters registered


def init():
    pass


def create_node(name):
    return name


def _image(data, encoding, number):
    stamp = SimpleNamespace(sec=int(STAMPS_S[number]), nanosec=round(1e9 * (STAMPS_S[number] % 1)))
    padded = b"".join(row.tobytes() + b"pad!" for row in data)  # rows may be longer than their pixels
    return SimpleNamespace(data=padded, encoding=encoding, width=data.shape[1], height=data.shape[0], is_bigendian=0,
                           step=len(padded) // data.shape[0], header=SimpleNamespace(stamp=stamp))


def spin(_):
    """ROS_CASE chooses what the topics hold; without it, both depth encodings and two of colour."""
    case = os.environ.get("ROS_CASE", "")
    info = SimpleNamespace(width=WIDTH, height=HEIGHT, k=[FX, 0, CX, 0, FY, CY, 0, 0, 1], d=[0.0] * 5,
                           distortion_model="plumb_bob")
    depths = [_image(depth_mm(0), "16UC1", 0), _image(depth_mm(1).astype("float32") / 1000, "32FC1", 1)]
    rgb = [colour_rgb(number) for number in (0, 1)]
    colours = [_image(rgb[0], "rgb8", 0), _image(rgb[1][:, :, ::-1], "bgr8", 1)]
    if case == "alpha":
        full = [np.dstack([image, np.full((HEIGHT, WIDTH), 255, np.uint8)]) for image in rgb]
        colours = [_image(full[0], "rgba8", 0), _image(full[1][:, :, [2, 1, 0, 3]], "bgra8", 1)]
    elif case == "grey":
        colours = [_image(image[:, :, 0], "mono8", number) for number, image in enumerate(rgb)]
    elif case == "bayer":
        colours[0].encoding = "bayer_rggb8"
    elif case == "size":
        depths[0] = _image(depth_mm(0)[::2, ::2], "16UC1", 0)
    elif case == "fisheye":
        info.distortion_model, info.d = "equidistant", [0.1, 0, 0, 0]
    elif case == "gone":
        raise BrokenPipeError
    for depth, colour in zip(depths, colours):
        call(depth, colour, info)
    raise NoMoreFrames
