"""Reads what `trueshade info SCENE --resolved -o FOLDER` writes: docs/resolved.md."""
import json
import os

import numpy as np

f32 = np.float32


DOUBLES = ("clip_from_world", "unit_vertices", "time")  # the only numbers that are no floats
LEFT_TO_ARRAYS = ("objects", "light_meshes")  # long lists, which floats() below rounds


def as_floats(value):
    """The document with each number a float's: a reader of JSON gives the double next to the digits."""
    if isinstance(value, dict):
        return {key: part if key in DOUBLES + LEFT_TO_ARRAYS else as_floats(part) for key, part in value.items()}
    if isinstance(value, list):
        return [as_floats(part) for part in value]
    return float(f32(value)) if isinstance(value, float) else value


def read_scene(folder):
    """The document, its arrays as NumPy arrays."""
    with open(os.path.join(folder, "resolved.json"), encoding="utf-8") as file:
        scene = as_floats(json.load(file))
    assert scene["version"] == 1
    path = os.path.join(folder, scene["file"])

    def array(place):
        if place is None:
            return None
        shape = tuple(place["shape"])
        if 0 in shape:
            return np.zeros(shape, place["type"])
        return np.memmap(path, np.dtype(place["type"]).newbyteorder("<"), "r", place["offset"], shape)

    for mesh in scene["meshes"]:
        for stream in ("position", "normal", "color", "tangent", "triangles"):
            mesh[stream] = array(mesh[stream])
        mesh["uv"] = [array(uv) for uv in mesh["uv"]]
    for texture in scene["textures"]:
        texture["levels"] = [array(level) for level in texture["levels"]]
    for light in scene["lights"]:
        if "vertices" in light:
            light["vertices"] = array(light["vertices"])
    return scene


def floats(numbers):
    """Floats of a list, or of a list of lists: each number is a float's, so that rounding it changes nothing."""
    return np.array(numbers, dtype=np.float64).astype(f32)
