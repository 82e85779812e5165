"""docs/arithmetic.md sections 2 to 4: vertices, clipping, window coordinates, and which triangles cover a sample."""
from fractions import Fraction

import numpy as np

f32 = np.float32
LEAST_W = 2.0**-126


def transformed(rows, points):
    """Rows of a matrix times points [3, n], each `((m0*x + m1*y) + m2*z) + m3` in f32; [n, rows]."""
    x, y, z = points
    with np.errstate(all="ignore"):
        return np.stack([((m[0] * x + m[1] * y) + m[2] * z) + m[3] for m in rows], axis=1)


def rounded_quotients(scale, a, w):
    """RNE(scale * a / w) of the exact quotient, and whether its magnitude is 2^40 or more; f64 arrays. The quotient in
    f64 decides but next to a half, where fractions do."""
    with np.errstate(all="ignore"):
        quotient = (scale * a) / w
        huge = ~(np.abs(quotient) < 2.0**40)
        safe = np.where(huge, 0.0, quotient)
        codes = np.rint(safe).astype(np.int64)
        near_half = np.abs(np.abs(safe - np.floor(safe)) - 0.5) <= np.abs(safe) * 2.0**-50
    for i in np.flatnonzero(near_half & ~huge):
        codes.flat[i] = round(Fraction(scale) * Fraction(float(a.flat[i])) / Fraction(float(w.flat[i])))
    return codes, huge


class Window:
    """Section 4: the viewport and how depth is scaled."""

    def __init__(self, viewport, geometry, depth_clamp=None):
        self.x, self.y = viewport["x"], viewport["y"]
        self.width, self.height = viewport["width"], viewport["height"]
        self.upper_left = geometry["clip_origin"] == "upper_left"
        self.zero_to_one = geometry["clip_depth"] == "zero_to_one"
        self.depth_clamp = geometry["depth_clamp"] if depth_clamp is None else depth_clamp
        near, far = float(geometry["depth_near"]), float(geometry["depth_far"])
        self.z_scale, self.z_offset = (far - near, near) if self.zero_to_one else ((far - near) * 0.5, (near + far) * 0.5)
        self.low, self.high = min(near, far), max(near, far)
        self.offset_factor = float(geometry["polygon_offset_factor"])
        self.offset_units = float(geometry["polygon_offset_units"])
        self.depth_unit = {"d24": 1 / (2.0**24 - 1), "d16": 1 / (2.0**16 - 1)}.get(geometry["depth_format"])
        self.provoking = {"first": 0, "last": 2}[geometry["provoking"]]

    def holds(self, sample):
        """Whether the viewport has the pixel of a sample."""
        i, j = sample[0] // 256 - self.x, sample[1] // 256 - self.y
        return 0 <= i < self.width and 0 <= j < self.height

    def snapped(self, clip):
        """Window coordinates [n, 2] in 1/256 pixel of clip positions [n, 4], and which are too far away to have any."""
        w = clip[:, 3].astype(np.float64)
        up = -1 if self.upper_left else 1
        x, far_x = rounded_quotients(128 * self.width, clip[:, 0].astype(np.float64), w)
        y, far_y = rounded_quotients(up * 128 * self.height, clip[:, 1].astype(np.float64), w)
        codes = np.stack([x + 256 * self.x + 128 * self.width, y + 256 * self.y + 128 * self.height], axis=1)
        return codes, far_x | far_y

    def snapped_point(self, clip):
        """The same of one point."""
        codes, far = self.snapped(np.array([clip[:4]], dtype=np.float64))
        return (int(codes[0, 0]), int(codes[0, 1])), bool(far[0])


# --- Clipping (section 3) ----------------------------------------------------------------------------------------


def planes_of(window):
    """Signed distances of exact clip coordinates to the planes that cut, in their order."""
    planes = []
    if not window.depth_clamp:
        planes.append((lambda p: p[2]) if window.zero_to_one else (lambda p: p[2] + p[3]))
        planes.append(lambda p: p[3] - p[2])
    planes.append(lambda p: p[3] - Fraction(LEAST_W))
    return planes


