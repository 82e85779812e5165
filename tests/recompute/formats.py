"""docs/arithmetic.md section 7: how formats round. Values are f32 arrays [..., 4] or of fewer channels; what a format
stores is kept as what is read back, and unorm formats also give codes."""
from decimal import Decimal, getcontext

import numpy as np

f32 = np.float32
UNORM_BITS = {"rgba8": (8, 8, 8, 8), "rgb10_a2": (10, 10, 10, 2), "rgba16": (16, 16, 16, 16)}


def largest_codes(name):
    return np.array([2**b - 1 for b in UNORM_BITS[name]], dtype=f32)


def clamped(x):
    """To [0, 1]; a value that is no number is 0."""
    return np.where(np.isnan(x), f32(0), np.minimum(np.maximum(x, f32(0)), f32(1))).astype(f32)


def unorm_codes(x, largest):
    return np.rint(f32(largest) * clamped(x))


def half(x, rounding):
    with np.errstate(all="ignore"):
        h = x.astype(np.float16)
    if rounding == "toward_zero":
        bits = h.view(np.uint16)
        with np.errstate(all="ignore"):
            away = (np.abs(h.astype(f32)) > np.abs(x)) & ~np.isnan(x)
        h = np.where(away, bits - 1, bits).astype(np.uint16).view(np.float16)
    return h.astype(f32)


def small_float(x, fraction_bits, rounding):
    """Floats of five bits of exponent without a sign, as those of r11g11b10f."""
    cut = 10 - fraction_bits  # of a half's fraction
    x = np.where((x > 0) | np.isnan(x), x, f32(0)).astype(f32)
    if rounding == "toward_zero":
        bits = half(x, rounding).astype(np.float16).view(np.uint16)
        return np.where(np.isfinite(x), bits >> cut << cut, bits).astype(np.uint16).view(np.float16).astype(f32)
    largest = 2.0 ** 15 * (2 - 2.0**-fraction_bits)
    out = np.empty(x.shape, f32)
    for i, v in enumerate(x.flat):
        if np.isfinite(v):
            exponent = max(int(np.floor(np.log2(v))) if v > 0 else -14, -14)
            unit = 2.0 ** (exponent - fraction_bits)
            out.flat[i] = min(np.rint(float(v) / unit) * unit, largest)
        else:
            out.flat[i] = v
    return out


# --- sRGB --------------------------------------------------------------------------------------------------------

getcontext().prec = 60


def linear_of_srgb(v):
    """IEC 61966-2-1 of a Decimal."""
    if v <= Decimal("0.04045"):
        return v / Decimal("12.92")
    return ((v + Decimal("0.055")) / Decimal("1.055")) ** Decimal("2.4")


def float_of_decimal(v):
    """RN32, of a value that is not next to the middle between two floats."""
    return f32(float(v))


SRGB_VALUES = np.array([float_of_decimal(linear_of_srgb(Decimal(k) / 255)) for k in range(256)], dtype=f32)


def first_float_from(v):
    """The least float whose value is v or above."""
    f = float_of_decimal(v)
    return f if Decimal(float(f)) >= v else np.nextafter(f, f32(2))


SRGB_STARTS = np.array([first_float_from(linear_of_srgb((Decimal(k) + Decimal("0.5")) / 255)) for k in range(255)], f32)


def srgb_codes(x):
    return np.searchsorted(SRGB_STARTS, np.where(np.isnan(x), f32(0), x), side="right")


# --- Planes and targets ------------------------------------------------------------------------------------------


def stored(x, name, half_round):
    """What is read back of values [n, 4] that were stored in a format."""
    if name in ("rgba32f", "rgb32f"):
        return x
    if name in ("rgba16f", "rgb16f"):
        return half(x, half_round)
    if name == "r11g11b10f":
        channels = [small_float(x[:, k], bits, half_round) for k, bits in enumerate((6, 6, 5))]
        return np.stack(channels + [np.ones(len(x), f32)], axis=1)
    if name == "srgb8_a8":
        alpha = unorm_codes(x[:, 3:], 255) / f32(255)
        return np.concatenate([SRGB_VALUES[srgb_codes(x[:, :3])], alpha], axis=1)
    largest = largest_codes(name)
    return (unorm_codes(x, largest) / largest).astype(f32)


def channels_of(name):
    return 3 if name in ("rgb32f", "rgb16f", "r11g11b10f") else 4
