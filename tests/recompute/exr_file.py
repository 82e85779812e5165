"""Reads a single-part EXR of scanlines, ZIP-compressed or not, as Trueshade writes it (openexr.com, file layout)."""
import struct
import zlib

import numpy as np

TYPES = {0: np.dtype("<u4"), 1: np.dtype("<f2"), 2: np.dtype("<f4")}
ROWS_A_BLOCK = {0: 1, 2: 1, 3: 16}  # uncompressed, ZIPS, ZIP


def text_at(data, at):
    end = data.index(b"\0", at)
    return data[at:end].decode(), end + 1


def header(data):
    assert data[:4] == b"\x76\x2f\x31\x01", "no EXR"
    attributes, at = {}, 8
    while data[at] != 0:
        name, at = text_at(data, at)
        _, at = text_at(data, at)
        size = struct.unpack_from("<i", data, at)[0]
        attributes[name] = data[at + 4 : at + 4 + size]
        at += 4 + size
    return attributes, at + 1


def channels_of(attribute):
    channels, at = [], 0
    while attribute[at] != 0:
        name, at = text_at(attribute, at)
        channels.append((name, TYPES[struct.unpack_from("<i", attribute, at)[0]]))
        at += 16
    return channels


def unpacked(block, size):
    """A ZIP block: deflated, each byte the difference to the one before, even bytes in front of odd ones."""
    if len(block) == size:
        return block
    bytes_ = np.frombuffer(zlib.decompress(block), np.uint8).astype(np.int64)
    bytes_[1:] -= 128
    bytes_ = (np.cumsum(bytes_) & 255).astype(np.uint8)
    out = np.empty(size, np.uint8)
    half = (size + 1) // 2
    out[0::2], out[1::2] = bytes_[:half], bytes_[half:]
    return out.tobytes()


def read_exr(path):
    """Channels by name, each [height, width], the top row first."""
    with open(path, "rb") as file:
        data = file.read()
    attributes, at = header(data)
    channels = channels_of(attributes["channels"])
    x0, y0, x1, y1 = struct.unpack("<4i", attributes["dataWindow"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    compression = attributes["compression"][0]
    rows = ROWS_A_BLOCK[compression]
    planes = {name: np.empty((height, width), kind) for name, kind in channels}
    row_bytes = width * sum(kind.itemsize for _, kind in channels)
    for offset in struct.unpack_from("<%dQ" % ((height + rows - 1) // rows), data, at):
        first, size = struct.unpack_from("<ii", data, offset)
        first -= y0
        last = min(first + rows, height)
        block = unpacked(data[offset + 8 : offset + 8 + size], row_bytes * (last - first))
        place = 0
        for row in range(first, last):
            for name, kind in channels:
                planes[name][row] = np.frombuffer(block, kind, width, place)
                place += width * kind.itemsize
    return planes
