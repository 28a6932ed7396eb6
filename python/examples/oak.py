#!/usr/bin/env python3
"""Sends the frames of a Luxonis OAK-D: oak.py SOCKET (or - for standard output); needs depthai 3 and OpenCV."""
import sys

import depthai as dai
from stream import FrameSender

pipeline = dai.Pipeline()
colour, left, right = (pipeline.create(dai.node.Camera).build(s)
                       for s in (dai.CameraBoardSocket.CAM_A, dai.CameraBoardSocket.CAM_B, dai.CameraBoardSocket.CAM_C))
stereo, sync = pipeline.create(dai.node.StereoDepth), pipeline.create(dai.node.Sync)
images = colour.requestOutput(size=(640, 480), fps=30, enableUndistortion=True)
left.requestOutput(size=(640, 400), fps=30).link(stereo.left)
right.requestOutput(size=(640, 400), fps=30).link(stereo.right)
images.link(stereo.inputAlignTo)
images.link(sync.inputs["colour"])
stereo.depth.link(sync.inputs["depth"])
queue = sync.out.createOutputQueue()
K = pipeline.getDefaultDevice().readCalibration().getCameraIntrinsics(dai.CameraBoardSocket.CAM_A, 640, 480)
sender = FrameSender(sys.argv[1], 640, 480, K[0][0], K[1][1], K[0][2], K[1][2])
pipeline.start()
while pipeline.isRunning():
    pair = queue.get()
    stamp_s = pair["depth"].getTimestamp().total_seconds()
    sender.send(stamp_s, pair["depth"].getFrame(), pair["colour"].getCvFrame()[:, :, ::-1])  # from BGR
