#!/usr/bin/env python3
"""Pictures of docs/presets.md, docs/strategies.md and docs/pictures.md: ours, OpenGL's, and their difference times 16, side by side.

Usage: comparison_sheets.py COMMAND FOLDER [--driver NAME] [--only SHEET]...
Writes a PNG a preset (rows: scenes), a PNG a scene (rows: strategies), each under 60 kB, and a PNG a preset with every strategy of
two scenes, under 110 kB; prints how far the two pictures are apart and what the judge says. Uses `trueshade render` and `trueshade validate --save`, and nothing but Python's own library."""
import argparse
import json
import os
import struct
import subprocess
import sys
import tempfile
import zlib

SCENES = ["city", "lecture", "atrium"]
SIZE = (160, 120)
# Light models without an end of their own saturate under hundreds of lights, and candelas are dim: the constant damping
# (light_model.damping) with which SCENES are shown; 1 elsewhere.
DAMPING = {
    "touchdesigner": (0.5, 1, 0.6),
    "gl-fixed": (0.4, 2, 0.5),
    "punctual": (20, 2, 1),
    "lecture": (0.004, 1, 0.012),
    "light-volumes-literal": (0.12, 1, 0.2),
    "redsdk": (0.08, 1, 0.09),
}
# Of the sheets of every strategy: scenes small enough for a pass a light, and their damping.
PAIR = ["lecture", "atrium,lights=40"]
PAIR_DAMPING = {"gl-fixed": (2, 1), "punctual": (2, 2), "lecture": (1, 0.07), "redsdk": (1, 0.4)}
GAP = 2
STRIP = 11  # pixels: a line of text
# Columns of 5x7 glyphs, the top pixel in the lowest bit.
GLYPHS = {
    "a": "2054545478", "b": "7f48444438", "c": "3844444420", "d": "384444487f", "e": "3854545418", "f": "087e090102",
    "g": "18a4a4a47c", "h": "7f08040478", "i": "00447d4000", "j": "4080847d00", "k": "7f10284400", "l": "00417f4000",
    "m": "7c04180478", "n": "7c08040478", "o": "3844444438", "p": "fc24242418", "q": "18242424fc", "r": "7c08040408",
    "s": "4854545420", "t": "043f444020", "u": "3c4040207c", "v": "1c2040201c", "w": "3c4030403c", "x": "4428102844",
    "y": "1ca0a0a07c", "z": "4464544c44", "-": "0808080808", "1": "00427f4000", "6": "3c4a494930",
}
MOST_BYTES, MOST_BYTES_OF_PAIR = 60000, 110000


def read_png(path):
    """Rows of (r, g, b), from 8-bit RGB or RGBA without interlacing."""
    data = open(path, "rb").read()
    at, idat = 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        if kind == b"IHDR":
            width, height, depth, color = struct.unpack(">IIBB", body[:10])
            assert depth == 8 and color in (2, 6), "not 8-bit RGB or RGBA"
        if kind == b"IDAT":
            idat += body
        at += 12 + length
    n = 3 if color == 2 else 4
    raw, row, rows = zlib.decompress(idat), bytearray(width * n), []
    for y in range(height):
        start = y * (width * n + 1)
        filtered, above = raw[start], row
        row = bytearray(raw[start + 1:start + 1 + width * n])
        for i in range(width * n):
            a = row[i - n] if i >= n else 0
            b, c = above[i], above[i - n] if i >= n else 0
            if filtered == 1:
                row[i] = (row[i] + a) & 255
            elif filtered == 2:
                row[i] = (row[i] + b) & 255
            elif filtered == 3:
                row[i] = (row[i] + (a + b) // 2) & 255
            elif filtered == 4:
                p = a + b - c
                nearest = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
                row[i] = (row[i] + nearest) & 255
        rows.append([tuple(row[i:i + 3]) for i in range(0, width * n, n)])
    return rows


def palette_of(colors, most):
    """At most so many colours for a count of colours: the box with the largest error is cut at its mean."""
    def measured(box):
        """The squared error of the box shown as its mean, in the channel that has most; the channel; the mean."""
        total = sum(n for _, n in box)
        mean = [sum(c[k] * n for c, n in box) / total for k in range(3)]
        errors = [sum(n * (c[k] - mean[k]) ** 2 for c, n in box) for k in range(3)]
        axis = errors.index(max(errors))
        return errors[axis], axis, mean, box

    boxes = [measured(list(colors.items()))]
    while len(boxes) < most:
        place = max(range(len(boxes)), key=lambda i: boxes[i][0])
        error, axis, mean, box = boxes[place]
        if error == 0:
            break
        boxes[place:place + 1] = [measured([entry for entry in box if (entry[0][axis] > mean[axis]) == above])
                                  for above in (False, True)]
    index, palette = {}, []
    for _, _, mean, box in boxes:
        palette.append(tuple(round(part) for part in mean))
        index.update((c, len(palette) - 1) for c, _ in box)
    return palette, index


def png_bytes(rows, most_colors):
    colors = {}
    for row in rows:
        for c in row:
            colors[c] = colors.get(c, 0) + 1
    palette, index = palette_of(colors, most_colors)
    raw = b"".join(b"\0" + bytes(index[c] for c in row) for row in rows)

    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    header = struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 3, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"PLTE", b"".join(bytes(c) for c in palette)) +
            chunk(b"IDAT", zlib.compress(raw, 9)) + chunk(b"IEND", b""))


