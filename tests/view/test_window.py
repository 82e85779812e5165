"""The window under Xvfb, driven by scripts. Usage: test_window.py TRUESHADE [unittest's arguments]. TRUESHADE_SHOTS names a
folder for screenshots to look at."""
import json
import os
import re
import struct
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import zlib

TRUESHADE = ""
FOLDER = tempfile.TemporaryDirectory()
DISPLAY = {}


def path(name):
    return os.path.join(FOLDER.name, name)


def write(name, text):
    with open(path(name), "w", encoding="utf-8") as file:
        file.write(text)
    return name


def environment(**other):
    plain = {key: value for key, value in os.environ.items() if key not in ("DISPLAY", "WAYLAND_DISPLAY", "SDL_VIDEODRIVER")}
    return {**plain, **DISPLAY, **other}


def run(*arguments, code=0, env=None, timeout=120):
    done = subprocess.run([TRUESHADE, *arguments], cwd=FOLDER.name, capture_output=True, text=True, timeout=timeout,
                          env=env or environment())
    assert done.returncode == code, f"trueshade {' '.join(arguments)}: {done.returncode}\n{done.stdout}\n{done.stderr}"
    return done


def view(scene, lines, *options, code=0):
    write("script.txt", "\n".join(lines) + "\nquit\n")
    return run("view", scene, "--script", "script.txt", *options, code=code)


def hashes(text):
    return re.findall(r"^sha256:([0-9a-f]{64})", text, re.M)


