"""docs/arithmetic.md section 9: powers, in f64 and rounded once. Arrays of f64."""
import math

import numpy as np


def log2(x):
    m, e = np.frexp(x)  # m in [1/2, 1)
    low = m < math.sqrt(0.5)
    m, e = np.where(low, m * 2, m), np.where(low, e - 1, e)
    s = (m - 1) / (m + 1)
    z = s * s
    p = np.full_like(s, 1 / 21)
    for k in range(19, 0, -2):
        p = p * z + 1 / k
    return (s * (2 / math.log(2))) * p + e


def exp2(t):
    t = np.minimum(t, 1000.0)
    safe = np.maximum(t, -1000.0)
    n = np.copysign(np.floor(np.abs(safe) + 0.5), safe)
    r = (safe - n) * math.log(2)
    e = np.ones_like(r)
    for k in range(13, 0, -1):
        e = e * (r / k) + 1
    return np.where(t < -1000, 0.0, np.ldexp(e, n.astype(np.int64)))


def integer_power(x, p):
    if p == 0:
        return np.ones_like(x)
    result = x
    for bit in bin(p)[3:]:
        result = result * result
        if bit == "1":
            result = result * x
    return result


def power(x, p):
    """x^p of f32 x >= 0 and one exponent, f32."""
    y = np.asarray(x).astype(np.float64)
    with np.errstate(all="ignore"):
        if p == math.floor(p) and 0 <= p <= 8192:
            value = integer_power(y, int(p))
        else:
            value = np.where(y > 0, exp2(p * log2(np.where(y > 0, y, 1.0))), 0.0)
            value = np.where(np.isinf(y), y, value)
        value = np.where(value <= 2.0**-150, 0.0, value)
        return value.astype(np.float32)
