"""Makes tables by running tessera: see scripts/reproduce and docs/results/README.md.

jobs        calls of tessera, each with an output folder and a done-file
sample      how much of each sequence is run
sources     recordings, and the synthetic sequences that replace missing ones
document    Markdown files; index: the list of tables that one program made
figures     the figures of one run
check       a few small runs against expected.json
trajectories  poses, ATE and per-axis errors, in plain Python
generality  recordings, speeds, trackers and changed constants (constants.txt lists the constants)
bylow, diaz, surface, presets, pictures  the papers' tables and pictures; papers: the printed figures; bust: the model of
            [D18] table 3; plots: matplotlib
"""
