"""A run of a bag gives the same bytes as a run of the folder that it was made from. Usage: ... TESSERA"""
import pathlib
import subprocess
import sys
import tempfile

tessera = sys.argv[1]
here = pathlib.Path(__file__).parent
with tempfile.TemporaryDirectory() as name:
    root = pathlib.Path(name)
    subprocess.run([tessera, "synth", "desk", "--frames", "12", "--out", root / "folder"], check=True,
                   stdout=subprocess.DEVNULL)
    made = subprocess.run(["/usr/bin/python3", here / "folder_to_bag.py", root / "folder", root / "made.bag"], check=False)
    if made.returncode == 77:
        print("skipped: needs python3-rosbag, python3-sensor-msgs, python3-numpy and python3-matplotlib")
        sys.exit(77)
    made.check_returncode()
    for source in ("folder", "made.bag"):
        subprocess.run([tessera, "run", root / source, "--out", root / ("out_" + source)], check=True,
                       stdout=subprocess.DEVNULL)
    for file in ("trajectory.txt", "mesh.ply"):
        if (root / "out_folder" / file).read_bytes() != (root / "out_made.bag" / file).read_bytes():
            sys.exit(f"{file} differs")
    info = subprocess.run([tessera, "info", root / "made.bag"], check=True, capture_output=True, text=True).stdout
    for text in ("ROS 1 bag", "12 pairs", "depth from /camera/depth/image, colour from /camera/rgb/image_color"):
        if text not in info:
            sys.exit(f"tessera info does not say {text!r}:\n{info}")
