#!/usr/bin/env python3
"""Sends two ROS 2 image topics, registered to each other: ros2_topics.py SOCKET [DEPTH COLOUR CAMERA_INFO].

Depth as 16UC1 (millimetres) or 32FC1 (metres); colour as rgb8, bgr8, rgba8, bgra8 or mono8. Depth must be registered to
colour and have its size: aligned_depth_to_color of RealSense's driver, or what depth_image_proc/register makes of other
cameras' topics. CAMERA_INFO is the colour camera's.
"""
import os
import sys

import message_filters
import numpy as np
import rclpy
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import CameraInfo, Image
from stream import FrameSender

NAMES = sys.argv[2:] or ["/camera/aligned_depth_to_color/image_raw", "/camera/color/image_raw",
                         "/camera/color/camera_info"]
DEPTH = {"16UC1": (np.uint16, 1), "32FC1": (np.float32, 1)}
COLOUR = {"rgb8": (np.uint8, 3), "bgr8": (np.uint8, 3), "rgba8": (np.uint8, 4), "bgra8": (np.uint8, 4),
          "mono8": (np.uint8, 1)}
sender = None


def pixels(image, layouts, topic, info):
    """The image as (height, width, channels). Rows may be longer than their pixels. Ends the program if it cannot be
    sent."""
    if image.encoding not in layouts:
        sys.exit(f"{topic}: the encoding {image.encoding} is not one of {', '.join(layouts)}")
    if (image.width, image.height) != (info.width, info.height):
        sys.exit(f"{topic}: images of {image.width} x {image.height}, but {NAMES[2]} says {info.width} x {info.height}; "
                 "depth and colour must be registered (depth_image_proc/register) and of one size")
    kind, channels = layouts[image.encoding]
    if image.is_bigendian and np.dtype(kind).itemsize > 1:
        kind = np.dtype(kind).newbyteorder(">")
    rows = np.frombuffer(image.data, np.uint8).reshape(image.height, image.step)
    row_bytes = image.width * channels * np.dtype(kind).itemsize
    return np.ascontiguousarray(rows[:, :row_bytes]).view(kind).reshape(image.height, image.width, channels)


def lens_of(info):
    """k1, k2, p1, p2, k3, or none with a warning."""
    if info.distortion_model == "plumb_bob":
        return info.d[:5]
    if any(info.d):
        print(f"warning: {NAMES[2]}: the lens model {info.distortion_model} is not sent, so its distortion stays; send "
              "rectified images (image_proc)", file=sys.stderr)
    return ()


def take(depth, colour, info):
    global sender
    z = pixels(depth, DEPTH, NAMES[0], info)[:, :, 0]
    rgb = pixels(colour, COLOUR, NAMES[1], info)
    sender = sender or FrameSender(sys.argv[1], info.width, info.height, info.k[0], info.k[4], info.k[2], info.k[5],
                                   lens_of(info))
    if depth.encoding == "32FC1":
        z = np.nan_to_num(1000 * z, nan=0, posinf=0, neginf=0).clip(0, 65535).round()
    if colour.encoding == "mono8":
        rgb = np.repeat(rgb, 3, axis=2)
    rgb = rgb[:, :, 2::-1] if colour.encoding.startswith("bgr") else rgb[:, :, :3]
    sender.send(depth.header.stamp.sec + 1e-9 * depth.header.stamp.nanosec, z.astype(np.uint16), rgb)


rclpy.init()
node = rclpy.create_node("tessera_sender")
topics = [message_filters.Subscriber(node, kind, name, qos_profile=qos_profile_sensor_data)
          for kind, name in zip((Image, Image, CameraInfo), NAMES)]
message_filters.ApproximateTimeSynchronizer(topics, 5, 0.02).registerCallback(take)
try:
    rclpy.spin(node)
except BrokenPipeError:  # the run has ended; what is left for standard output goes nowhere
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
