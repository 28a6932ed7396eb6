#!/usr/bin/env python3
"""tessera plan as a user calls it: the SVG is XML, ezdxf reads the DXF and finds nothing wrong, bad input exits with 2.

Usage: read_plan.py TESSERA   Exits with 77 (skip) if ezdxf is missing, after all other checks.
"""
import json
import pathlib
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

SIDES = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
# One room of 3 m x 2 m whose eastern wall is 20 cm thick.
BOXES = [((-.2, -.2, -.1), (3.2, 2.2, 0)), ((-.2, -.2, 2.5), (3.2, 2.2, 2.6)), ((-.2, -.2, 0), (0, 2.2, 2.5)),
         ((3, -.2, 0), (3.2, 2.2, 2.5)), ((0, -.2, 0), (3, 0, 2.5)), ((0, 2, 0), (3, 2.2, 2.5))]


def write_ply(path, boxes, first=None):
    vertices, faces = [], []
    for low, high in boxes:
        base = len(vertices)
        vertices += [tuple((high if i >> axis & 1 else low)[axis] for axis in range(3)) for i in range(8)]
        faces += [[base + i for i in side] for side in SIDES]
    if first is not None:
        vertices = [first] * len(vertices)
    lines = ["ply", "format ascii 1.0", f"element vertex {len(vertices)}"]
    lines += [f"property float {axis}" for axis in "xyz"]
    lines += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header"]
    lines += [" ".join(str(x) for x in vertex) for vertex in vertices]
    lines += ["4 " + " ".join(str(i) for i in face) for face in faces]
    path.write_text("\n".join(lines) + "\n", encoding="ascii")


def check_bad_input(tessera, folder):
    write_ply(folder / "nan.ply", BOXES, ("nan", "nan", "nan"))
    write_ply(folder / "huge.ply", [tuple(tuple(1e9 * x for x in corner) for corner in box) for box in BOXES])
    write_ply(folder / "empty.ply", [])
    for arguments, word in [(["nan.ply"], "nan.ply"), (["huge.ply"], "huge.ply"), (["empty.ply"], "empty.ply"),
                            (["missing.ply"], "missing.ply"), (["missing.scan"], "missing.scan"),
                            (["nan.ply", "--up", "w"], "--up")]:
        done = subprocess.run([tessera, "plan", *arguments, "--out", "bad"], cwd=folder, capture_output=True, text=True,
                              timeout=60, check=False)
        assert done.returncode == 2, (arguments, done)
        assert word in done.stderr and done.stderr.count("\n") == 1, (arguments, done.stderr)


def main():
    tessera = sys.argv[1]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        write_ply(folder / "room.ply", BOXES)
        title = "a <room> & \"more\" \u00e4"
        subprocess.run([tessera, "plan", "room.ply", "--out", "plan", "--title", title], cwd=folder, check=True,
                       stdout=subprocess.DEVNULL)
        svg = ElementTree.parse(folder / "plan/plan.svg").getroot()
        texts = ["".join(text.itertext()) for text in svg.iter("{http://www.w3.org/2000/svg}text")]
        assert title in texts and "3.00" in texts and "2.00" in texts, texts
        assert "6.00 m\u00b2" in texts or "6.01 m\u00b2" in texts, texts
        plan = json.loads((folder / "plan/plan.json").read_text(encoding="utf-8"))
        assert abs(plan["rooms"][0]["area"] - 6) < 0.02 and abs(plan["ceiling_height"] - 2.5) < 0.005, plan
        # The camera of this run says that -y is up.
        (folder / "run").mkdir()
        write_ply(folder / "run/mesh.ply", BOXES)
        (folder / "run/trajectory.txt").write_text("0 1 1 1 0 0 0 1\n", encoding="ascii")
        subprocess.run([tessera, "plan", "run", "--up", "z", "--out", "plan2"], cwd=folder, check=True,
                       stdout=subprocess.DEVNULL)
        rooms = json.loads((folder / "plan2/plan.json").read_text(encoding="utf-8"))["rooms"]
        assert len(rooms) == 1 and abs(rooms[0]["area"] - 6) < 0.02, rooms
        check_bad_input(tessera, folder)
        try:
            import ezdxf  # pylint: disable=import-outside-toplevel
        except ImportError:
            print("skipped: python3-ezdxf is not installed")
            return 77
        drawing = ezdxf.readfile(folder / "plan/plan.dxf")
        audit = drawing.audit()
        assert not audit.errors, audit.errors
        assert drawing.dxfversion == "AC1009"
        room = drawing.modelspace().query("POLYLINE[layer=='ROOMS']")
        corners = [tuple(vertex.dxf.location)[:2] for vertex in room[0].vertices]
        assert room[0].is_closed and len(corners) == 4, corners
        width = max(x for x, _ in corners) - min(x for x, _ in corners)
        height = max(y for _, y in corners) - min(y for _, y in corners)
        assert abs(width * height - 6) < 0.02, corners
        assert drawing.modelspace().query("TEXT[layer=='DIMENSIONS']")
    return 0


if __name__ == "__main__":
    sys.exit(main())
