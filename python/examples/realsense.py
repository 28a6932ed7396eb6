#!/usr/bin/env python3
"""Sends the frames of an Intel RealSense camera: realsense.py SOCKET (or - for standard output); needs pyrealsense2."""
import sys

import numpy as np
import pyrealsense2 as rs
from stream import FrameSender

pipeline, config = rs.pipeline(), rs.config()
config.enable_stream(rs.stream.depth, 640, 480, rs.format.z16, 30)
config.enable_stream(rs.stream.color, 640, 480, rs.format.rgb8, 30)
profile = pipeline.start(config)
lens = profile.get_stream(rs.stream.color).as_video_stream_profile().get_intrinsics()
distortion = lens.coeffs if lens.model == rs.distortion.brown_conrady else ()
unit_m = profile.get_device().first_depth_sensor().get_depth_scale()
sender = FrameSender(sys.argv[1], lens.width, lens.height, lens.fx, lens.fy, lens.ppx, lens.ppy, distortion, 1 / unit_m)
to_colour = rs.align(rs.stream.color)
while True:
    frames = to_colour.process(pipeline.wait_for_frames())
    depth, colour = frames.get_depth_frame(), frames.get_color_frame()
    if depth and colour:
        sender.send(depth.get_timestamp() / 1000, np.asanyarray(depth.get_data()), np.asanyarray(colour.get_data()))
