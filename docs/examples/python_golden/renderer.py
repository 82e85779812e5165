"""A small renderer that stands for yours: a ball over a chequered floor under one light, in NumPy.

Only +, -, *, / and square roots, which IEEE 754 rounds the same way on every machine: the picture has the same bits
wherever the tests run. Replace draw() by whatever draws your pictures; an array is all that the tests ask for.
"""

import numpy as np

LIGHT = np.array([3.0, 4.0, 2.0], np.float32)
BALL = np.array([0.0, 0.5, 0.0], np.float32)
RADIUS = np.float32(0.75)
EYE = np.array([0.0, 1.2, 4.0], np.float32)


def dot(a, b):
    return a[..., 0] * b[..., 0] + a[..., 1] * b[..., 1] + a[..., 2] * b[..., 2]


def unit(v):
    return v / np.sqrt(dot(v, v))[..., None]


def rays(width, height):
    """Directions through the centres of the pixels, rows from the top: (height, width, 3), unit length."""
    x = (np.arange(width, dtype=np.float32) + np.float32(0.5)) * np.float32(2 / height) - np.float32(width / height)
    y = np.float32(1) - (np.arange(height, dtype=np.float32) + np.float32(0.5)) * np.float32(2 / height)
    directions = np.empty((height, width, 3), np.float32)
    directions[..., 0], directions[..., 1], directions[..., 2] = x, y[:, None] - np.float32(0.35), np.float32(-2)
    return unit(directions)


def lambert(position, normal):
    """Light that a white surface reflects, falling with the square of the distance."""
    to_light = LIGHT - position
    distance2 = dot(to_light, to_light)
    return np.maximum(dot(normal, unit(to_light)), 0) * np.float32(20) / distance2


def draw(width=96, height=72):
    """The picture: (height, width, 3) of float32, linear light."""
    direction = rays(width, height)
    with np.errstate(divide="ignore", invalid="ignore"):
        to_floor = np.where(direction[..., 1] < 0, (np.float32(-0.25) - EYE[1]) / direction[..., 1], np.float32(np.inf))
        floor = EYE + direction * to_floor[..., None]
        squares = (np.floor(floor[..., 0]) + np.floor(floor[..., 2])) % 2
        floor_light = lambert(floor, np.array([0, 1, 0], np.float32)) * np.where(squares > 0, 0.8, 0.2).astype(np.float32)
        from_ball = EYE - BALL
        b = dot(direction, np.broadcast_to(from_ball, direction.shape))
        under_root = b * b - (dot(from_ball, from_ball) - RADIUS * RADIUS)
        to_ball = np.where(under_root > 0, -b - np.sqrt(np.maximum(under_root, 0)), np.float32(np.inf))
        on_ball = EYE + direction * to_ball[..., None]
        ball_light = lambert(on_ball, (on_ball - BALL) / RADIUS)
    picture = np.empty((height, width, 3), np.float32)
    picture[...] = (0.05, 0.07, 0.1)
    hits_floor, hits_ball = to_floor < 12, to_ball < to_floor
    picture[hits_floor] = floor_light[hits_floor][:, None]
    picture[hits_ball] = ball_light[hits_ball][:, None] * np.array([0.9, 0.4, 0.2], np.float32)
    return picture


def to_bytes(picture):
    """Codes of 8 bits as a simple program stores them: square roots in place of the sRGB curve."""
    return np.floor(np.sqrt(np.clip(picture, 0, 1)) * np.float32(255) + np.float32(0.5)).astype(np.uint8)
