"""Which triangles of a draw cover a sample, with the numbers that interpolation needs: docs/arithmetic.md sections 3, 4
and 5."""
import math

import numpy as np

import triangles as tri

FAR = 2**29  # 1/256 pixel


class Fragment:
    """A covered sample of one triangle. `corners` are f64 [x, y, z, w, attributes...] in the order of section 5, as
    are `edges`, turned so that `area` is above 0. `provoking`: attributes of that vertex of the triangle submitted."""

    def __init__(self, triangle, placed, sample, counter_clockwise):
        order = min(range(3), key=lambda i: (placed[i][1][1], placed[i][1][0]))
        placed = [placed[(order + i) % 3] for i in range(3)]
        self.triangle, self.counter_clockwise = triangle, counter_clockwise
        self.corners = [p for p, _ in placed]
        self.places = [place for _, place in placed]
        self.sample = sample
        edges = tri.edges_at(self.places, sample)
        self.sign = 1 if sum(edges) > 0 else -1
        self.edges = [float(self.sign * e) for e in edges]
        self.area = float(abs(sum(edges)))
        self.u = [1 / c[3] for c in self.corners]

    def edge_steps(self, dx, dy):
        """What the edge functions grow by over so many 1/256 pixels."""
        x, y = self.sample
        a, b = tri.edges_at(self.places, (x + dx, y + dy)), tri.edges_at(self.places, self.sample)
        return [float(self.sign * (p - q)) for p, q in zip(a, b)]

    def depth(self, window):
        """RN32 of section 5's depth."""
        z = [(c[2] * u) * window.z_scale + window.z_offset for c, u in zip(self.corners, self.u)]
        g1, g2 = (z[1] - z[0]) / self.area, (z[2] - z[0]) / self.area
        first, low, high = z[0], min(z), max(z)
        if window.offset_factor != 0 or window.offset_units != 0:
            o = self.offset(window, z, g1, g2)
            first, low, high = first + o, low + o, high + o
        depth = first + (self.edges[1] * g1 + self.edges[2] * g2)
        depth = min(max(depth, low), high)
        if window.offset_factor != 0 or window.offset_units != 0:
            return np.float32(min(max(depth, window.low), window.high) if window.depth_clamp else min(max(depth, 0), 1))
        return np.float32(min(max(depth, window.low), window.high))

    def offset(self, window, z, g1, g2):
        """Polygon offset."""
        sx, sy = self.edge_steps(256, 0), self.edge_steps(0, 256)
        m = max(abs(sx[1] * g1 + sx[2] * g2), abs(sy[1] * g1 + sy[2] * g2))
        r = window.depth_unit
        if r is None:
            exponent = math.frexp(float(np.float32(max(abs(v) for v in z))))[1] - 1
            r = 2.0 ** (min(max(exponent, -126), 127) - 23)
        return m * window.offset_factor + r * window.offset_units

    def weights(self, interpolation):
        """b_1, b_2 and r."""
        if interpolation == "noperspective":
            r = 1 / self.area
            return self.edges[1] * r, self.edges[2] * r, r
        l = [e * u for e, u in zip(self.edges, self.u)]
        r = 1 / ((l[0] + l[1]) + l[2])
        return l[1] * r, l[2] * r, r

    def attribute(self, index, interpolation="smooth"):
        """RN32 of attribute `index` of the corners."""
        if interpolation == "flat":
            return np.float32(self.provoking[index])
        a = [c[4 + index] for c in self.corners]
        b1, b2, _ = self.weights(interpolation)
        value = a[0] + (b1 * (a[1] - a[0]) + b2 * (a[2] - a[0]))
        return np.float32(min(max(value, min(a)), max(a)))

    def slopes(self, index, interpolation="smooth"):
        """Section 13: the derivatives of an attribute along x and along y, f64."""
        if interpolation == "flat":
            return [0.0, 0.0]
        a = [c[4 + index] for c in self.corners]
        b1, b2, r = self.weights(interpolation)
        out = []
        for step in ((256, 0), (0, 256)):
            e = self.edge_steps(*step)
            if interpolation == "noperspective":
                d1, d2 = e[1] * r, e[2] * r
            else:
                g = [p * u for p, u in zip(e, self.u)]
                whole = (g[0] + g[1]) + g[2]
                d1, d2 = (g[1] - b1 * whole) * r, (g[2] - b2 * whole) * r
            out.append(d1 * (a[1] - a[0]) + d2 * (a[2] - a[0]))
        return out


