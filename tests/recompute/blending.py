"""docs/arithmetic.md section 10: blending. Values are f32 [n, 4]; what a target stores is kept as it is read back."""
import numpy as np

import formats

f32 = np.float32


def factor(name, s, d, constant):
    """[n, 4], or None for ZERO and 1 for ONE."""
    if name in ("zero", "one"):
        return None if name == "zero" else 1
    if name == "src_alpha_saturate":
        rest = f32(1) - d[:, 3]
        f = np.where(s[:, 3] < rest, s[:, 3], rest)
        return np.stack([f, f, f, np.ones_like(f)], axis=1)
    minus, base = name.startswith("one_minus_"), name.removeprefix("one_minus_")
    whole = {"src": s, "dst": d, "constant": constant}[base.split("_")[0]]
    value = np.broadcast_to(whole[:, 3:], whole.shape) if base.endswith("alpha") else whole
    return f32(1) - value if minus else value


def equation(state, s, d, constant):
    if state["equation"] == "min":
        return np.where(s < d, s, d)
    if state["equation"] == "max":
        return np.where(s > d, s, d)
    terms = []
    for value, name in ((s, state["src"]), (d, state["dst"])):
        f = factor(name, s, d, constant)
        terms.append(None if f is None else value if isinstance(f, int) else value * f)
    first, second = terms[::-1] if state["equation"] == "reverse_subtract" else terms
    if first is None and second is None:
        return np.zeros_like(s)
    if second is None:
        return first
    if first is None:
        return second if state["equation"] == "add" else f32(0) - second
    return first + second if state["equation"] == "add" else first - second


def is_sum(state):
    return (state["equation"], state["src"], state["dst"]) == ("add", "one", "one")


def blended(s, d, state, target, half_round):
    """What the target holds after sources s came over d."""
    with np.errstate(all="ignore"):
        return np.where(np.array(state["mask"]), blended_unmasked(s, d, state, target, half_round), d).astype(f32)


def blended_unmasked(s, d, state, target, half_round):
    fixed = target in formats.UNORM_BITS or target == "srgb8_a8"
    if not state["enabled"]:
        return formats.stored(s, target, half_round)
    constant = np.broadcast_to(np.array(state["constant"], f32), s.shape)
    source = formats.clamped(s) if fixed else s
    constant = formats.clamped(constant) if fixed else constant
    if formats.channels_of(target) == 3:
        d = np.append(d[:, :3], np.ones((len(d), 1), f32), axis=1)
    rgb, alpha = (equation(state[group], source, d, constant) for group in ("rgb", "alpha"))
    out = formats.stored(np.append(rgb[:, :3], alpha[:, 3:], axis=1), target, half_round)
    for group, channels in (("rgb", slice(0, 3)), ("alpha", slice(3, 4))):
        if is_sum(state[group]) and (target in formats.UNORM_BITS or (target == "srgb8_a8" and group == "alpha")):
            bits = formats.UNORM_BITS.get(target, (8, 8, 8, 8))
            largest = np.array([2**b - 1 for b in bits], f32)
            codes = np.rint(d * largest) + formats.unorm_codes(s, largest)
            out[:, channels] = (np.minimum(codes, largest) / largest)[:, channels]
    return out