def cut_by(polygon, distance):
    """The polygon inside a plane. A point is a list of f64: four of clip space, then attributes."""
    exact = [distance([Fraction(c) for c in p[:4]]) for p in polygon]
    kept = []
    for i, (a, da) in enumerate(zip(polygon, exact)):
        b, db = polygon[(i + 1) % len(polygon)], exact[(i + 1) % len(polygon)]
        if da >= 0:
            kept.append(a)
        if (da >= 0) != (db >= 0) and da != 0 and db != 0:
            kept.append([float((Fraction(u) * db - Fraction(v) * da) / (db - da)) for u, v in zip(a, b)])
    return kept


def cut_huge(polygon, window):
    """Section 3, huge polygons: f64."""
    bound = 2.0**31 / max(window.width, window.height)
    for axis in (0, 1):
        for sign in (1, -1):
            distance = [bound * p[3] - sign * p[axis] for p in polygon]
            kept = []
            for i, (p, dp) in enumerate(zip(polygon, distance)):
                q, dq = polygon[(i + 1) % len(polygon)], distance[(i + 1) % len(polygon)]
                if dp >= 0:
                    kept.append(p)
                if (dp >= 0) == (dq >= 0) or dp == 0 or dq == 0:
                    continue
                a, da, b, db = (p, dp, q, dq) if dp >= 0 else (q, dq, p, dp)
                t, s = da / (da - db), db / (db - da)
                point = [u * s + v * t for u, v in zip(a[:4], b[:4])] + [u + (v - u) * t for u, v in zip(a[4:], b[4:])]
                point[axis] = sign * (bound * point[3])
                kept.append(point)
            polygon = kept
            if len(polygon) < 3:
                return []
    return polygon


def fan_of(corners, window):
    """A triangle cut by the planes, as triangles of (point, window coordinates)."""
    polygon = [list(p) for p in corners]
    for distance in planes_of(window):
        if any(distance([Fraction(c) for c in p[:4]]) < 0 for p in polygon):
            polygon = cut_by(polygon, distance)
        if len(polygon) < 3:
            return []
    places = [window.snapped_point(p) for p in polygon]
    if any(far for _, far in places):
        polygon = cut_huge(polygon, window)
        places = [window.snapped_point(p) for p in polygon]
    placed = [(p, place) for p, (place, _) in zip(polygon, places)]
    if len(placed) < 3:
        return []
    first = min(range(len(placed)), key=lambda i: (placed[i][1][1], placed[i][1][0], placed[i][0][3], placed[i][0][2],
                                                   placed[i][0][0], placed[i][0][1]))
    placed = placed[first:] + placed[:first]
    return [(placed[0], placed[i], placed[i + 1]) for i in range(1, len(placed) - 1)]


# --- Coverage (section 4), in Python's integers ------------------------------------------------------------------


def twice_area(a, b, p):
    return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])


def edges_at(places, sample):
    """E_0, E_1, E_2 at the sample."""
    return [twice_area(places[(i + 1) % 3], places[(i + 2) % 3], sample) for i in range(3)]


def covers(places, edges, upper_left):
    """Whether a triangle of area not 0 covers the sample where its edge functions have these values."""
    sign = 1 if sum(edges) > 0 else -1
    for i, e in enumerate(edges):
        if sign * e > 0:
            continue
        if e != 0:
            return False
        (ax, ay), (bx, by) = places[(i + 1) % 3], places[(i + 2) % 3]
        dx, dy = sign * (bx - ax), sign * (by - ay)  # the inside lies to the left of this direction
        inside_right = dy < 0
        inside_above = dy == 0 and dx > 0
        inside_below = dy == 0 and dx < 0
        if not (inside_right or (inside_below if upper_left else inside_above)):
            return False
    return True


def is_culled(counter_clockwise, cull_face, front_face, mirrored, double_sided):
    front = counter_clockwise == (front_face == "ccw")
    if mirrored:
        front = not front
    if double_sided and not front:
        return False
    return cull_face == "front_and_back" or cull_face == ("front" if front else "back")
