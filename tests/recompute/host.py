"""docs/arithmetic.md section 1: what is made of angles and matrices before a frame, in f64. Python's floats are f64,
and their + - * / and math.sqrt are one IEEE rounding each."""
import math

import numpy as np

PI = math.pi
f32 = np.float32


def reduced(x):
    """The rest of an angle and its quadrant; `round` takes halves away from zero."""
    p1, p2 = 1.5707963267341256, 6.077100506506192e-11
    n = math.copysign(math.floor(abs(x * (2 / PI)) + 0.5), x)
    return (x - n * p1) - n * p2, int(n) & 3


def taylor(r, first, last):
    """1/first! - r^2/(first + 2)! + ... up to r^last, by Horner from the highest term."""
    z, p = r * r, 0.0
    for k in range(last, first - 1, -2):
        p = p * z + (-1) ** ((k - first) // 2) * (1 / math.factorial(k))
    return p


def sine(x):
    r, quadrant = reduced(x)
    magnitude = taylor(r, 0, 16) if quadrant & 1 else taylor(r, 1, 17) * r
    return -magnitude if quadrant & 2 else magnitude


def cosine(x):
    r, quadrant = reduced(x)
    magnitude = taylor(r, 1, 17) * r if quadrant & 1 else taylor(r, 0, 16)
    return -magnitude if quadrant in (1, 2) else magnitude


def tangent(x):
    return sine(x) / cosine(x)


def dot(a, b):
    return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(v):
    length2 = dot(v, v)
    if not length2 > 0:
        return list(v)
    r = 1 / math.sqrt(length2)
    return [c * r for c in v]


def product(a, b):
    """Of two matrices of four columns; rows of a, and of b."""
    return [
        [((row[0] * b[0][c] + row[1] * b[1][c]) + row[2] * b[2][c]) + row[3] * b[3][c] for c in range(4)] for row in a
    ]


def rounded(matrix):
    return np.array(matrix, dtype=np.float64).astype(f32)


def clip_from_world(camera, viewport, clip_depth):
    """The camera's matrix, f64."""
    f = [float(v) for v in camera["target"]]
    eye, up = [float(v) for v in camera["eye"]], [float(v) for v in camera["up"]]
    f = unit([f[k] - eye[k] for k in range(3)])
    s = unit(cross(f, up))
    u = cross(s, f)
    rows = [s, u, [-c for c in f]]
    view = [list(row) + [-dot(row, eye)] for row in rows] + [[0.0, 0.0, 0.0, 1.0]]
    aspect = viewport["width"] / viewport["height"]
    if camera["fov_x_rad"] is None:
        g = 1 / tangent(float(camera["fov_y_rad"]) / 2)
        m00, m11 = g / aspect, g
    else:
        g = 1 / tangent(float(camera["fov_x_rad"]) / 2)
        m00, m11 = g, g * aspect
    near, far = float(camera["near"]), float(camera["far"])
    if clip_depth == "zero_to_one":
        m22, m23 = far / (near - far), (far * near) / (near - far)
    else:
        m22, m23 = (far + near) / (near - far), (2 * (far * near)) / (near - far)
    return product([[m00, 0, 0, 0], [0, m11, 0, 0], [0, 0, m22, m23], [0, 0, -1, 0]], view)


def normal_from_object(world_from_object):
    a = [[float(world_from_object[r][c]) for r in range(3)] for c in range(3)]  # columns
    rows = [cross(a[1], a[2]), cross(a[2], a[0]), cross(a[0], a[1])]
    det = dot(a[0], rows[0])
    columns = [[rows[c][r] for c in range(3)] for r in range(3)]
    return rounded([[v / det for v in row] for row in columns] if det != 0 else columns)


def unit_mesh(extent, slices, stacks):
    """Section 14: the vertices of a mesh of range 1."""
    def turn(k):
        return 2 * PI * k / slices

    if extent == "box":
        return [[1.0 if i & 1 else -1.0, 1.0 if i & 2 else -1.0, 1.0 if i & 4 else -1.0] for i in range(8)]
    if extent == "cone":
        return [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0]] + [[cosine(turn(k)), sine(turn(k)), 1.0] for k in range(slices)]
    points = [[0.0, 0.0, 1.0]]
    for i in range(1, stacks):
        polar = PI * i / stacks
        points += [[sine(polar) * cosine(turn(k)), sine(polar) * sine(turn(k)), cosine(polar)] for k in range(slices)]
    return points + [[0.0, 0.0, -1.0]]


def light_vertices(light, extent, unit_vertices):
    """Section 14: the vertices of a light's mesh, f32."""
    reach = float(light["range"])
    a, b, c = [reach, 0.0, 0.0], [0.0, reach, 0.0], [0.0, 0.0, reach]
    if extent == "cone":
        axis = unit([float(v) for v in light["direction"]])
        least = min(range(3), key=lambda k: abs(axis[k]))
        e = [1.0 if k == least else 0.0 for k in range(3)]
        radius = reach * tangent(float(light["cone_rad"]) + float(light["penumbra_rad"]))
        across = unit(cross(e, axis))
        a, b = [v * radius for v in across], [v * radius for v in cross(axis, across)]
        c = [v * reach for v in axis]
    place = [float(v) for v in light["position"]]
    return rounded([[place[k] + ((a[k] * u[0] + b[k] * u[1]) + c[k] * u[2]) for k in range(3)] for u in unit_vertices])
