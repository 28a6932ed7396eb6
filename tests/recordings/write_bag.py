"""Writes a ROS 1 bag with Debian's rosbag. Usage: write_bag.py FILE.bag VARIANT COMPRESSION

VARIANT: plain, float, compressed or realsense. Exits with 77 if rosbag is not installed. The images are those of
ros_images_of.h.
"""
import struct
import sys
import zlib

try:
    import genpy
    import rosbag
    from geometry_msgs.msg import Transform, TransformStamped
    from sensor_msgs.msg import CameraInfo, CompressedImage, Image
    from tf2_msgs.msg import TFMessage
except ImportError:
    sys.exit(77)

FRAMES = 5
DEPTH_SIZE, COLOUR_SIZE = (64, 48), (96, 72)


def depth_value(x, y, i):
    return 500 + 7 * x + 13 * y + 101 * i


def depth_bytes(i, form="<H", scale=1):
    w, h = DEPTH_SIZE
    return b"".join(struct.pack(form, depth_value(x, y, i) * scale) for y in range(h) for x in range(w))


def colour_bytes(i):
    w, h = COLOUR_SIZE
    return bytes(v for y in range(h) for x in range(w) for v in ((x * 2 + i) % 256, (y * 3) % 256, (x + y + 17 * i) % 256))


def png(width, height, bits, kind, rows):
    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, bits, kind, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(b"".join(b"\0" + row for row in rows))) + chunk(b"IEND", b""))


