"""Makes tables by running tessera: see scripts/reproduce and docs/results/README.md.

jobs        calls of tessera, each with an output folder and a done-file
sources     TUM RGB-D sequences, and the synthetic sequences that replace missing ones
document    Markdown files
trajectories  poses, ATE and per-axis errors, in plain Python
generality  recordings, speeds, trackers and changed constants (constants.txt lists the constants)
bylow, diaz, surface  the papers' tables; papers: the printed figures; bust: the model of [D18] table 3; plots: matplotlib
"""
