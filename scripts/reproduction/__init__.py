"""Tables, each made by running tessera: see scripts/reproduce and docs/results/README.md.

jobs        one call of tessera with an output folder and a done-file
sources     TUM RGB-D sequences, and the synthetic sequences that stand in for them
document    Markdown
trajectories  poses, ATE and per-axis errors, in plain Python
generality  recordings, speeds, trackers and changed constants; constants.txt: which
bylow, diaz, surface  the papers' tables; papers: the printed figures; bust: the model of [D18] table 3; plots: matplotlib
"""
