"""A capture as `trueshade validate --gbuffer` takes it: an EXR of scan lines, written without a library."""
import array
import os
import struct
import sys


def srgb_decoded(code):
    """The linear value of an 8-bit sRGB code (IEC 61966-2-1)."""
    x = code / 255
    return x / 12.92 if x <= 0.04045 else ((x + 0.055) / 1.055) ** 2.4


CODES_8 = [k / 255 for k in range(256)]
CODES_SRGB = [srgb_decoded(k) for k in range(256)]


def channel_values(kind, texels, k):
    """Component k of texels as they were read back: an array of floats, or of integers for ids.

    kind: "uint" (one 32-bit integer a texel), "depth" (one float), "depth16" (one 16-bit code), "float" (four floats),
    "half" (four halves), "8" and "srgb8" (four bytes), "16" (four 16-bit codes), "10" (R, G, B of ten bits and A of two
    in 32 bits).
    """
    if kind in ("uint", "depth"):
        return array.array("I" if kind == "uint" else "f", bytes(texels))
    if kind == "float":
        return array.array("f", bytes(texels))[k::4]
    if kind == "half":
        return array.array("f", (v for v, in struct.iter_unpack("<e", bytes(texels))))[k::4]
    if kind == "depth16":
        return array.array("f", (code / 65535 for code in array.array("H", bytes(texels))))
    if kind == "16":
        return array.array("f", (code / 65535 for code in array.array("H", bytes(texels))[k::4]))
    if kind == "10":
        most = 3 if k == 3 else 1023
        return array.array("f", ((word >> 10 * k & most) / most for word in array.array("I", bytes(texels))))
    codes = CODES_SRGB if kind == "srgb8" and k < 3 else CODES_8
    return array.array("f", (codes[code] for code in bytes(texels)[k::4]))


def write_exr(path, width, height, channels):
    """channels: name -> array of 'I' or 'f', rows from the lowest, as GPUs hand them out."""
    names = sorted(channels)

    def attribute(name, kind, value):
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value

    listed = b"".join(
        name.encode() + b"\0" + struct.pack("<iiii", 0 if channels[name].typecode == "I" else 2, 0, 1, 1)
        for name in names) + b"\0"
    box = struct.pack("<4i", 0, 0, width - 1, height - 1)
    header = struct.pack("<ii", 20000630, 2) + b"".join([
        attribute("channels", "chlist", listed), attribute("compression", "compression", b"\0"),
        attribute("dataWindow", "box2i", box), attribute("displayWindow", "box2i", box),
        attribute("lineOrder", "lineOrder", b"\0"), attribute("pixelAspectRatio", "float", struct.pack("<f", 1)),
        attribute("screenWindowCenter", "v2f", struct.pack("<ff", 0, 0)),
        attribute("screenWindowWidth", "float", struct.pack("<f", 1))]) + b"\0"
    row_bytes = 4 * width * len(names)
    first = len(header) + 8 * height
    with open(path, "wb") as file:
        file.write(header)
        file.write(struct.pack(f"<{height}Q", *(first + y * (8 + row_bytes) for y in range(height))))
        for y in range(height):
            start = (height - 1 - y) * width
            file.write(struct.pack("<ii", y, row_bytes))
            for name in names:
                file.write(channels[name][start:start + width].tobytes())


def run(main):
    """Calls main(FOLDER, CAPTURE.exr) with the command line's two words. What is wrong with them is one line."""
    if len(sys.argv) != 3:
        print(f"usage: {sys.argv[0]} FOLDER CAPTURE.exr", file=sys.stderr)
        return 2
    state = os.path.join(sys.argv[1], "state.json")
    if not os.path.isfile(state):
        print(f"{state}: there is none (`trueshade glsl SCENE -o FOLDER` writes one)", file=sys.stderr)
        return 3
    try:
        return main(*sys.argv[1:])
    except (KeyError, IndexError, TypeError, ValueError) as error:
        print(f"{state}: not a frame of this program's interface: {error!r} (`trueshade glsl SCENE --api` names it)",
              file=sys.stderr)
        return 3
