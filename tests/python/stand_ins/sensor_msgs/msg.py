"""Stands in for ROS 2's message types."""
Image = CameraInfo = object
