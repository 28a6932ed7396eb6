#!/usr/bin/env python3
"""Sends the frames of an Azure Kinect: azure_kinect.py SOCKET (or - for standard output); needs pyk4a and OpenCV."""
import sys

import cv2
from pyk4a import CalibrationType, ColorResolution, Config, DepthMode, PyK4A
from stream import FrameSender

camera = PyK4A(Config(color_resolution=ColorResolution.RES_720P, depth_mode=DepthMode.NFOV_UNBINNED,
                      synchronized_images_only=True))
camera.start()
K = camera.calibration.get_camera_matrix(CalibrationType.COLOR)
lens = camera.calibration.get_distortion_coefficients(CalibrationType.COLOR)  # rational: corrected here
maps = cv2.initUndistortRectifyMap(K, lens, None, K, (1280, 720), cv2.CV_32FC1)
sender = FrameSender(sys.argv[1], 1280, 720, K[0][0], K[1][1], K[0][2], K[1][2])
while True:
    capture = camera.get_capture()
    if capture.transformed_depth is not None and capture.color is not None:
        depth = cv2.remap(capture.transformed_depth, *maps, cv2.INTER_NEAREST)
        colour = cv2.cvtColor(cv2.remap(capture.color, *maps, cv2.INTER_LINEAR), cv2.COLOR_BGRA2RGB)
        sender.send(capture.depth_timestamp_usec / 1e6, depth, colour)
