"""Rules of docs/arithmetic.md changed by as little as may be: each must be noticed, or the comparison proves nothing.
A rule is the preset, strategy and target under which it is tried, what is changed before a picture is recomputed, and
what puts it right again."""
import math

import numpy as np

import formats
import fragments
import lights
import powers
import strategies
import surfaces

f32 = np.float32


def replaced(module, name, function):
    """A change of one function of a module."""
    before = getattr(module, name)

    def change(_):
        setattr(module, name, function)
        return lambda: setattr(module, name, before)

    return change


def next_float(values, index):
    values[index] = float(np.nextafter(f32(values[index]), f32(np.inf)))


def light_ulp(scene):
    light = scene["lights"][0]
    for color in (light["color"], light["in_model"]["color"]):
        next_float(color, 0)
    return lambda: None


def light_range_ulp(scene):
    light = scene["lights"][0]
    light["range"] = float(np.nextafter(f32(light["range"]), f32(np.inf)))
    return lambda: None


def eye_ulp(scene):
    next_float(scene["camera"]["eye"], 2)
    return lambda: None


def light_order(scene):
    scene["lights"].reverse()
    return lambda: None


def base_color_ulp(scene):
    for material in scene["materials"]:
        next_float(material["base_color"], 1)
    return lambda: None


def sum_from_the_right(a, b):
    return a[0] * b[0] + (a[1] * b[1] + a[2] * b[2])


def power_of_floats(x, p):
    return powers.integer_power(np.asarray(x, f32), int(p))


def truncated_codes(x, largest):
    return np.floor(f32(largest) * formats.clamped(x))


HALF = formats.half


def nearest_half(x, _):
    return HALF(x, "nearest")


def farthest(found, geometry):
    turned = dict(geometry, depth_func="greater", clear_depth=0.0)
    return VISIBLE(found, turned)


VISIBLE = surfaces.visible


def summed_volumes(self, viewed, places):
    """One store of the sum, as loops have it."""
    self.by_loop(viewed, places, len(self.scene["lights"]))


def linear_weights(self, _):
    """As if the window were the scene: without division by w."""
    r = 1 / math.fsum(self.edges)
    return self.edges[1] * r, self.edges[2] * r, r


RULES = {
    "a light is brighter by one unit in the last place": ("many-lights", "deferred-loop", "rgba32f", light_ulp),
    "a light's range is longer by one unit in the last place": ("many-lights", "forward-loop", "rgba32f",
                                                                light_range_ulp),
    "the eye is moved by one unit in the last place": ("touchdesigner", "deferred-loop", "rgba32f", eye_ulp),
    "the lights are summed in the opposite order": ("gl-fixed", "forward-loop", "rgba32f", light_order),
    "base colours are brighter by one unit in the last place": ("lecture", "forward-loop", "rgba32f", base_color_ulp),
    "a dot product is x + (y + z)": ("many-lights", "deferred-loop", "rgba32f",
                                     replaced(lights, "dot3", sum_from_the_right)),
    "powers are products of floats": ("many-lights", "deferred-loop", "rgba32f",
                                                   replaced(powers, "power", power_of_floats)),
    "codes are truncated": ("light-volumes", "deferred-volumes", "rgba8",
                            replaced(formats, "unorm_codes", truncated_codes)),
    "halves are rounded to nearest": ("redsdk", "deferred-loop", "rgba32f", replaced(formats, "half", nearest_half)),
    "the farthest surface is seen": ("many-lights", "deferred-loop", "rgba8", replaced(surfaces, "visible", farthest)),
    "attributes are interpolated without perspective": ("many-lights", "deferred-loop", "rgba8",
                                                        replaced(fragments.Fragment, "weights", linear_weights)),
    "lights are summed where each should be stored": ("light-volumes", "deferred-volumes", "rgba8",
                                                      replaced(strategies.Picture, "by_volumes", summed_volumes)),
}
