#!/usr/bin/env python3
"""Checks that Open3D reads the written mesh from .ply, .obj and .glb files.

Usage: open3d_reads_meshes.py TESSERA   Runs a small scan with the program, exports it, and reads the files with
Open3D. Exits with 77, which ctest treats as skipped, if Open3D is missing.
"""
import os
import subprocess
import sys
import tempfile

SYSTEM_PYTHON = "/usr/bin/python3"
try:
    import numpy as np
    import open3d as o3d
except ImportError:
    # Debian's package needs Debian's Python, which may not be the first on PATH.
    if os.path.realpath(sys.executable) != os.path.realpath(SYSTEM_PYTHON) and os.path.exists(SYSTEM_PYTHON):
        os.execv(SYSTEM_PYTHON, [SYSTEM_PYTHON, *sys.argv])
    print("skipped: needs Open3D (apt-get install python3-open3d)")
    sys.exit(77)

SMALL_CAMERA = {"width": "160", "height": "120", "fx": "131", "fy": "131", "cx": "79.5", "cy": "59.5"}
SMALL_RUN = ["synthetic:desk", "--frames", "4", "--set", "mapping.voxel_size_m=0.04", "--set",
             "mapping.truncation_m=0.16"]
for key, value in SMALL_CAMERA.items():
    SMALL_RUN += ["--set", f"synthetic.{key}={value}"]
COLOUR_TOLERANCE = 1 / 255
PLACE_TOLERANCE_M = 2e-6  # .obj has six decimals


def srgb(linear):
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * np.maximum(linear, 1e-9) ** (1 / 2.4) - 0.055)


def corners(mesh):
    """The corners of every triangle with their colours, independent of the reader's vertex order."""
    index = np.asarray(mesh.triangles)
    return np.asarray(mesh.vertices)[index], np.asarray(mesh.vertex_colors)[index]


def check(name, mesh, expected, decode=lambda colour: colour):
    vertices = len(expected.vertices)
    assert len(mesh.vertices) == vertices, f"{name}: {len(mesh.vertices)} vertices, not {vertices}"
    assert len(mesh.triangles) == len(expected.triangles), f"{name}: {len(mesh.triangles)} triangles"
    assert mesh.has_vertex_normals() and mesh.has_vertex_colors(), f"{name}: without normals or colours"
    places, colours = corners(mesh)
    expected_places, expected_colours = corners(expected)
    place_error = np.abs(places - expected_places).max()
    colour_error = np.abs(decode(colours) - expected_colours).max()
    print(f"{name}: {len(mesh.vertices)} vertices, off by {place_error:.1e} m, colours by {255 * colour_error:.2f}/255")
    assert place_error <= PLACE_TOLERANCE_M, name
    assert colour_error <= COLOUR_TOLERANCE, name


def upright(mesh):
    """Transforms a .glb mesh into the run's world frame, whether or not the reader applied the node's half turn about x."""
    if np.asarray(mesh.vertices)[:, 2].mean() < 0:  # the scanned scene lies at positive z
        mesh.transform(np.diag([1.0, -1.0, -1.0, 1.0]))
    return mesh


def main(program):
    with tempfile.TemporaryDirectory() as folder:
        def tessera(*arguments):
            subprocess.run([program, *arguments], check=True, cwd=folder, stdout=subprocess.DEVNULL)

        tessera("run", *SMALL_RUN, "--out", "run")
        tessera("export", "run", "--mesh", "m.obj", "--cloud", "c.ply")
        tessera("export", "run", "--mesh", "m.glb")
        expected = o3d.io.read_triangle_mesh(f"{folder}/run/mesh.ply")
        header = open(f"{folder}/run/mesh.ply", "rb").read(1000)
        for element, count in (b"vertex", len(expected.vertices)), (b"face", len(expected.triangles)):
            assert count > 500 and b"element %s %d\n" % (element, count) in header, f".ply: {count} of {element}"
        check(".obj", o3d.io.read_triangle_mesh(f"{folder}/m.obj"), expected)
        check(".glb", upright(o3d.io.read_triangle_mesh(f"{folder}/m.glb")), expected, srgb)
        cloud = o3d.io.read_point_cloud(f"{folder}/c.ply")
        assert np.array_equal(np.asarray(cloud.points), np.asarray(expected.vertices)), "cloud"
        assert np.array_equal(np.asarray(cloud.colors), np.asarray(expected.vertex_colors)), "cloud"
        assert cloud.has_normals(), "cloud"


if __name__ == "__main__":
    main(os.path.abspath(sys.argv[1]))
