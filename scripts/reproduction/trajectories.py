"""Trajectories in TUM format and their errors, in plain Python from the definitions: a second, slow implementation,
which tests compare with src/eval.

Poses are (stamp_s, (tx, ty, tz), (qx, qy, qz, qw)), camera to world, metres.
"""
import math
import statistics


def read(path):
    """The poses of a TUM file, in file order. Raises ValueError with the line number."""
    poses = []
    with open(path, encoding="utf-8") as file:
        for row, line in enumerate(file, 1):
            if line.startswith("#") or not line.strip():
                continue
            try:
                values = [float(word) for word in line.replace(",", " ").split()[:8]]
                stamp, x, y, z, *q = values
                norm = math.sqrt(sum(k * k for k in q))
                poses.append((stamp, (x, y, z), tuple(k / norm for k in q)))
            except (ValueError, ZeroDivisionError):
                raise ValueError(f"{path}:{row}: expected stamp tx ty tz qx qy qz qw") from None
    return poses


def associate(reference, estimate, max_gap_s=0.02):
    """Pairs (reference pose, estimated pose): closest in time first, each used once, like TUM's associate.py."""
    near = []
    for j, (stamp, *_) in enumerate(estimate):
        near += [(abs(stamp - pose[0]), i, j) for i, pose in enumerate(reference) if abs(stamp - pose[0]) < max_gap_s]
    pairs, used_i, used_j = [], set(), set()
    for _, i, j in sorted(near):
        if i not in used_i and j not in used_j:
            used_i.add(i)
            used_j.add(j)
            pairs.append((j, reference[i], estimate[j]))
    return [(a, b) for _, a, b in sorted(pairs)]


def rotate(q, v):
    """The unit quaternion q = (x, y, z, w) applied to v."""
    x, y, z, w = q
    t = (2 * (y * v[2] - z * v[1]), 2 * (z * v[0] - x * v[2]), 2 * (x * v[1] - y * v[0]))
    return (v[0] + w * t[0] + y * t[2] - z * t[1], v[1] + w * t[1] + z * t[0] - x * t[2],
            v[2] + w * t[2] + x * t[1] - y * t[0])


def multiply(a, b):
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz)


def inverse(q):
    return (-q[0], -q[1], -q[2], q[3])


def difference(a, b):
    return tuple(x - y for x, y in zip(a, b))


def centre(points):
    return tuple(sum(p[k] for p in points) / len(points) for k in range(3))


def align(points, targets):
    """The rotation (quaternion) and translation that align `points` to `targets` in least squares: Horn 1987."""
    mean_p, mean_t = centre(points), centre(targets)
    s = [[0.0] * 3 for _ in range(3)]
    for p, t in zip(points, targets):
        dp, dt = difference(p, mean_p), difference(t, mean_t)
        for i in range(3):
            for j in range(3):
                s[i][j] += dp[i] * dt[j]
    (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = s
    n = [[xx + yy + zz, yz - zy, zx - xz, xy - yx],
         [yz - zy, xx - yy - zz, xy + yx, zx + xz],
         [zx - xz, xy + yx, yy - xx - zz, yz + zy],
         [xy - yx, zx + xz, yz + zy, zz - xx - yy]]
    w, x, y, z = largest_eigenvector(n)
    q = (x, y, z, w)
    return q, difference(mean_t, rotate(q, mean_p))


def largest_eigenvector(matrix):
    """For a symmetric 4 x 4 matrix, by Jacobi rotations."""
    a, v = [row[:] for row in matrix], [[float(i == j) for j in range(4)] for i in range(4)]
    for _ in range(60):
        off, p, q = max((abs(a[i][j]), i, j) for i in range(4) for j in range(i + 1, 4))
        if off <= 1e-16 * max(abs(a[i][i]) for i in range(4)):
            break
        angle = 0.5 * math.atan2(2 * a[p][q], a[q][q] - a[p][p])
        c, s = math.cos(angle), math.sin(angle)
        for m, rows in ((a, False), (v, False), (a, True)):
            for k in range(4):
                if rows:
                    m[p][k], m[q][k] = c * m[p][k] - s * m[q][k], s * m[p][k] + c * m[q][k]
                else:
                    m[k][p], m[k][q] = c * m[k][p] - s * m[k][q], s * m[k][p] + c * m[k][q]
    best = max(range(4), key=lambda k: a[k][k])
    return [v[k][best] for k in range(4)]


def ate(reference, estimate):
    """TUM's absolute trajectory error after SE(3) alignment without scale: one distance in metres per pair."""
    pairs = associate(reference, estimate)
    if len(pairs) < 3:
        raise ValueError(f"only {len(pairs)} poses have a reference pose within 0.02 s")
    points, targets = [b[1] for _, b in pairs], [a[1] for a, _ in pairs]
    q, t = align(points, targets)
    return [math.dist(tuple(r + o for r, o in zip(rotate(q, p), t)), target) for p, target in zip(points, targets)]


def rms(values):
    return math.sqrt(sum(x * x for x in values) / len(values))


def errors_from_first(reference, estimate):
    """As in [D18] 4.1: both trajectories start at the same pose, without further alignment. Returns rows (seconds from
    the start, position error in metres, (x, y, z) of the rotation error vector in camera axes in degrees)."""
    pairs = associate(reference, estimate)
    (first_stamp, t_a, q_a), (_, t_b, q_b) = pairs[0]
    rows = []
    for (stamp, ta, qa), (_, tb, qb) in pairs:
        true_t, true_q = rotate(inverse(q_a), difference(ta, t_a)), multiply(inverse(q_a), qa)
        our_t, our_q = rotate(inverse(q_b), difference(tb, t_b)), multiply(inverse(q_b), qb)
        x, y, z, w = multiply(inverse(true_q), our_q)
        sine = math.sqrt(x * x + y * y + z * z)
        scale = math.degrees(2 * math.atan2(sine, abs(w)) / sine) if sine > 0 else 0.0
        scale = -scale if w < 0 else scale
        rows.append((stamp - first_stamp, math.dist(true_t, our_t), (x * scale, y * scale, z * scale)))
    return rows


def statistics_of(values):
    """The rows of [D18] table 1."""
    return {"RMSE": rms(values), "Max. error": max(values), "Min. error": min(values),
            "Mean error": statistics.fmean(values), "Median error": statistics.median(values),
            "Standard dev.": statistics.pstdev(values)}


def path_length(poses):
    return sum(math.dist(a[1], b[1]) for a, b in zip(poses, poses[1:]))
