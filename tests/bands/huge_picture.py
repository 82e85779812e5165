"""A picture of 4.3 gigapixels against its 64 regions: `huge_picture.py TRUESHADE [SIDE]`. Minutes; ./check long runs it
with a smaller side. Prints the figures that docs/large_pictures.md has.

The picture is drawn in bands below 2 GiB. Then each of 8 x 8 regions is drawn by a process of its own as raw codes, and
their rows, put side by side, are hashed by hashlib: nothing of the program's own puts them together."""
import hashlib
import os
import subprocess
import sys
import tempfile
import time

SCENE = "builtin:city"
PARTS = 8


def check(condition, what):
    if not condition:
        sys.exit("huge_picture.py: " + what)


def drawn_in_bands(command, side, folder):
    """(hash, peak MiB, seconds) of the picture, drawn into a PNG."""
    start = time.monotonic()
    process = subprocess.Popen([command, "render", SCENE, "--size", f"{side}x{side}", "--max-memory", "2G", "-q", "--hash",
                                "-o", os.path.join(folder, "huge.png")], stdout=subprocess.PIPE)
    text = process.stdout.read().decode()
    _, status, usage = os.wait4(process.pid, 0)
    check(status == 0, "the picture was not drawn")
    return text.split()[0].removeprefix("sha256:"), usage.ru_maxrss / 1024, time.monotonic() - start


def region_rows(command, side, column, row, rows_at_once):
    """Generates the bytes of a region, some rows at a time."""
    width = side // PARTS
    process = subprocess.Popen([command, "render", SCENE, "--size", f"{side}x{side}", "--region",
                                f"{column * width},{row * width},{width}x{width}", "--threads", "1", "-q", "--raw-video",
                                "-o", "-"], stdout=subprocess.PIPE)
    for _ in range(0, width, rows_at_once):
        yield process.stdout.read(rows_at_once * width * 4)
    check(process.wait() == 0, "a region was not drawn")


def of_regions(command, side):
    """The hash of the regions' rows."""
    digest = hashlib.sha256()
    width = side // PARTS
    for row in range(PARTS):
        strips = zip(*(region_rows(command, side, column, row, 1) for column in range(PARTS)))
        for pieces in strips:
            for piece in pieces:
                check(len(piece) == width * 4, "a region is too short")
                digest.update(piece)
    return digest.hexdigest()


def main():
    command = sys.argv[1]
    side = int(sys.argv[2]) if len(sys.argv) > 2 else 65536
    with tempfile.TemporaryDirectory() as folder:
        of_picture, peak, seconds = drawn_in_bands(command, side, folder)
        size = os.path.getsize(os.path.join(folder, "huge.png"))
    print(f"{side} x {side}: {of_picture}")
    print(f"drawn in {seconds:.0f} s, {size / 1e6:.0f} MB of PNG, at most {peak:.0f} MiB of memory")
    check(peak < 2048, "it took more than 2 GiB")
    found = of_regions(command, side)
    check(found == of_picture, f"64 regions hash to {found}")
    print("64 regions have the same hash")


main()
