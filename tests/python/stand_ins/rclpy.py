"""Stands in for rclpy; message_filters.py and sensor_msgs are beside it."""
from types import SimpleNamespace

from frames import CX, CY, FX, FY, HEIGHT, STAMPS_S, WIDTH, NoMoreFrames, colour_rgb, depth_mm

call = None  # what message_filters registered


def init():
    pass


def create_node(name):
    return name


def _image(data, encoding, number):
    stamp = SimpleNamespace(sec=int(STAMPS_S[number]), nanosec=round(1e9 * (STAMPS_S[number] % 1)))
    padded = b"".join(row.tobytes() + b"pad!" for row in data)  # rows may be longer than their pixels
    return SimpleNamespace(data=padded, encoding=encoding, width=WIDTH, height=HEIGHT, step=len(padded) // HEIGHT,
                           header=SimpleNamespace(stamp=stamp))


def spin(_):
    info = SimpleNamespace(width=WIDTH, height=HEIGHT, k=[FX, 0, CX, 0, FY, CY, 0, 0, 1], d=[0.0] * 5,
                           distortion_model="plumb_bob")
    call(_image(depth_mm(0), "16UC1", 0), _image(colour_rgb(0), "rgb8", 0), info)
    metres = depth_mm(1).astype("float32") / 1000
    call(_image(metres, "32FC1", 1), _image(colour_rgb(1)[:, :, ::-1], "bgr8", 1), info)
    raise NoMoreFrames
