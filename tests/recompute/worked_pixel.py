#!/usr/bin/python3
"""The worked pixels of docs/arithmetic.md: every number of their tables is computed here, and must be on the page.
Usage: worked_pixel.py TRUESHADE PAGE [--print]"""
import os
import re
import sys
import tempfile

try:
    import numpy as np
except ImportError:
    print("SKIPPED: there is no NumPy (package python3-numpy)")
    sys.exit(0)

import blending
import formats
import host
import recompute
import surfaces
from lights import LightTerm, Viewed, added
from resolved import floats


def single(*values):
    """Floats, in nine digits."""
    return ", ".join("%.9g" % float(np.float32(np.ravel(v)[0])) for v in values)


def double(*values):
    return ", ".join(repr(float(v)) for v in values)


def tuple_of(values):
    return "(" + single(*values) + ")"


class Table:
    def __init__(self):
        self.rows = []

    def add(self, section, quantity, value):
        self.rows.append("| %s | %s | %s |" % (section, quantity, value))


def host_rows(table, scene):
    camera, viewport = scene["camera"], scene["viewport"]
    fov = camera["fov_y_rad"]
    g = 1 / host.tangent(fov / 2)
    assert viewport["width"] == viewport["height"], "m00 = m11"
    near, far = camera["near"], camera["far"]
    table.add(1, "fov, f32; `g = 1 / tan(fov / 2)`, f64", single(fov) + "; " + double(g))
    table.add(1, "`m00 = m11`; `m22`; `m23`, f64",
              "g; %s; %s" % (double((far + near) / (near - far)), double((2 * (far * near)) / (near - far))))


def triangle_rows(table, scene, fragment):
    geometry = scene["geometry"]
    rows = geometry.matrices[fragment.object][0]
    table.add(1, "`clip_from_object`, rows as f32", ", ".join(tuple_of(row) for row in rows))
    for k, corner in enumerate(fragment.corners):
        table.add(2, "clip position of vertex %d" % k, tuple_of(corner[:4]))
    table.add(3, "all have -w <= z <= w: nothing is clipped", "")
    table.add(4, "window coordinates in 1/256 pixel", ", ".join("(%d, %d)" % p for p in fragment.places))
    table.add(4, "sample of the pixel", "(%d, %d)" % fragment.sample)
    table.add(4, "`E_0, E_1, E_2`; `A`, which is above 0: front facing",
              "%d, %d, %d; %d" % (*fragment.edges, fragment.area))
    assert fragment.sign == 1 and min(fragment.edges) > 0
    window = geometry.window
    z = [(c[2] * u) * window.z_scale + window.z_offset for c, u in zip(fragment.corners, fragment.u)]
    b1, b2, _ = fragment.weights("smooth")
    table.add(5, "vertex 0 has the least (y, x); `u_i`, f64", double(*fragment.u))
    table.add(5, "vertex depths `z_i`, f64", double(*z))
    table.add(5, "depth, RN32", single(fragment.depth(window)))
    table.add(5, "`b_1`, `b_2`, f64", double(b1, b2))


def plane_rows(table, scene, surface, planes):
    table.add(5, "position, RN32", tuple_of(surface.position[:3]))
    table.add(5, "normal, RN32", tuple_of(surface.normal[:3]))
    state = scene["pipeline"]["gbuffer"]
    for name in ("position", "normal", "albedo"):
        kind, read = state[name]["format"], getattr(planes, name)[0, :3]
        if kind == "rgba8":
            codes = ", ".join("%d" % c for c in np.rint(read * np.float32(255)))
            table.add(7, "%s codes of rgba8; read back" % name, codes + "; " + tuple_of(read))
        elif kind != "rgba32f":
            table.add(7, "%s as stored in %s" % (name, kind), tuple_of(read))


def light_rows(table, light, term, viewed, model):
    s = term.steps
    table.add(8, "light: position; colour times intensity; range",
              "%s; %s; %s" % (tuple_of(light["position"]), tuple_of(light["color"]), single(light["range"])))
    table.add(8, "`D`", tuple_of(s["D"]))
    table.add(8, "`d2`; `d`; `r`", "; ".join(single(s[k]) for k in ("d2", "d", "r")))
    table.add(8, "`a`; `nl`", single(s["a"]) + "; " + single(s["nl"]))
    table.add(8, "`f` of *%s*" % model["falloff"], single(s["f"]))
    table.add(8, "`L`", tuple_of(s["L"]))
    if model["specular"] == "blinn_phong":
        table.add(8, "`h2`; `nh`; `x`", "; ".join(single(s[k]) for k in ("h2", "nh", "x")))
    else:
        table.add(8, "`m`; `R`; `x`", "%s; %s; %s" % (single(s["m"]), tuple_of(s["R"]), single(s["x"])))
    table.add(9, "`s = x^%d`, f64 rounded once" % s["p"], single(s["s"]))
    formula = "albedo_k*(c + s)" if model["specular_source"] == "albedo" else "(albedo_k*c + 0.25*s)"
    table.add(8, "`%s * (color_k*f)`" % formula, tuple_of(term.color))


