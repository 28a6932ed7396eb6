"""Writes a folder in TUM layout as a ROS 1 bag, with depth as floats in metres. Usage: folder_to_bag.py FOLDER FILE.bag

Exits with 77 if rosbag, NumPy or Pillow is not installed.
"""
import pathlib
import sys

try:
    import genpy
    import numpy
    import rosbag
    from PIL import Image as Picture
    from sensor_msgs.msg import CameraInfo, Image
except ImportError:
    sys.exit(77)


def camera(folder):
    lines = (line.split(": ") for line in (folder / "camera.yaml").read_text().splitlines() if ": " in line)
    values = {key: value for key, value in lines if not key.startswith("#")}
    number = {key: float(values[key]) for key in ("width", "height", "fx", "fy", "cx", "cy", "depth_scale")}
    lens = [float(text) for text in values.get("distortion", "[]").strip("[]").split(",") if text] or [0.0] * 5
    info = CameraInfo(width=int(number["width"]), height=int(number["height"]), distortion_model="plumb_bob", D=lens,
                      K=[number["fx"], 0, number["cx"], 0, number["fy"], number["cy"], 0, 0, 1])
    info.header.frame_id = "optical"
    return info, number["depth_scale"]


def write(folder, bag):
    info, depth_scale = camera(folder)
    for file, topic, encoding in (("depth.txt", "/camera/depth/image", "32FC1"),
                                  ("rgb.txt", "/camera/rgb/image_color", "rgb8")):
        for line in (folder / file).read_text().splitlines():
            if not line.strip() or line.startswith("#"):
                continue
            stamp, name = line.split()[:2]
            pixels = numpy.array(Picture.open(folder / name))
            if encoding == "32FC1":
                pixels = (pixels / depth_scale).astype(numpy.float32)
            seconds, fraction = stamp.split(".")
            message = Image(width=pixels.shape[1], height=pixels.shape[0], encoding=encoding,
                            step=pixels.strides[0], data=pixels.tobytes())
            message.header.stamp = genpy.Time(int(seconds), int(fraction.ljust(9, "0")[:9]))
            message.header.frame_id = "optical"
            bag.write(topic, message, message.header.stamp)
            bag.write(topic.rsplit("/", 1)[0] + "/camera_info", info, message.header.stamp)


with rosbag.Bag(sys.argv[2], "w", compression="lz4") as recording:
    write(pathlib.Path(sys.argv[1]), recording)
