"""docs/arithmetic.md section 13: lookups of textures, in f64 and rounded once. Python's floats are f64."""
import math

import numpy as np

import formats
import powers

f32 = np.float32


def texel_of(texture, level, x, y):
    """Four f32."""
    codes = texture["levels"][level][y, x]
    if texture["format"] == "rgba8":
        return codes.astype(f32) / f32(255)
    if texture["format"] == "srgb8_a8":
        return np.append(formats.SRGB_VALUES[codes[:3]], f32(codes[3]) / f32(255))
    if texture["format"] == "rgba16f":
        return codes.view(np.float16).astype(f32)
    return codes


def wrapped(i, n, wrap):
    """The texel of an index, or None for the border."""
    if wrap == "repeat":
        return i % n
    if wrap == "mirrored_repeat":
        k = i % (2 * n)
        return k if k < n else 2 * n - 1 - k
    if wrap == "clamp_to_border":
        return i if 0 <= i < n else None
    if wrap == "mirror_clamp_to_edge" and i < 0:
        i = -1 - i
    return min(max(i, 0), n - 1)


def coordinate(u, wrap):
    if abs(u) < 2.0**24:
        return u
    return 0.0 if wrap in ("repeat", "mirrored_repeat") else math.copysign(2.0**24, u)


def mix(a, b, w):
    return (1 - w) * a + w * b


def level_value(texture, lookup, level, u, v, filter_name):
    """Four f64."""
    height, width, _ = texture["levels"][level].shape

    def texel(i, j):
        x, y = wrapped(i, width, lookup["wrap"][0]), wrapped(j, height, lookup["wrap"][1])
        return formats_of(texture, lookup, level, x, y)

    p, q = coordinate(u, lookup["wrap"][0]) * width, coordinate(v, lookup["wrap"][1]) * height
    if filter_name == "nearest":
        return texel(math.floor(p), math.floor(q))
    p, q = p - 0.5, q - 0.5
    i, j = math.floor(p), math.floor(q)
    a, b = p - i, q - j
    low = mix(texel(i, j), texel(i + 1, j), a)
    high = mix(texel(i, j + 1), texel(i + 1, j + 1), a)
    return mix(low, high, b)


def formats_of(texture, lookup, level, x, y):
    if x is None or y is None:
        return np.array(lookup["border"], dtype=np.float64)
    return texel_of(texture, level, x, y).astype(np.float64)


def level_of_detail(texture, lookup, along_x, along_y):
    height, width, _ = texture["levels"][0].shape
    rho2 = max((d[0] * width) * (d[0] * width) + (d[1] * height) * (d[1] * height) for d in (along_x, along_y))
    rho2 = min(max(rho2, 2.0**-1000), 2.0**1000)
    lod = 0.5 * float(powers.log2(np.array(rho2))) + float(lookup["lod_bias"])
    return min(max(lod, float(lookup["lod_min"])), float(lookup["lod_max"]))


def looked_up(scene, lookup, uv, along_x, along_y):
    """Four f32 of a map at (u, v), two f32; along_x and along_y are the derivatives of both, f64."""
    texture = scene["textures"][lookup["texture"]]
    u, v = float(uv[0]), float(uv[1])
    last = len(texture["levels"]) - 1
    lod = level_of_detail(texture, lookup, along_x, along_y)
    if lod <= 0:
        value = level_value(texture, lookup, 0, u, v, lookup["mag_filter"])
    elif lookup["mip_filter"] == "none":
        value = level_value(texture, lookup, 0, u, v, lookup["min_filter"])
    elif lookup["mip_filter"] == "nearest":
        level = math.floor(lod) + (1 if lod - math.floor(lod) > 0.5 else 0)
        value = level_value(texture, lookup, min(level, last), u, v, lookup["min_filter"])
    else:
        level = math.floor(lod)
        low = level_value(texture, lookup, min(level, last), u, v, lookup["min_filter"])
        high = level_value(texture, lookup, min(level + 1, last), u, v, lookup["min_filter"])
        value = mix(low, high, lod - level)
    return (value + 0.0).astype(f32)