def pixels_of_png(name):
    """Width, height and rows of RGB(A) of a PNG of 8 bits without interlacing."""
    with open(path(name), "rb") as file:
        data = file.read()
    at, packed, channels, width, height = 8, b"", 0, 0, 0
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + size]
        if kind == b"IHDR":
            width, height, _, color = struct.unpack(">IIBB", body[:10])
            channels = 4 if color == 6 else 3
        if kind == b"IDAT":
            packed += body
        at += size + 12
    raw, rows, above = zlib.decompress(packed), [], bytes(width * channels)
    for y in range(height):
        begin = y * (width * channels + 1)
        kind, line = raw[begin], bytearray(raw[begin + 1:begin + 1 + width * channels])
        for i in range(len(line)):
            a, b = line[i - channels] if i >= channels else 0, above[i]
            c = above[i - channels] if i >= channels else 0
            p = a + b - c
            nearest = a if abs(p - a) <= abs(p - b) and abs(p - a) <= abs(p - c) else b if abs(p - b) <= abs(p - c) else c
            line[i] = (line[i] + (0, a, b, (a + b) // 2, nearest)[kind]) & 255
        rows.append([tuple(line[i:i + 3]) for i in range(0, len(line), channels)])
        above = bytes(line)
    return width, height, rows


SCENE = """{"version": 1, "objects": [{"mesh": "knot", "color": [%s]}, {"mesh": "plane", "scale": 4}],
  "lights": [{"type": "point", "position": [2, 3, 2], "range": 9}, {"type": "ambient", "color": [0.1, 0.1, 0.1]}]}"""


MODEL = """layout(std140) uniform Parameters {
  float gain;  // 0 to 1
};
vec3 light(Surface s, Light l, View v) {
  return %s * s.albedo.rgb * l.color;
}
"""


def until(name):
    while not os.path.exists(path(name)):
        time.sleep(0.05)


class Window(unittest.TestCase):
    def test_shows_the_hash_of_render(self):
        for scene, options in (("builtin:cornell", []), ("builtin:circle,lights=20", ["--time", "1.5"]),
                               ("builtin:lecture", ["--preset", "punctual", "--target", "rgba16f"])):
            shown = hashes(view(scene, ["still", "hash"], "--size", "320x240", *options).stdout)
            self.assertEqual(shown, hashes(run("render", scene, "--size", "320x240", "--hash", *options).stdout))

    def test_flies_changes_clicks_saves_and_the_saved_scene_draws_the_picture(self):
        answer = view("builtin:city", [
            "still", "hash", "key w 0.4", "key left shift 0.1", "key d 0.2", "drag 400 300 330 320 0.2", "orbit 10 5", "still", "hash", "screenshot flown.png",
            "preset light-volumes", "strategy deferred-volumes", "exposure 0.5", "light 3 off", "light-color 7 4 2 1",
            "light-intensity 9 3", "light-position 11 0 20 0", "still", "hash", "click 300 420", "still", "wait 0.2",
            "explanation", "screenshot clicked.png", "save saved.png", "save saved.json", "still", "view normal", "still", "hash",
            "save normal.json", "still"], "--size", "800x600")
        found = hashes(answer.stdout)
        self.assertEqual(len(found), 4)
        self.assertEqual(len(set(found)), 4)
        self.assertEqual(hashes(run("render", "saved.json", "--hash").stdout), [found[2]])
        self.assertEqual(hashes(run("render", "normal.json", "--hash").stdout), [found[3]])
        self.assertIn(f"sha256:{found[2]}", run("info", "saved.png").stdout)
        run("render", "saved.json", "-o", "rendered.png", "-q")
        run("compare", "saved.png", "rendered.png", "--no-judge")
        printed = answer.stdout[answer.stdout.index(found[2]) + 64:answer.stdout.rindex("sha256:")].split("\n", 1)[1]
        explained = run("explain", "saved.json", "--pixel", "300,420", "-q").stdout
        self.assertEqual(printed.split("\n", 1)[1], explained.split("\n", 1)[1])  # but for the name of the scene

    def test_what_is_saved_at_a_time_stands_still(self):
        found = hashes(view("builtin:circle", ["time 2.25", "still", "hash", "save time.json", "still"], "--size", "200x150").stdout)
        self.assertEqual(hashes(run("render", "time.json", "--hash").stdout), found)
        self.assertEqual(hashes(view("time.json", ["still", "hash", "save time2.json", "still"], "--size", "200x150").stdout), found)
        self.assertEqual(hashes(run("render", "time2.json", "--hash").stdout), found)

    def test_the_picture_is_as_large_as_the_window_and_shown_pixel_for_pixel(self):
        view("builtin:cornell", ["size 400 300", "still", "press tab", "still", "screenshot bare.png", "save bare_picture.png", "still"])
        window, picture = pixels_of_png("bare.png"), pixels_of_png("bare_picture.png")
        self.assertEqual(window[:2], (400, 300))
        self.assertEqual(window[2], picture[2])

    def test_the_bar_covers_no_row_of_the_picture(self):
        view("builtin:cornell", ["still", "screenshot whole.png", "save whole_picture.png", "still"], "--size", "400x300")
        window, picture = pixels_of_png("whole.png"), pixels_of_png("whole_picture.png")
        self.assertEqual(picture[:2], (400, 300))
        self.assertGreater(window[1], 330)
        self.assertEqual(window[2][60:300], picture[2][60:300])  # below what stands at the top left
        view("builtin:cornell", ["size 400 330", "still", "save above.png", "press tab", "still", "save all.png", "still"])
        self.assertLess(pixels_of_png("above.png")[1], 300)
        self.assertEqual(pixels_of_png("all.png")[:2], (400, 330))

    def test_heat_maps_have_a_scale_with_their_colours(self):
        view("builtin:city", ["view overdraw", "still", "screenshot heat.png", "save heat_picture.png", "view lit", "still", "screenshot lit.png",
                              "save lit_picture.png", "still"], "--size", "640x480")

        def column(name):  # where the scale stands
            return [sum(row[26]) for row in pixels_of_png(name)[2][60:186]]
        scale = column("heat.png")
        self.assertEqual(scale, sorted(scale, reverse=True))
        self.assertGreater(scale[0], 600)
        self.assertLess(scale[-1], 60)
        self.assertNotEqual(scale, column("heat_picture.png"))
        self.assertEqual(column("lit.png"), column("lit_picture.png"))

    def test_panels_lie_over_the_picture(self):
        lines = ["still"]
        for panel in ("picture", "lights", "pixel", "statistics", "none"):
            lines += [f"panel {panel}", "wait 0.2", f"screenshot {panel}.png"]
        lines += ["press f1", "wait 0.2", "screenshot help.png", "press escape", "wait 0.2", "screenshot closed.png"]
        view("builtin:city", lines, "--size", "640x480")
        bare = pixels_of_png("none.png")[2]
        for panel in ("picture", "lights", "pixel", "statistics", "help"):
            rows = pixels_of_png(f"{panel}.png")[2]
            differing = sum(a != b for row, other in zip(rows, bare) for a, b in zip(row, other))
            self.assertGreater(differing, 10000, panel)
            self.assertEqual(rows[300][20], bare[300][20], panel)  # the left of the picture stays free
        self.assertEqual([row[300:] for row in pixels_of_png("closed.png")[2][100:400]], [row[300:] for row in bare[100:400]])

    def test_a_changed_file_is_loaded_anew_and_a_broken_one_keeps_the_last_scene(self):
        write("scene.json", SCENE % "0.8, 0.2, 0.2")
        lines = ["still", "hash", "wait 2.5", "still", "hash", "wait 2.5", "screenshot broken.png", "exposure 1", "still", "exposure 0",
                 "still", "hash"]
        begin = time.monotonic()

        def edit():
            time.sleep(1.5)
            write("scene.json", SCENE % "0.2, 0.8, 0.2")
            time.sleep(2.5)
            write("scene.json", "{ broken")
        editor = threading.Thread(target=edit)
        editor.start()
        done = view("scene.json", lines, "--size", "320x240")
        editor.join()
        self.assertLess(time.monotonic() - begin, 60)
        first, second, third = hashes(done.stdout)
        self.assertNotEqual(first, second)
        self.assertEqual(second, third)
        self.assertIn("scene.json", done.stderr)
        self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        write("scene.json", SCENE % "0.2, 0.8, 0.2")
        self.assertEqual(hashes(run("render", "scene.json", "--size", "320x240", "--hash").stdout), [third])

    def test_a_saved_light_model_is_drawn_and_a_broken_one_is_told_of_over_the_last_good_picture(self):
        write("live.glsl", MODEL % "gain")

        def saved(text):
            write("saved.tmp", text)
            os.rename(path("saved.tmp"), path("live.glsl"))

        lines = ["light-parameter gain=0.25", "panel model", "still", "hash", "screenshot model_good.png"]
        lines += ["wait 4", "still", "hash", "screenshot model_broken.png", "wait 7", "still", "screenshot model_repaired.png", "hash", "save model.png",
                  "save model.json", "light-parameter gain=0.5", "still", "hash", "model toon", "still", "hash", "model none", "still",
                  "hash"]
        told = threading.Thread(target=lambda: (until("model_good.png"), saved(MODEL % "gian"), until("model_broken.png"), saved(MODEL % "gain * gain")))
        told.start()
        done = view("builtin:lecture", lines, "--size", "640x480", "--light-shader", "live.glsl")
        told.join()
        found = hashes(done.stdout)
        flags = ["--size", "640x480", "--hash", "--light-shader"]

        def drawn(text, gain):
            write("drawn.glsl", text)
            return hashes(run("render", "builtin:lecture", *flags, "drawn.glsl", "--light-parameter", f"gain={gain}").stdout)[0]
        self.assertEqual(found[:4], [drawn(MODEL % "gain", 0.25)] * 2 + [drawn(MODEL % "gain * gain", 0.25), drawn(MODEL % "gain * gain", 0.5)])
        self.assertEqual(found[4:5], hashes(run("render", "builtin:lecture", *flags, "toon").stdout))
        self.assertEqual(found[5:], hashes(run("render", "builtin:lecture", "--size", "640x480", "--hash").stdout))
        self.assertIn("live.glsl:5:10: 'gian' : undeclared identifier", done.stderr)
        self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        good, broken, repaired = (pixels_of_png("model_" + name + ".png")[2] for name in ("good", "broken", "repaired"))
        told_at = [(x, y) for y in range(60, 110) for x in range(20, 280) if good[y][x] != broken[y][x]]
        self.assertGreater(len(told_at), 5000)
        reds = sum(r > 200 and g < 160 and b < 160 for row in broken[55:120] for r, g, b in row[:300])
        self.assertGreater(reds, 100)
        self.assertEqual(sum(r > 200 and g < 160 and b < 160 for row in repaired[55:120] for r, g, b in row[:300]), 0)
        self.assertIn('"light_program":{"file":"live.glsl","sha256":"', run("info", "model.png").stdout)
        self.assertIn('"parameters":[{"name":"gain","value":[0.25]}]', run("info", "model.png").stdout)
        render = ["render", "model.json", "--hash"]
        self.assertIn("live.glsl", run(*render, code=2).stderr)  # whose text is in no scene file
        self.assertEqual(hashes(run(*render, "--light-shader", "live.glsl").stdout), [found[2]])

    def test_a_light_model_that_is_none_ends_before_the_window(self):
        write("none.glsl", "vec3 light(")
        self.assertIn("none.glsl:", run("view", "builtin:cornell", "--light-shader", "none.glsl", code=3).stderr)
        run("view", "builtin:cornell", "--light-parameter", "gain=1", code=2)

    def test_parameters_that_are_none_end_before_the_picture(self):
        given = ["view", "builtin:cornell", "--light-shader", "toon", "--light-parameter"]
        self.assertIn("'steps' is a float, and 1,2 is given", run(*given, "steps=1,2", code=2).stderr)
        self.assertIn("reads no parameter 'step'", run(*given, "step=1", code=2).stderr)

    def test_the_program_of_the_window_prints_the_help_of_the_command(self):
        program = os.path.join(os.path.dirname(os.path.realpath(TRUESHADE)), "trueshade-view")
        expected = run("view", "--help").stdout
        self.assertIn("--light-shader", expected)
        for words in (["--help"], ["-h"], ["help"], ["view", "--help"]):
            done = subprocess.run([program, *words], capture_output=True, text=True, env=environment())
            self.assertEqual((done.returncode, done.stdout, done.stderr), (0, expected, ""))

    def test_garbage(self):
        for text, reason in (("fly 3\n", "line 1: no line begins with 'fly'"), ("still\nkey w\n", "line 2: it ends too soon"),
                             ("\x00\x01\x7f\n", "line 1"), ("preset best\n", "there is no preset 'best'")):
            write("garbage.txt", text)
            done = run("view", "builtin:cornell", "--script", "garbage.txt", code=3)
            self.assertIn(reason, done.stderr)
            self.assertEqual(done.stderr.count("\n"), 1)
        self.assertIn("there is no light 99999", view("builtin:cornell", ["still", "light 99999 off"], code=3).stderr)
        self.assertIn("the camera looks at where it is", view("builtin:cornell", ["camera 1 2 3 1 2 3"], code=3).stderr)
        view("builtin:cornell", ["still", "save nowhere/picture.png", "still"], code=5)
        run("view", "nothing.json", code=5)
        run("view", "builtin:cornell", "--script", "nothing.txt", code=5)
        run("view", "builtin:cornell", "--ui-scale", "9", code=2)

    def test_without_a_display_it_is_one_line(self):
        bare = {key: value for key, value in environment().items() if key not in ("DISPLAY", "XDG_RUNTIME_DIR")}
        for other in ({}, {"SDL_VIDEODRIVER": ""}, {"SDL_VIDEODRIVER": "x11"}, {"XDG_RUNTIME_DIR": FOLDER.name}):
            done = run("view", "builtin:cornell", code=5, env={**bare, **other}, timeout=20)
            self.assertTrue(done.stderr.startswith("trueshade: error: display: "), f"{other}: {done.stderr}")
            self.assertEqual(done.stderr.count("\n"), 1, f"{other}: {done.stderr}")

    def test_no_opengl_is_loaded(self):
        write("script.txt", "still\nscreenshot loaded.png\nwait 30\n")
        program = subprocess.Popen([TRUESHADE, "view", "builtin:cornell", "--script", "script.txt"], cwd=FOLDER.name, env=environment())
        try:
            for _ in range(200):
                if os.path.exists(path("loaded.png")):
                    break
                time.sleep(0.1)
            with open(f"/proc/{program.pid}/maps", encoding="utf-8") as maps:
                loaded = set(os.path.basename(line.split()[-1]) for line in maps)
        finally:
            program.kill()
            program.wait()
        self.assertTrue(any(name.startswith("libSDL2") for name in loaded), loaded)
        self.assertFalse([name for name in loaded if re.match("libGL|libEGL|.*_dri|libLLVM", name)])

    def test_a_script_that_would_wait_for_ever_ends(self):
        done = view("builtin:circle", ["play", "still"], code=3)
        self.assertIn("line 2: it waits until nothing moves", done.stderr)
        write("far.json", """{"version": 1, "objects": [{"mesh": "cube"}], "camera": {"target": [0, 0, 0],
          "steps": [{"time": 0, "eye": [0, 0, 4]}, {"time": 2, "eye": [0, 0, 0]}]}}""")
        done = view("far.json", ["still", "time 2", "still"], code=3)
        self.assertIn("line 3: it waits for a picture that cannot be drawn", done.stderr)
        write("stands.json", SCENE % "0.8, 0.2, 0.2")
        view("stands.json", ["play", "still"])

    def test_times_are_reported(self):
        view("builtin:cornell", ["still", "measure", "key w 0.5", "report times.json"], "--size", "320x240")
        with open(path("times.json"), encoding="utf-8") as file:
            report = json.load(file)
        self.assertGreater(report["pictures"], 5)
        self.assertGreater(report["parts_ms"]["draw"]["median"], 0.0)


def main():
    global TRUESHADE
    TRUESHADE = os.path.realpath(sys.argv[1])
    server = subprocess.Popen(["Xvfb", "-displayfd", "1", "-screen", "0", "1600x1200x24", "-nolisten", "tcp"], stdout=subprocess.PIPE,
                              stderr=subprocess.DEVNULL, text=True)
    try:
        DISPLAY["DISPLAY"] = ":" + server.stdout.readline().strip()
        program = unittest.main(module=__name__, argv=[sys.argv[0], *sys.argv[2:]], exit=False)
        shots = os.environ.get("TRUESHADE_SHOTS")
        if shots:
            subprocess.run(f"cp {FOLDER.name}/*.png '{shots}'", shell=True, check=True)
    finally:
        server.terminate()
        server.wait()
    sys.exit(0 if program.result.wasSuccessful() else 1)


if __name__ == "__main__":
    main()
