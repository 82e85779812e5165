#!/usr/bin/env python3
"""The contact sheet of docs/looks.md: models of others as one command draws each, beside what Blender shows.

Usage: model_sheets.py COMMAND SHEET.png MODEL... [--columns N] [--pages FOLDER]
Needs Blender and Chromium. Prints a row a model: the share of the picture that is covered, and how bright it is. With
--pages both pictures of each model stay, in FOLDER/trueshade and FOLDER/blender, for `trueshade compare`."""
import argparse
import html
import json
import os
import subprocess
import sys
import tempfile

from comparison_sheets import png_bytes, read_png

SIZE = (144, 108)
SCALE = 2  # pictures are drawn larger, and shown smaller


def command_draws(command, model, picture):
    """What `trueshade render MODEL -o PICTURE` says, and its exit code."""
    size = f"{SIZE[0] * SCALE}x{SIZE[1] * SCALE}"
    return subprocess.run([command, "render", model, "-o", picture, "--size", size, "--samples", "4", "--lenient"],
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)


def camera_of(command, model, folder):
    subprocess.run([command, "info", model, "--lenient", "--size", f"{SIZE[0]}x{SIZE[1]}", "--resolved", "-o", folder],
                   stdout=subprocess.DEVNULL, check=True)
    return json.load(open(os.path.join(folder, "resolved.json")))["camera"]


def luminance(c):
    return (0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]) / 255


def measured(picture):
    """The share of pixels that are not as the picture's upper corner, and the mean and largest luminance of those."""
    rows = read_png(picture)
    light = [luminance(c) for row in rows for c in row if c != rows[0][0]]
    count = len(rows) * len(rows[0])
    return (len(light) / count, sum(light) / len(light), max(light)) if light else (0, 0, 0)


def sheet(cells, columns, path, folder):
    figures = "".join(f"<figure><img src='{html.escape(a)}'><img src='{html.escape(b)}'><figcaption>{html.escape(name)}"
                      "</figcaption></figure>" for name, a, b in cells)
    width = columns * (2 * SIZE[0] + 8) + 8
    rows = -(-len(cells) // columns)
    page = os.path.join(folder, "sheet.html")
    with open(page, "w") as file:
        file.write("<meta charset=utf-8><style>body{margin:4px;background:#fff;display:grid;gap:4px 8px;"
                   f"grid-template-columns:repeat({columns},{2 * SIZE[0]}px)}}figure{{margin:0;font:11px sans-serif}}"
                   f"img{{width:{SIZE[0]}px;height:{SIZE[1]}px;background:#888}}"
                   "figcaption{white-space:nowrap;overflow:hidden;height:14px}</style>" + figures)
    shot = os.path.join(folder, "shot.png")
    subprocess.run(["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars",
                    f"--window-size={width},{rows * (SIZE[1] + 22) + 8}", f"--screenshot={shot}", "file://" + page],
                   check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    with open(path, "wb") as file:
        file.write(png_bytes(read_png(shot), 256))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("command")
    parser.add_argument("sheet")
    parser.add_argument("models", nargs="+")
    parser.add_argument("--columns", type=int, default=4)
    parser.add_argument("--pages")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        folders = [os.path.join(given.pages or scratch, name) for name in ("trueshade", "blender")]
        for folder in folders:
            os.makedirs(folder, exist_ok=True)
        jobs, cells = [], []
        for number, model in enumerate(given.models):
            name = "/".join(model.rsplit("/", 2)[-2:])
            ours, theirs = (os.path.abspath(os.path.join(folder, f"{number:02}.png")) for folder in folders)
            said = command_draws(given.command, model, ours)
            if said.returncode != 0:
                print(f"| {name} | exit {said.returncode} | {said.stdout.strip().splitlines()[-1]} |")
                continue
            covered, mean, most = measured(ours)
            print(f"| {name} | {covered:.2f} | {mean:.2f} | {most:.2f} |", flush=True)
            jobs.append({"model": os.path.abspath(model), "picture": theirs,
                         "camera": camera_of(given.command, model, scratch),
                         "size": [side * SCALE for side in SIZE]})
            cells.append((name, ours, theirs))
        listed = os.path.join(scratch, "jobs.json")
        with open(listed, "w") as file:
            json.dump(jobs, file)
        beside = os.path.join(os.path.dirname(os.path.abspath(__file__)), "blender_view.py")
        # Blender's own Python takes numpy from beside the first python3 on PATH, and the system's has it.
        subprocess.run(["blender", "--background", "--factory-startup", "--python-exit-code", "1", "--python", beside,
                        "--", listed], env={**os.environ, "PATH": os.defpath}, stdout=subprocess.DEVNULL, check=True)
        sheet(cells, given.columns, given.sheet, scratch)


if __name__ == "__main__":
    sys.exit(main())
