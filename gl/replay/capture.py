"""What the readers share: the files of a frame, and the capture for `trueshade validate --gbuffer` that comes of it."""
import array
import json
import pathlib
import struct
import sys

# Layouts of texels in memory: a component as struct has it, how many a texel has, the code that stands for 1.
TEXELS = dict(rgba8=("B", 4, 255), srgb8_a8=("B", 4, 255), rgb10_a2=("I", 1, 1023), rgba16=("H", 4, 65535),
              rgba16f=("e", 4, 1), rgba32f=("f", 4, 1), rgba32ui=("I", 4, 1), r32ui=("I", 1, 1),
              d16=("H", 1, 65535), d32=("I", 1, 2 ** 32 - 1), d32f=("f", 1, 1))


class Frame:
    """The files in a folder: state.json, the pictures in it by their names, and the bytes of its buffers."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.state = json.loads((self.folder / "state.json").read_text())
        self.data = (self.folder / self.state["file"]).read_bytes()
        self.pictures = {picture["name"]: picture for picture in self.state["pictures"]}

    def bytes_of(self, block):
        return self.data[block["offset"]:block["offset"] + block["bytes"]]


def texel_bytes(layout):
    letter, components, _ = TEXELS[layout]
    return struct.calcsize(letter) * components


def channel(layout, texels, k):
    """Component k of texels that were read back, as floats; of ids, as integers. sRGB is decoded (IEC 61966-2-1)."""
    letter, components, one = TEXELS[layout]
    codes = struct.unpack(f"<{len(texels) // struct.calcsize(letter)}{letter}", texels)[k % components::components]
    if layout.endswith("32ui"):
        return array.array("I", codes)
    if layout == "rgb10_a2":
        codes, one = [code >> 10 * k & 1023 for code in codes], 1023 if k < 3 else 3
    values = (code / one for code in codes)
    if layout == "srgb8_a8" and k < 3:
        values = (x / 12.92 if x <= 0.04045 else ((x + 0.055) / 1.055) ** 2.4 for x in values)
    return array.array("f", values)


def write_exr(path, width, height, channels):
    """An EXR of scan lines. channels: name -> array of 'I' or 'f', rows from the lowest, as GPUs hand them out."""
    def attribute(name, kind, *values):
        value = b"".join(values)
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value

    names = sorted(channels)  # as EXR wants them
    listed = [name.encode() + b"\0" + struct.pack("<4i", 0 if channels[name].typecode == "I" else 2, 0, 1, 1)
              for name in names]
    box, one, zero = struct.pack("<4i", 0, 0, width - 1, height - 1), struct.pack("<f", 1), b"\0"
    header = struct.pack("<ii", 20000630, 2) + b"".join([
        attribute("channels", "chlist", *listed, zero), attribute("compression", "compression", zero),
        attribute("dataWindow", "box2i", box), attribute("displayWindow", "box2i", box),
        attribute("lineOrder", "lineOrder", zero), attribute("pixelAspectRatio", "float", one),
        attribute("screenWindowCenter", "v2f", bytes(8)), attribute("screenWindowWidth", "float", one), zero])
    row_bytes = 4 * width * len(names)
    first = len(header) + 8 * height
    with open(path, "wb") as file:
        file.write(header + struct.pack(f"<{height}Q", *range(first, first + height * (8 + row_bytes), 8 + row_bytes)))
        for y in range(height):
            start = (height - 1 - y) * width
            file.write(struct.pack("<ii", y, row_bytes))
            file.writelines(channels[name][start:start + width].tobytes() for name in names)


def run(open_replay, apis):
    """Draws the command line's FOLDER and writes its CAPTURE.exr. open_replay(frame): what draws the frame's passes."""
    if len(sys.argv) != 3:
        sys.exit(f"usage: {sys.argv[0]} FOLDER CAPTURE.exr")
    try:
        frame = Frame(sys.argv[1])
    except (OSError, KeyError, ValueError) as error:
        sys.exit(f"{sys.argv[1]}: not what `trueshade glsl SCENE -o FOLDER` writes: {error!r}")
    if frame.state["api"] not in apis:
        sys.exit(f"{sys.argv[1]}: written for {frame.state['api']}, and this draws what is written for {apis}")
    try:
        replay = open_replay(frame)
    except OSError as error:
        print(f"SKIPPED: {error}", file=sys.stderr)
        sys.exit(7)
    for draw_pass in frame.state["passes"]:
        replay.draw_pass(draw_pass)
    channels = {}
    for picture in (p for p in frame.pictures.values() if "capture" in p):
        texels = replay.texels_of(picture)
        channels |= {name: channel(picture["layout"], texels, k) for k, name in enumerate(picture["capture"])}
    write_exr(sys.argv[2], *frame.pictures["target"]["size"], channels)
