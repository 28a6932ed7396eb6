"""How much of each sequence is run."""
import dataclasses

from .papers import ALPHAS


@dataclasses.dataclass(frozen=True)
class Sample:
    """`frames` of each sequence (None: all), the fixed `alphas`, and options of the program for rendered scenes."""
    frames: int | None = None
    alphas: tuple = tuple(ALPHAS)
    camera: tuple = ()


def camera(width, height, focal_px):
    """Options of the program for a smaller camera in rendered scenes, with the principal point in the middle."""
    values = {"width": width, "height": height, "fx": focal_px, "fy": focal_px, "cx": (width - 1) / 2,
              "cy": (height - 1) / 2}
    return tuple(word for key, value in values.items() for word in ("--set", f"synthetic.{key}={value}"))


WHOLE = Sample()
QUICK = Sample(frames=40, alphas=(0.0, 0.1, 1.0))
CHECK = Sample(frames=16, alphas=(0.0, 0.1), camera=camera(320, 240, 262.5))
