#!/usr/bin/env python3
"""Sends the frames of a camera that OpenCV opens through OpenNI2: opencv_capture.py SOCKET (or - for standard output)."""
import sys
import time

import cv2
from stream import FrameSender

camera = cv2.VideoCapture(cv2.CAP_OPENNI2)
if not camera.isOpened():
    sys.exit("OpenCV finds no camera, or was built without OpenNI2")
camera.set(cv2.CAP_PROP_OPENNI2_MIRROR, 0)
camera.set(cv2.CAP_OPENNI_DEPTH_GENERATOR_REGISTRATION, 1)  # depth as the colour camera sees it
focal_px = camera.get(cv2.CAP_OPENNI_DEPTH_GENERATOR_FOCAL_LENGTH)
sender = None
while camera.grab():
    stamp_s = time.time()
    (has_depth, depth), (has_colour, colour) = (camera.retrieve(flag=which) for which in
                                                (cv2.CAP_OPENNI_DEPTH_MAP, cv2.CAP_OPENNI_BGR_IMAGE))
    if has_depth and has_colour:
        height, width = depth.shape
        sender = sender or FrameSender(sys.argv[1], width, height, focal_px, focal_px, (width - 1) / 2, (height - 1) / 2)
        sender.send(stamp_s, depth, colour[:, :, ::-1])
