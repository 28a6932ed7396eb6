"""A generated bust for [D18] table 3, made of blended spheres, so that no third-party model is shipped."""
import math

# (centre x, y, z, radius) in metres; z up, facing -y.
BALLS = [(0.00, 0.02, 1.02, 0.20), (0.00, -0.03, 0.93, 0.16), (0.00, -0.10, 0.86, 0.09), (0.00, -0.20, 0.98, 0.045),
         (0.00, -0.22, 0.94, 0.05), (0.08, -0.16, 1.06, 0.05), (-0.08, -0.16, 1.06, 0.05), (0.19, 0.03, 0.98, 0.05),
         (-0.19, 0.03, 0.98, 0.05), (0.00, 0.04, 0.72, 0.13), (0.00, 0.05, 0.45, 0.24), (0.26, 0.05, 0.45, 0.17),
         (-0.26, 0.05, 0.45, 0.17), (0.00, 0.03, 0.26, 0.22)]
HEART = (0.0, 0.03, 0.62)  # the whole surface is visible from here: one distance per direction
BLEND_M = 0.05             # width over which two spheres blend
REACH_M = 0.9


def distance(x, y, z):
    """Smooth union of the spheres: negative inside."""
    total = 0.0
    for cx, cy, cz, radius in BALLS:
        away = math.sqrt((x - cx) ** 2 + (y - cy) ** 2 + (z - cz) ** 2) - radius
        total += math.exp(-max(away, -0.5) / BLEND_M * 2)
    return -BLEND_M / 2 * math.log(total + 1e-30)


def radius_along(dx, dy, dz):
    """Distance from HEART to the outermost surface in this direction."""
    def value(r):
        return distance(HEART[0] + r * dx, HEART[1] + r * dy, HEART[2] + r * dz)
    outer, step = REACH_M, 0.02
    while outer > step and value(outer - step) > 0:
        outer -= step
    inner = outer - step
    for _ in range(14):
        middle = (inner + outer) / 2
        inner, outer = (middle, outer) if value(middle) < 0 else (inner, middle)
    return (inner + outer) / 2


def vertices_and_triangles(rows, columns):
    """Pole, `rows` rings of `columns` vertices, pole; triangles counter-clockwise seen from outside."""
    vertices = [(HEART[0], HEART[1], HEART[2] + radius_along(0, 0, 1))]
    for i in range(1, rows + 1):
        polar = math.pi * i / (rows + 1)
        for j in range(columns):
            turn = 2 * math.pi * j / columns
            d = (math.sin(polar) * math.cos(turn), math.sin(polar) * math.sin(turn), math.cos(polar))
            r = radius_along(*d)
            vertices.append(tuple(h + r * k for h, k in zip(HEART, d)))
    vertices.append((HEART[0], HEART[1], HEART[2] - radius_along(0, 0, -1)))
    last = len(vertices) - 1
    triangles = []
    for j in range(columns):
        k = (j + 1) % columns
        triangles.append((0, 1 + j, 1 + k))
        triangles.append((last, last - columns + k, last - columns + j))
        for i in range(rows - 1):
            a, b = 1 + i * columns + j, 1 + i * columns + k
            triangles += [(a, a + columns, b), (b, a + columns, b + columns)]
    return vertices, triangles


def write(path, rows=120, columns=200):
    """Writes an .obj with one object and no material. Returns the centroid of its vertices, the cameras' target."""
    vertices, triangles = vertices_and_triangles(rows, columns)
    lines = ["# bust of blended spheres, metres, z up", "o bust"]
    lines += [f"v {x:.6f} {y:.6f} {z:.6f}" for x, y, z in vertices]
    lines += [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in triangles]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return tuple(sum(v[k] for v in vertices) / len(vertices) for k in range(3))