def stamp(i, late_ns=0):
    return genpy.Time(1000 + i // 10, i % 10 * 100_000_000 + late_ns)


def header(message, i, frame, late_ns=0):
    message.header.stamp = stamp(i, late_ns)
    message.header.frame_id = frame
    return message


def image(i, size, encoding, step, data):
    return Image(width=size[0], height=size[1], encoding=encoding, step=step * size[0], data=data)


def camera(size, f, centre, distortion, frame, model="plumb_bob"):
    info = CameraInfo(width=size[0], height=size[1], distortion_model=model, D=distortion,
                      K=[f, 0, centre[0], 0, f + 1, centre[1], 0, 0, 1],
                      P=[f - 1, 0, centre[0], 0, 0, f, centre[1], 0, 0, 0, 1, 0])
    info.header.frame_id = frame
    return info


def transform(parent, child, translation, rotation):
    t = TransformStamped(child_frame_id=child)
    t.header.frame_id = parent
    t.transform.translation.x, t.transform.translation.y, t.transform.translation.z = translation
    q = t.transform.rotation
    q.x, q.y, q.z, q.w = rotation
    return t


DEPTH_CAMERA = (DEPTH_SIZE, 60.5, (31.25, 23.75), [0] * 5)
COLOUR_CAMERA = (COLOUR_SIZE, 91, (47.5, 35.25), [0.1, -0.05, 0.001, -0.002, 0.01])


def write_plain(bag):
    """A depth and a colour camera side by side; colour is 4 ms late, and there is an infrared camera."""
    frames = [transform("link", "depth_optical", (0, 0, 0), (0, 0, 0, 1)),
              transform("link", "colour_optical", (0.015, 0, 0), (0, 0.6, 0, 0.8))]
    bag.write("/tf_static", TFMessage(frames), stamp(0))
    bag.write("/cam/depth/camera_info", camera(*DEPTH_CAMERA, "depth_optical"), stamp(0))
    bag.write("/cam/color/camera_info", camera(*COLOUR_CAMERA, "colour_optical"), stamp(0))
    for i in range(FRAMES):
        bag.write("/cam/depth/image_raw", header(image(i, DEPTH_SIZE, "16UC1", 2, depth_bytes(i)), i, "depth_optical"),
                  stamp(i))
        bag.write("/cam/infra1/image_raw", header(image(i, DEPTH_SIZE, "mono8", 1, bytes(64 * 48)), i, "depth_optical"),
                  stamp(i))
        bag.write("/cam/color/image_raw",
                  header(image(i, COLOUR_SIZE, "rgb8", 3, colour_bytes(i)), i, "colour_optical", 4_000_000), stamp(i))


def write_float(bag):
    """Depth in metres, registered to colour: one frame, one camera."""
    for name in ("/camera/rgb", "/camera/depth"):
        bag.write(name + "/camera_info", camera(*DEPTH_CAMERA, "/openni_rgb_optical_frame"), stamp(0))
    for i in range(FRAMES):
        bag.write("/camera/depth/image",
                  header(image(i, DEPTH_SIZE, "32FC1", 4, depth_bytes(i, "<f", 1e-3)), i, "/openni_rgb_optical_frame"),
                  stamp(i))
        bag.write("/camera/rgb/image_color",
                  header(image(i, DEPTH_SIZE, "mono8", 1, bytes(64 * 48)), i, "/openni_rgb_optical_frame"), stamp(i))


def write_compressed(bag):
    """Both as PNG, by the image transports; the depth camera's CameraInfo is rectified."""
    bag.write("/cam/depth/camera_info", camera(*DEPTH_CAMERA, "optical"), stamp(0))
    bag.write("/cam/color/camera_info", camera(*COLOUR_CAMERA, "optical"), stamp(0))
    for i in range(FRAMES):
        w, h = DEPTH_SIZE
        raw = depth_bytes(i, ">H")
        depth = CompressedImage(format="16UC1; compressedDepth png",
                                data=bytes(12) + png(w, h, 16, 0, [raw[2 * w * y:2 * w * (y + 1)] for y in range(h)]))
        bag.write("/cam/depth/image_rect/compressedDepth", header(depth, i, "optical"), stamp(i))
        w, h = COLOUR_SIZE
        raw = colour_bytes(i)
        colour = CompressedImage(format="rgb8; png compressed",
                                 data=png(w, h, 8, 2, [raw[3 * w * y:3 * w * (y + 1)] for y in range(h)]))
        bag.write("/cam/color/image_raw/compressed", header(colour, i, "optical"), stamp(i))


def serialised(message, extra=b""):
    import io
    buffer = io.BytesIO()
    message.serialize(buffer)
    return (message._type, buffer.getvalue() + extra, message._md5sum, None, type(message))


def write_realsense(bag):
    """As librealsense's recorder: the header's frame is "1", and the depth unit follows the image."""
    depth, colour = "/device_0/sensor_0/Depth_0", "/device_0/sensor_1/Color_0"
    bag.write(depth + "/info/camera_info", camera(*DEPTH_CAMERA, "", "Brown Conrady"), stamp(0))
    bag.write(colour + "/info/camera_info", camera(*COLOUR_CAMERA, "", "Inverse Brown Conrady"), stamp(0))
    bag.write(depth + "/tf/0", transform("", "", (0.5, 0, 0), (0, 0, 0, 1)).transform, stamp(0))
    bag.write(colour + "/tf/0", transform("", "", (0.6, 0, 0), (0, 0.6, 0, 0.8)).transform, stamp(0))
    for i in range(FRAMES):
        message = header(image(i, DEPTH_SIZE, "mono16", 2, depth_bytes(i)), i, "1")
        bag.write(depth + "/image/data", serialised(message, struct.pack("<f", 0.0005)), stamp(i), raw=True)
        message = header(image(i, DEPTH_SIZE, "8UC1", 1, bytes(64 * 48)), i, "1")
        bag.write("/device_0/sensor_0/Infrared_1/image/data", serialised(message, bytes(4)), stamp(i), raw=True)
        message = header(image(i, COLOUR_SIZE, "rgb8", 3, colour_bytes(i)), i, "1", 4_000_000)
        bag.write(colour + "/image/data", serialised(message, bytes(4)), stamp(i), raw=True)


def main():
    path, variant, compression = sys.argv[1:]
    with rosbag.Bag(path, "w", compression=compression, chunk_threshold=50_000) as bag:
        globals()["write_" + variant](bag)


main()
