"""The two frames that every stand-in camera gives, and its lens."""
import numpy as np

WIDTH, HEIGHT, FX, FY, CX, CY = 640, 480, 610.5, 611.25, 320.5, 241.5
STAMPS_S = (12.5, 12.533)


def depth_mm(number, width=WIDTH, height=HEIGHT):
    y, x = np.mgrid[0:height, 0:width]
    return (1000 + 100 * number + x // 4 + y // 8).astype(np.uint16)


def colour_rgb(number, width=WIDTH, height=HEIGHT):
    y, x = np.mgrid[0:height, 0:width]
    return np.stack([x % 256, y % 256, np.full_like(x, 40 + number)], axis=-1).astype(np.uint8)


class NoMoreFrames(Exception):
    """Ends an example, which otherwise runs for ever."""
