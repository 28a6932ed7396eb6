"""Stands in for rclpy's profiles."""
qos_profile_sensor_data = "sensor data"
