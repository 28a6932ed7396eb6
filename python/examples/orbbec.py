#!/usr/bin/env python3
"""Sends the frames of an Orbbec camera: orbbec.py SOCKET (or - for standard output); needs pyorbbecsdk."""
import sys

import numpy as np
from pyorbbecsdk import Config, OBAlignMode, OBFormat, OBSensorType, Pipeline
from stream import FrameSender

pipeline, config = Pipeline(), Config()
profiles = pipeline.get_stream_profile_list(OBSensorType.COLOR_SENSOR)
config.enable_stream(profiles.get_video_stream_profile(640, 480, OBFormat.RGB, 30))
config.enable_stream(pipeline.get_stream_profile_list(OBSensorType.DEPTH_SENSOR).get_default_video_stream_profile())
config.set_align_mode(OBAlignMode.SW_MODE)  # depth as the colour camera sees it
pipeline.enable_frame_sync()
pipeline.start(config)
lens = pipeline.get_camera_param().rgb_intrinsic
sender = None
while True:
    frames = pipeline.wait_for_frames(100)
    depth, colour = (frames.get_depth_frame(), frames.get_color_frame()) if frames else (None, None)
    if depth is None or colour is None:
        continue
    size = (colour.get_height(), colour.get_width())
    sender = sender or FrameSender(sys.argv[1], size[1], size[0], lens.fx, lens.fy, lens.cx, lens.cy,
                                   depth_scale=1000 / depth.get_depth_scale())
    sender.send(depth.get_timestamp() / 1000, np.frombuffer(depth.get_data(), np.uint16).reshape(size),
                np.frombuffer(colour.get_data(), np.uint8).reshape(size + (3,)))
