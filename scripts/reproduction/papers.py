"""The figures printed in the papers, and the TUM RGB-D folders they were measured on."""

# [B14] table I: ATE RMSE in metres for alpha 0, 0.1, ... 1.0.
ALPHAS = [round(0.1 * i, 1) for i in range(11)]
FR1, FR3 = "rgbd_dataset_freiburg1_", "rgbd_dataset_freiburg3_"
B14_TABLE1 = {
    "fr1 teddy": [.083, .0803, .079, .080, .082, .088, .089, .098, .105, .102, .099],
    "fr3 structure_no_texture": [.040, .040, .040, .039, .039, .039, .039, .039, .039, .039, .038],
    "fr3 no_structure_texture": [1.36, .038, .035, .037, .039, .040, .042, .043, .044, .045, .047],
    "fr3 no_structure_no_texture": [.756, .796, .754, .700, .657, .609, .584, .568, .532, .538, .532],
    "fr1 floor": [.677, .374, .417, .528, .584, .657, .658, .715, .719, .715, .716],
    "fr1 room": [.177, .171, .326, .260, .300, .397, .493, .652, .679, .691, .684],
    "fr1 desk": [.037, .033, .032, .032, .031, .031, .030, .030, .030, .031, .031],
    "fr1 desk2": [.063, .062, .066, .067, .073, .084, .083, .084, .096, .115, .127],
    "fr1 360": [.117, .114, .115, .120, .136, .138, .150, .163, .168, .177, .314],
    "long_office_household": [.087, .062, .057, .054, .054, .052, .051, .051, .052, .051, .053],
}
# If the paper does not say which of two was used, the near one comes first.
FOLDERS = {
    "fr1 teddy": [FR1 + "teddy"],
    "fr3 structure_no_texture": [FR3 + "structure_notexture_near", FR3 + "structure_notexture_far"],
    "fr3 no_structure_texture": [FR3 + "nostructure_texture_near_withloop", FR3 + "nostructure_texture_far"],
    "fr3 no_structure_no_texture": [FR3 + "nostructure_notexture_near_withloop", FR3 + "nostructure_notexture_far"],
    "fr3 structure_texture": [FR3 + "structure_texture_near", FR3 + "structure_texture_far"],
    "fr1 floor": [FR1 + "floor"],
    "fr1 room": [FR1 + "room"],
    "fr1 desk": [FR1 + "desk"],
    "fr1 desk2": [FR1 + "desk2"],
    "fr1 xyz": [FR1 + "xyz"],
    "fr1 360": [FR1 + "360"],
    "long_office_household": [FR3 + "long_office_household"],
}

# [D18] table 1: position in cm, rotation about x, y, z in degrees; over a path of 7.27 m.
D18_TABLE1 = {
    "RMSE": (.4314, .0802, .0820, .0402),
    "Max. error": (.5701, -.0080, .1587, .0785),
    "Min. error": (.0559, -.1352, -.1238, -.0561),
    "Mean error": (.4256, -.0754, .0476, .0181),
    "Median error": (.4325, -.0745, .0593, .0229),
    "Standard dev.": (.0701, .0274, .0668, .0359),
}
D18_TABLE1_RMSE_PERCENT_OF_WAY = 0.59

# [D18] table 2: translation RMSE in metres.
D18_TABLE2_SYSTEMS = ["[D18]", "KinectFusion", "Kintinuous", "ElasticFusion", "ORB-SLAM2", "RGBDTAM"]
D18_TABLE2 = {
    "fr1 desk": [.052, .057, .037, .020, .016, .027],
    "fr1 desk2": [.083, .420, .071, .048, .022, .042],
    "fr1 xyz": [.036, .026, .017, .011, None, .010],
}

# Recordings that [D18] does not have, on the whole recording.
PUBLISHED_ELSEWHERE = {
    "fr1 rpy": "DVO-SLAM has 0.020 and ORB-SLAM3 0.022 there (table 2 of arXiv:2505.19420), DROID-SLAM 0.026.",
    "fr3 teddy": "[B14] has fr1 teddy, which is another recording. We know of no published figure for this part.",
}

# [D18] table 3: vertex to triangle, cm.
D18_TABLE3 = {"Max. error": 6.213, "Mean error": 1.4482, "Standard dev.": 1.1938}

# [D18] table 4: Pt, Pc and probability in percent.
D18_TABLE4 = {
    "computer": [("Computer", 100.00, 100.00, 78.20)],
    "book": [("Book", 40.90, 100.00, 56.22)],
    "cup": [("Cup (up)", 21.00, 100.00, 57.47), ("Cup (down)", 96.15, 100.00, 77.10)],
    "keyboard": [("Keyboard (left)", 11.00, 100.00, 54.54), ("Keyboard (right)", 7.00, 100.00, 52.95)],
    "laptop": [("Laptop", 20.00, 80.00, 56.03)],
}

# [D18] table 5: ms, on a GeForce 960M.
D18_TABLE5 = {"Marching cubes": 8.322, "Fusion": 17.891, "Rasterization": 8.657, "Tracking": 68.417, "TOTAL": 103.297}