def codes_of(color):
    return ", ".join("%d" % c for c in np.rint(color * np.float32(255)).ravel())


def sum_rows(table, scene, viewed, terms):
    """Of a loop: one store."""
    color = viewed.sum_starts()
    for term in terms:
        color = added(color, term.color, term.lit)
    table.add(8, "the sum, one light upon +0: what `pixel.exr` holds as R, G, B and as `light.0000`", tuple_of(color))
    codes = formats.unorm_codes(np.stack(color, axis=1), 255)
    table.add(7, "into rgba8 instead: `RNE(255 x)`", ", ".join("%d" % c for c in codes[0]))
    return formats.stored(viewed.result(color), scene["pipeline"]["target"], "toward_zero")


def volume_rows(table, scene, viewed, terms, times, sample):
    """Of volumes: a store after each light."""
    pipeline = scene["pipeline"]
    now = formats.stored(viewed.result(viewed.sum_starts()), "rgba8", "toward_zero")
    table.add(14, "the base draw stores", codes_of(now))
    lights = scene["drawn_lights"]
    covering = {lights.owner[f.triangle] for f in lights.draw.fragments(sample)}
    for index, (light, term) in enumerate(zip(scene["lights"], terms)):
        times_drawn = int(times[index, 0])
        if times_drawn == 0:
            assert index in covering
            table.add(14, "light %d: back faces alone of its sphere cover the sample, and they are culled" % index, "")
            continue
        assert times_drawn == 1
        table.add(14, "light %d: one front face of its sphere covers the sample" % index, "")
        light_rows(table, light, term, viewed, pipeline["light_model"])
        source = viewed.result(added([np.zeros(1, np.float32)] * 3, term.color, term.lit))
        codes = formats.unorm_codes(source[:, :3], 255)[0]
        now = blending.blended(source, now, pipeline["blend"], "rgba8", "toward_zero")
        table.add(10, "`q(S)`; `min(255, D + q(S))`, alpha kept",
                  "%s; %s" % (", ".join("%d" % c for c in codes), codes_of(now)))
    return now


def worked(command, folder, name, pixel, options):
    """The rows of a pixel, which must end with what the picture holds."""
    scene, picture = recompute.drawn(command, folder, name, options)
    scene = recompute.prepared(scene, None)
    sample = (256 * pixel[0] + 128, 256 * pixel[1] + 128)
    table = Table()
    fragment, depth = surfaces.visible(scene["geometry"].fragments(sample), scene["pipeline"]["geometry"])
    table.add("2-6", "what is visible", "object %d, triangle %d" % (fragment.object, fragment.triangle))
    host_rows(table, scene)
    triangle_rows(table, scene, fragment)
    surface = surfaces.Surface(scene, fragment)
    planes = surfaces.Planes(scene, [surface], [sample], [depth])
    plane_rows(table, scene, surface, planes)
    viewed = Viewed(scene, planes)
    table.add(8, "`V`", tuple_of(viewed.v))
    terms = [LightTerm(viewed, light, False) for light in scene["lights"]]
    model, drawn_lights = scene["pipeline"]["light_model"], scene["drawn_lights"]
    if scene["pipeline"]["strategy"] == "deferred-volumes":
        stored = volume_rows(table, scene, viewed, terms, drawn_lights.times_drawn([sample]), sample)
    else:
        for light, term in zip(scene["lights"], terms):
            light_rows(table, light, term, viewed, model)
        stored = sum_rows(table, scene, viewed, terms)
    assert np.array_equal(stored[0], picture[pixel[1], pixel[0]]), "the picture holds another value"
    return table.rows


def block_of(page, kind, number):
    return re.findall("```%s\n(.*?)```" % kind, page, re.DOTALL)[number]


def main():
    command, path = os.path.abspath(sys.argv[1]), sys.argv[2]
    with open(path, encoding="utf-8") as file:
        page = file.read()
    with tempfile.TemporaryDirectory() as folder:
        for name, kind in (("triangle.ply", "ply"), ("pixel.json", "json")):
            with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
                file.write(block_of(page, kind, 0))
        first = worked(command, folder, os.path.join(folder, "pixel.json"), (4, 4),
                       ["--size", "8x8", "--target", "rgba32f"])
    with tempfile.TemporaryDirectory() as folder:
        second = worked(command, folder, "builtin:cornell,lights=3", (20, 23), ["--size", "64x64", "--preset", "redsdk"])
    lines, missing = page.split("\n"), 0
    for rows in (first, second):
        if "--print" in sys.argv:
            print("\n".join(["| section | quantity | value |", "|---|---|---|"] + rows) + "\n")
        at = next((i for i, line in enumerate(lines) if line == rows[0]), len(lines))
        for k, row in enumerate(rows):
            if lines[at + k : at + k + 1] != [row]:
                print("%s does not have, in this place: %s" % (path, row))
                missing += 1
    print("%d numbers' rows, %d are not on the page" % (len(first) + len(second), missing))
    return 1 if missing else 0


if __name__ == "__main__":
    sys.exit(main())