class Draw:
    """Triangles of clip positions [n, 4], as the window shows them. `attributes(triangle)` gives the attributes of its
    three corners, lists of f64."""

    def __init__(self, clip, triangles, window, attributes):
        self.clip, self.triangles, self.window, self.attributes = clip, triangles, window, attributes
        x, y, z, w = clip.T
        with np.errstate(all="ignore"):
            outside = [w < np.float32(tri.LEAST_W)]
            if not window.depth_clamp:
                outside += [z < 0 if window.zero_to_one else z < -w, z > w]
        left = np.isfinite(clip).all(axis=1)[triangles].all(axis=1)
        inside = left.copy()
        for plane in outside:
            left &= ~plane[triangles].all(axis=1)
            inside &= ~plane[triangles].any(axis=1)
        places, far = window.snapped(np.where(np.isfinite(clip) & ~outside[0][:, None], clip, np.float32(1)))
        far |= (np.abs(places) >= FAR).any(axis=1)  # whose products do not fit into 64 bits
        inside &= ~far[triangles].any(axis=1)
        self.plain = np.flatnonzero(inside)
        self.places = places[triangles[self.plain]]  # [t, 3, 2]
        self.low, self.high = self.places.min(axis=1), self.places.max(axis=1)
        self.fans = []
        for t in np.flatnonzero(left & ~inside):
            fan = tri.fan_of(self.corners(t), window)
            if fan:
                self.fans.append((int(t), fan))

    def corners(self, triangle):
        rows = [[float(c) for c in self.clip[v]] for v in self.triangles[triangle]]
        return [row + list(more) for row, more in zip(rows, self.attributes(triangle))]

    def fragments(self, sample):
        """Fragments at a sample, in the order of the triangles."""
        if not self.window.holds(sample):
            return []
        found = self.plain_fragments(sample)
        for triangle, fan in self.fans:
            fragment = self.fan_fragment(triangle, fan, sample)
            if fragment:
                found.append(fragment)
        found.sort(key=lambda f: f.triangle)
        for f in found:
            f.provoking = self.attributes(f.triangle)[self.window.provoking]
        return found

    def plain_fragments(self, sample):
        at = np.array(sample, dtype=np.int64)
        near = np.flatnonzero(((self.low <= at) & (self.high >= at)).all(axis=1))
        if near.size == 0:
            return []
        p = self.places[near]
        edges = []
        for i in range(3):
            a, b = p[:, (i + 1) % 3], p[:, (i + 2) % 3]
            edges.append((b[:, 0] - a[:, 0]) * (at[1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (at[0] - a[:, 0]))
        edges = np.stack(edges, axis=1)
        area = edges.sum(axis=1)
        possible = (area != 0) & (((edges >= 0).all(axis=1)) | ((edges <= 0).all(axis=1)))
        found = []
        for i in np.flatnonzero(possible):
            places = [(int(v[0]), int(v[1])) for v in p[i]]
            values = [int(e) for e in edges[i]]
            if tri.covers(places, values, self.window.upper_left):
                t = int(self.plain[near[i]])
                turned = (sum(values) > 0) != self.window.upper_left
                found.append(Fragment(t, list(zip(self.corners(t), places)), sample, turned))
        return found

    def fan_fragment(self, triangle, fan, sample):
        areas = [tri.twice_area(*(place for _, place in piece)) for piece in fan]
        facing = 1 if sum(areas) > 0 else -1
        if sum(areas) == 0:
            return None
        count, first = 0, None
        for piece, area in zip(fan, areas):
            places = [place for _, place in piece]
            if area == 0 or not tri.covers(places, tri.edges_at(places, sample), self.window.upper_left):
                continue
            count += 1 if area * facing > 0 else -1
            if area * facing > 0 and first is None:
                first = piece
        if count <= 0:
            return None
        return Fragment(triangle, first, sample, (facing > 0) != self.window.upper_left)
