#!/usr/bin/env python3
"""Sends two ROS 2 image topics, registered to each other: ros2_topics.py SOCKET [DEPTH COLOUR CAMERA_INFO].

Depth as 16UC1 (millimetres) or 32FC1 (metres), colour as rgb8 or bgr8.
"""
import sys

import message_filters
import numpy as np
import rclpy
from sensor_msgs.msg import CameraInfo, Image
from stream import FrameSender

names = sys.argv[2:] or ["/camera/aligned_depth_to_color/image_raw", "/camera/color/image_raw",
                         "/camera/color/camera_info"]
sender = None


def pixels(image, kind, channels):
    rows = np.frombuffer(image.data, np.uint8).reshape(image.height, image.step)
    row_bytes = image.width * channels * np.dtype(kind).itemsize
    return np.ascontiguousarray(rows[:, :row_bytes]).view(kind).reshape(image.height, image.width, channels)


def take(depth, colour, info):
    global sender
    sender = sender or FrameSender(sys.argv[1], info.width, info.height, info.k[0], info.k[4], info.k[2], info.k[5],
                                   info.d[:5] if info.distortion_model == "plumb_bob" else ())
    metres = depth.encoding == "32FC1"
    z = pixels(depth, np.float32 if metres else np.uint16, 1)[:, :, 0]
    if metres:
        z = np.nan_to_num(1000 * z, nan=0, posinf=0, neginf=0).clip(0, 65535).round().astype(np.uint16)
    rgb = pixels(colour, np.uint8, 3)
    sender.send(depth.header.stamp.sec + 1e-9 * depth.header.stamp.nanosec, z,
                rgb[:, :, ::-1] if colour.encoding == "bgr8" else rgb)


rclpy.init()
node = rclpy.create_node("tessera_sender")
topics = [message_filters.Subscriber(node, kind, name) for kind, name in zip((Image, Image, CameraInfo), names)]
message_filters.ApproximateTimeSynchronizer(topics, 5, 0.02).registerCallback(take)
rclpy.spin(node)
