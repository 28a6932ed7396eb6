"""Stands in for ROS 2's message_filters."""
import rclpy


def Subscriber(node, kind, name, qos_profile=None):
    assert qos_profile == "sensor data", "camera drivers publish with best effort"
    return kind, name


class ApproximateTimeSynchronizer:
    def __init__(self, topics, queue_size, slop):
        assert len(topics) == 3

    def registerCallback(self, call):
        rclpy.call = call