def text_strip(texts):
    """A line of text over each column, on white."""
    rows = [[(255, 255, 255)] * (len(texts) * (SIZE[0] + GAP) - GAP) for _ in range(STRIP)]
    for column, text in enumerate(texts):
        for place, letter in enumerate(text):
            for dx, bits in enumerate(bytes.fromhex(GLYPHS.get(letter, "0000000000"))):
                for dy in range(8):
                    if bits >> dy & 1:
                        rows[2 + dy][column * (SIZE[0] + GAP) + 1 + 6 * place + dx] = (40, 40, 40)
    return rows


def write_sheet(path, grid, driver, most_bytes):
    """Rows of a name and its pictures, three a scene, as many colours as the size allows."""
    rows = []
    for name, pictures in grid:
        rows += text_strip([f"{name} - ours", driver, "16 x the difference"] * (len(pictures) // 3))
        for y in range(SIZE[1]):
            row = []
            for picture in pictures:
                row += ([(255, 255, 255)] * GAP if row else []) + picture[y]
            rows.append(row)
    for most in (256, 192, 128, 96, 64, 48, 32):
        data = png_bytes(rows, most)
        if len(data) <= most_bytes:
            break
    open(path, "wb").write(data)
    print(f"{path}: {len(data)} bytes, {most} colours", file=sys.stderr, flush=True)


class Drawer:
    def __init__(self, command, driver, folder):
        self.command, self.driver, self.folder = command, driver, folder

    def row(self, scene, name, options):
        """Ours, theirs, 16 times their difference."""
        options = [f"builtin:{scene}", "--size", f"{SIZE[0]}x{SIZE[1]}"] + options
        ours, theirs = os.path.join(self.folder, "ours.png"), os.path.join(self.folder, "theirs.png")
        for path in (ours, theirs):
            if os.path.exists(path):
                os.remove(path)
        subprocess.run([self.command, "render"] + options + ["-o", ours], check=True, stdout=subprocess.DEVNULL)
        judged = subprocess.run([self.command, "validate"] + options +
                                ["--driver", self.driver, "--quick", "--save", theirs],
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        if not os.path.exists(theirs):
            sys.exit(judged.stderr)
        a, b = read_png(ours), read_png(theirs)
        apart = [[tuple(abs(p[k] - q[k]) for k in range(3)) for p, q in zip(*rows)] for rows in zip(a, b)]
        worst = [max(c) for row in apart for c in row]
        verdict = {0: "every pixel explained", 1: "a pixel is in no legal set"}.get(judged.returncode, "not judged")
        print(f"| {scene} | {name} | {len(worst)} | {sum(w > 0 for w in worst)} | {sum(w > 2 for w in worst)} | {max(worst)} "
              f"| {verdict} |", flush=True)
        return [a, b, [[tuple(min(255, 16 * v) for v in c) for c in row] for row in apart]]


def damped(folder, preset, scene, table=DAMPING):
    """A pipeline file of the damping that a preset is shown with."""
    value = table.get(preset, (1, 1, 1))[scene]
    path = os.path.join(folder, f"{preset}_{value}.json")
    with open(path, "w") as file:
        json.dump({"light_model": {"damping": value}} if value != 1 else {}, file)
    return path


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("command")
    parser.add_argument("folder")
    parser.add_argument("--driver", default="llvmpipe")
    parser.add_argument("--only", action="append")
    given = parser.parse_args()
    known = json.loads(subprocess.run([given.command, "list", "--json"], check=True, stdout=subprocess.PIPE).stdout)
    presets = [row["name"] for row in known["presets"]]
    strategies = [row["name"] for row in known["strategies"]]
    print("| scene | drawn | pixels | that differ | by more than 2 codes | most codes | judged |\n|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as scratch:
        drawer = Drawer(given.command, given.driver, scratch)
        sheets = {f"preset_{p}": [(s, [(s, p, ["--preset", p, "--pipeline", damped(scratch, p, i)])])
                                  for i, s in enumerate(SCENES)] for p in presets}
        sheets.update({f"strategies_{s}": [(t, [(s, t, ["--strategy", t])]) for t in strategies] for s in SCENES})
        for p in presets:
            files = [damped(scratch, p, i, PAIR_DAMPING) for i in range(len(PAIR))]
            sheets[f"every_{p}"] = [(t, [(s, f"{p}, {t}", ["--preset", p, "--strategy", t, "--pipeline", file])
                                         for s, file in zip(PAIR, files)]) for t in strategies]
        for name, rows in sheets.items():
            if not given.only or name in given.only:
                grid = [(told, sum((drawer.row(*drawn) for drawn in frames), [])) for told, frames in rows]
                write_sheet(os.path.join(given.folder, name + ".png"), grid, given.driver,
                            MOST_BYTES_OF_PAIR if name.startswith("every_") else MOST_BYTES)


if __name__ == "__main__":
    main()
