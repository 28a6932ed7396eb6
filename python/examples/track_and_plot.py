#!/usr/bin/env python3
"""Scans a source frame by frame, prints the error against the ground truth, and plots the path.

Usage: track_and_plot.py SOURCE [--out DIR] [--frames N] [--set KEY=VALUE]...
SOURCE is any source of `tessera run`: a folder, FILE.oni, openni2:, synthetic:NAME. Writes mesh.ply, trajectory.txt
and, if matplotlib is installed, path.png to DIR.
"""
import argparse
import itertools
import pathlib
import sys

import numpy as np

import tessera


def scan(source, settings, count):
    """Returns the finished scanner, and the ground truth as a Trajectory or None."""
    frames = tessera.frames(source, settings=settings)
    scanner = tessera.Scanner(frames.camera, settings=settings)
    stamps_s, truth = [], []
    for frame in itertools.islice(frames, count):
        result = scanner.track(frame.depth_m, frame.colour, frame.stamp_s, frame.colour_stamp_s)
        if result.status != "good":
            print(f"frame {frame.index}: {result.status}: {result.reason}")
        if frame.T_world_camera is not None:
            stamps_s.append(frame.stamp_s)
            truth.append(frame.T_world_camera)
    for message in scanner.finish():
        print(message)
    return scanner, tessera.Trajectory(np.array(stamps_s), np.array(truth)) if truth else None


def to_first_camera(trajectory):
    """Positions (N, 3) in the frame of the first camera, which is the world frame of a scan."""
    T_first_world = np.linalg.inv(trajectory.T_world_camera[0])
    return (T_first_world @ trajectory.T_world_camera)[:, :3, 3]


def plot(path, estimate, truth):
    try:
        import matplotlib
    except ImportError:
        print("no plot: matplotlib is not installed (apt-get install python3-matplotlib)")
        return
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(figsize=(7, 6), layout="constrained")
    if truth is not None:
        p_truth = to_first_camera(truth)
        axes.plot(p_truth[:, 0], p_truth[:, 2], color="0.6", linewidth=4, label="truth")
    p = to_first_camera(estimate)
    axes.plot(p[:, 0], p[:, 2], color="tab:blue", label="estimate")
    axes.plot(*p[0, [0, 2]], "o", color="tab:blue")
    axes.set(xlabel="x, right (m)", ylabel="z, forward (m)", title="Camera path from above; the dot marks the start")
    axes.set_aspect("equal", adjustable="datalim")
    axes.legend()
    figure.savefig(path, dpi=120)
    print(path)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("source")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("out/python"), metavar="DIR")
    parser.add_argument("--frames", type=int, help="maximum number of frames")
    parser.add_argument("--set", dest="settings", action="append", default=[], metavar="KEY=VALUE")
    arguments = parser.parse_args()
    settings = dict(text.split("=", 1) for text in arguments.settings)

    scanner, truth = scan(arguments.source, settings, arguments.frames)
    estimate = scanner.trajectory()
    if truth is not None:
        ate = tessera.evaluate_ate(truth, estimate, frames=len(truth))
        print(f"ATE RMSE {ate['ate_rmse_m']:.4f} m over {ate['pairs']} poses, SE(3) alignment")
    arguments.out.mkdir(parents=True, exist_ok=True)
    estimate.write(arguments.out / "trajectory.txt")
    mesh = scanner.mesh()
    mesh.write(arguments.out / "mesh.ply")
    print(f"{arguments.out / 'mesh.ply'}: {len(mesh.vertices)} vertices, {len(mesh.triangles)} triangles")
    plot(arguments.out / "path.png", estimate, truth)


if __name__ == "__main__":
    try:
        main()
    except (ValueError, RuntimeError) as error:
        sys.exit(f"track_and_plot.py: {error}")
