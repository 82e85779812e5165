"""Pages of HTML in a headless Chromium. Usage: test_pages.py TRUESHADE [unittest's arguments]; `--accept` among them
writes tests/pages/expected.json anew, which must then be looked at."""
import json
import os
import struct
import subprocess
import sys
import tempfile
import time
import unittest
import zlib

from browser import Browser

HERE = os.path.dirname(os.path.abspath(__file__))
TRUESHADE = ""
ACCEPT = False
FOLDER = tempfile.TemporaryDirectory()


def trueshade(*arguments, codes=(0,)):
    done = subprocess.run([TRUESHADE, *arguments], cwd=FOLDER.name, capture_output=True, text=True, timeout=300)
    assert done.returncode in codes, f"trueshade {' '.join(arguments)}: {done.returncode}\n{done.stderr}"
    return done.stdout


def page(name, *commands, codes=(0, 1)):
    """The path of a page; it is made by the first who asks."""
    path = os.path.join(FOLDER.name, name)
    if not os.path.exists(path):
        for command in commands:
            trueshade(*command, codes=codes)
    return path


PLANES = "depth,position,normal,albedo,id.object"


def wrong_page():
    """A small capture with fronts culled: most of its pixels are violations."""
    with open(os.path.join(FOLDER.name, "culled.json"), "w", encoding="utf-8") as file:
        file.write('{"geometry": {"cull_face": "front"}}')
    return page("wrong.html",
                ("render", "builtin:cornell", "--size", "96x72", "--pipeline", "culled.json", "-o", "wrong.exr", "--aov", PLANES),
                ("validate", "builtin:cornell", "--gbuffer", "wrong.exr", "--quick", "-o", "wrong.html"))


def large_page():
    return page("large.html", ("render", "builtin:city", "--size", "1920x1080", "-o", "large.exr", "--aov", PLANES),
                ("validate", "builtin:city", "--gbuffer", "large.exr", "--quick", "-o", "large.html"))


def render_page():
    return page("render.html", ("render", "builtin:cornell", "--size", "160x120", "-o", "render.html"))


def pixels_of_png(data):
    """Width, height and rows of RGB of a PNG of 8 bits without interlacing."""
    at, packed = 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        if kind == b"IHDR":
            width, height, bits, color = struct.unpack(">IIBB", data[at + 8:at + 18])
        if kind == b"IDAT":
            packed += data[at + 8:at + 8 + length]
        at += 12 + length
    assert bits == 8 and color in (2, 6)
    size = 3 if color == 2 else 4
    raw, rows, before = zlib.decompress(packed), [], bytes(width * size)
    for y in range(height):
        start = y * (width * size + 1)
        row, kind = bytearray(raw[start + 1:start + 1 + width * size]), raw[start]
        for i in range(len(row)):
            left, up = (row[i - size] if i >= size else 0), before[i]
            corner = before[i - size] if i >= size else 0
            if kind == 1:
                row[i] = (row[i] + left) & 255
            elif kind == 2:
                row[i] = (row[i] + up) & 255
            elif kind == 3:
                row[i] = (row[i] + (left + up) // 2) & 255
            elif kind == 4:
                guess = left + up - corner
                nearest = min((abs(guess - left), 0, left), (abs(guess - up), 1, up), (abs(guess - corner), 2, corner))
                row[i] = (row[i] + nearest[2]) & 255
        rows.append(row)
        before = row
    return width, height, size, rows


def mean_colors(path, columns=32, rows=24):
    """The mean colours of a grid over a screenshot: letters may differ from machine to machine, places may not."""
    with open(path, "rb") as file:
        width, height, size, lines = pixels_of_png(file.read())
    cells = []
    for row in range(rows):
        for column in range(columns):
            sums, count = [0, 0, 0], 0
            for y in range(row * height // rows, (row + 1) * height // rows, 3):
                for x in range(column * width // columns, (column + 1) * width // columns, 3):
                    for k in range(3):
                        sums[k] += lines[y][x * size + k]
                    count += 1
            cells.append([round(total / count) for total in sums])
    return cells


class Page(unittest.TestCase):
    """One browser for all tests."""

    @classmethod
    def setUpClass(cls):
        cls.browser = Browser(1280, 900)

    @classmethod
    def tearDownClass(cls):
        cls.browser.close()

    def open(self, path, width=1280, height=900, theme="light", fragment=""):
        self.browser.resize(width, height)
        self.browser.theme(theme)
        self.browser.open("/dev/null")  # so that the same page with another fragment is loaded anew
        self.browser.complaints(), self.browser.requests()
        self.browser.open(path, fragment)
        self.wait_until_painted()

    def wait_until_painted(self):
        self.browser.wait("document.getElementById('viewer').viewer")
        self.settle()

    def tearDown(self):
        complaints = [c for c in self.browser.complaints() if "willReadFrequently" not in c]  # of what these tests read back
        self.assertEqual(complaints, [], "the console has complaints")
        foreign = [url for url in self.browser.requests() if not url.startswith(("file://", "data:", "chrome:"))]
        self.assertEqual(foreign, [], "the page asked the network")

    def viewer(self, expression):
        return self.browser.run(f"const v = document.getElementById('viewer').viewer; return {expression};")

    def press(self, text, within="#viewer"):
        self.browser.run("const all = [...document.querySelectorAll(arguments[0] + ' button')];"
                         "all.find(b => b.textContent === arguments[1]).click();", within, text)

    def box(self, selector, index=0):
        return self.browser.run("const r = document.querySelectorAll(arguments[0])[arguments[1]].getBoundingClientRect();"
                                "return [r.left, r.top, r.width, r.height];", selector, index)

    def color_at(self, pane, x, y):
        """The colour on a pane's canvas of the image's pixel x, y."""
        return self.browser.run(
            "const v = document.getElementById('viewer').viewer.panes, c = document.querySelectorAll('.stage canvas')[arguments[0]];"
            "const r = devicePixelRatio, x = c.width / 2 + (arguments[1] + 0.5 - v.view.x) * v.zoom * r,"
            " y = c.height / 2 + (arguments[2] + 0.5 - v.view.y) * v.zoom * r;"
            "return [...c.getContext('2d').getImageData(x, y, 1, 1).data].slice(0, 3);", pane, x, y)

    def settle(self):
        """Waits until all is drawn that can be."""
        self.browser.run("return new Promise(done => setTimeout(() => requestAnimationFrame(() => requestAnimationFrame(done)), 60));")
        self.browser.wait("(p => !p.is_due && p.missing === 0)(document.getElementById('viewer').viewer.panes)")

    def test_a_page_of_1920x1080_is_small_and_soon_usable(self):
        path = large_page()
        self.assertLess(os.path.getsize(path), 12e6)
        self.browser.open("/dev/null")
        start = time.monotonic()
        self.browser.open(path)
        self.browser.wait("document.getElementById('viewer').viewer")
        self.settle()
        self.assertEqual(self.browser.run("return document.querySelectorAll('.stage canvas').length;"), 4)
        took = time.monotonic() - start
        print(f"1920x1080: {os.path.getsize(path) / 1e6:.1f} MB, usable after {took:.2f} s")
        self.assertLess(took, 2)

    def test_small_pictures_stand_where_large_ones_are_not_yet_unpacked(self):
        self.open(wrong_page())
        places = [(pane, x, y) for pane in range(2) for x in range(8, 96, 16) for y in range(8, 72, 16)]
        right = [self.color_at(*place) for place in places]
        self.assertGreater(max(sum(color) for color in right), 200)
        self.viewer("(v.panes.painted = () => null, v.panes.is_painted = () => false, v.panes.redraw())")
        self.browser.wait("!document.getElementById('viewer').viewer.panes.is_due")
        off = [abs(a - b) for place, color in zip(places, right) for a, b in zip(color, self.color_at(*place))]
        self.assertLess(sum(off) / len(off), 4)  # a picture that is scaled is smooth between its pixels

    def test_a_gallery_of_200_pictures_opens_soon_and_is_worked_by_keyboard(self):
        for side, lights in (("golden", 3), ("drawn", 5)):
            os.makedirs(os.path.join(FOLDER.name, side), exist_ok=True)
            for i in range(3):
                trueshade("render", f"builtin:cornell,lights={lights + i}", "--size", "160x120", "-q", "-o", f"{side}/{i}.png")
            for i in range(3, 200):  # of which 150 are the same on both sides
                source = os.path.join(FOLDER.name, side if i < 50 else "golden", f"{i % 3}.png")
                with open(source, "rb") as file, open(os.path.join(FOLDER.name, side, f"{i}.png"), "wb") as copy:
                    copy.write(file.read())
        trueshade("compare", "golden", "drawn", "--no-judge", "-o", "gallery.html", codes=(1,))
        path = os.path.join(FOLDER.name, "gallery.html")
        self.assertLess(os.path.getsize(path), 20e6)
        shown = "return [...document.querySelectorAll('#gallery .pair')].filter(p => !p.hidden).length;"
        for width, height in ((1280, 900), (390, 844)):
            self.browser.resize(width, height)
            self.browser.open("/dev/null")
            start = time.monotonic()
            self.browser.open(path)
            self.browser.wait("document.getElementById('gallery').gallery")
            self.assertLess(time.monotonic() - start, 2)
            self.assertEqual(self.browser.run(shown), 200)
            self.press("different 50", "#filters")
            self.assertEqual(self.browser.run(shown), 50)
            self.browser.run("const p = document.getElementById('part'); p.value = '7.png'; p.dispatchEvent(new Event('input'));")
            self.assertEqual(self.browser.run(shown), 5)
            self.assertLessEqual(self.browser.run("return document.documentElement.scrollWidth;"), width)
            self.browser.run("document.querySelector('#gallery .pair:not([hidden]) img').click();")
            name = "return document.querySelector('.looker h2').textContent;"
            first = self.browser.run(name)
            clip = "return document.querySelector('.stack img + img').style.clipPath;"
            before = self.browser.run(clip)
            self.browser.key("ArrowRight")
            self.assertNotEqual(self.browser.run(clip), before)
            self.browser.key("n")
            self.assertNotEqual(self.browser.run(name), first)
            self.browser.key("d")
            self.assertEqual(self.browser.run("return document.querySelector('.looker [aria-pressed=true]').textContent;"), "Difference")
            self.browser.key("p")
            self.assertEqual(self.browser.run(name), first)
            box = self.box(".large")
            self.assertLessEqual(box[0] + box[2], width)
            self.browser.key("Escape")
            self.assertFalse(self.browser.run("return document.querySelector('.looker').open;"))
        self.browser.resize(1280, 900)

    def test_the_slider_moves_by_mouse_and_by_keyboard(self):
        self.open(wrong_page())
        self.press("Slider")
        self.settle()
        width = self.viewer("v.panes.width")
        x = int(width * 0.6)
        test, left = self.color_at(0, x, 20), self.viewer("v.panes.split")
        self.assertEqual(left, 0.5)
        box = self.box(".handle")
        self.browser.drag(box[0] + box[2] / 2, box[1] + 100, box[0] + box[2] / 2 + 200, box[1] + 100)
        self.settle()
        self.assertGreater(self.viewer("v.panes.split"), 0.6)
        self.assertNotEqual(self.color_at(0, x, 20), test, "the reference now reaches here")
        self.browser.run("document.querySelector('.handle').focus();")
        before = self.viewer("v.panes.split")
        self.browser.key("ArrowLeft", "ArrowLeft")
        self.assertLess(self.viewer("v.panes.split"), before)
        self.assertEqual(self.browser.run("return document.querySelector('.handle').getAttribute('aria-valuenow');"),
                         str(round(100 * self.viewer("v.panes.split"))))

    def test_all_panes_zoom_and_pan_together(self):
        self.open(wrong_page())
        self.assertEqual(self.browser.run("return document.querySelectorAll('.stage canvas').length;"), 4)
        left, top, width, height = self.box(".stage canvas", 1)
        fit = self.viewer("v.panes.zoom")
        self.browser.wheel(left + width / 2, top + height / 2, -400)
        self.settle()
        self.assertEqual(self.viewer("v.panes.zoom"), fit, "the wheel moves the page until a picture has been clicked")
        self.browser.run("scrollTo(0, 0); document.querySelector('.stage').focus({preventScroll: true});")
        left, top, width, height = self.box(".stage canvas", 1)
        under = self.viewer(f"v.panes.point_at({width / 4}, {height / 4})")
        self.browser.wheel(left + width / 4, top + height / 4, -700)
        self.settle()
        self.assertGreater(self.viewer("v.panes.zoom"), fit * 2)
        for a, b in zip(under, self.viewer(f"v.panes.point_at({width / 4}, {height / 4})")):
            self.assertLess(abs(a - b), 1 / fit)  # what is under the pointer stays there, to a pixel of the screen
        before = self.viewer("[v.panes.view.x, v.panes.view.y]")
        self.browser.drag(left + 100, top + 100, left + 60, top + 130)
        zoom = self.viewer("v.panes.zoom")
        after = self.viewer("[v.panes.view.x, v.panes.view.y]")
        self.assertAlmostEqual(after[0] - before[0], 40 / zoom, places=3)
        self.assertAlmostEqual(after[1] - before[1], -30 / zoom, places=3)
        self.assertIsNone(self.viewer("v.panes.pin"), "a drag is no click")
        self.settle()
        x, y = (int(at) for at in after)
        for pane, id in ((0, "reference"), (1, "test")):
            codes = self.viewer(f"v.layers.get('{id}').pixel({x}, {y})")
            self.assertEqual(self.color_at(pane, x, y), codes[:3], f"pane {id} shows its own pixel {x}, {y}")

    def test_values_of_a_pixel_are_those_of_the_file(self):
        self.open(wrong_page(), fragment="#30,40")
        self.browser.wait("document.querySelectorAll('.values tbody tr').length >= 4")
        shown = self.browser.run("return [...document.querySelectorAll('.values tbody tr')].slice(0, 4).map(r => [...r.cells].map(c => c.textContent));")
        trueshade("render", "builtin:cornell", "--size", "96x72", "-o", "reference.png", "-q")
        with open(os.path.join(FOLDER.name, "reference.png"), "rb") as file:
            _, _, size, rows = pixels_of_png(file.read())
        self.assertEqual([int(cells[1]) for cells in shown], list(rows[40][30 * size:30 * size + 4]))
        for cells in shown:
            self.assertEqual(int(cells[3].replace("\u2212", "-")), int(cells[2]) - int(cells[1]))

    def test_a_click_on_a_violation_is_explained(self):
        self.open(wrong_page())
        self.browser.run("document.querySelector('.next').click();")
        x, y = self.viewer("v.panes.pin")
        self.assertEqual(self.viewer(f"v.layers.get('classes-gbuffer').classes[v.layers.get('classes-gbuffer').pixel({x}, {y})[0]].name"), "VIOLATION")
        self.press("Fit")
        self.browser.run("document.querySelector('.stage').focus();")
        self.browser.key("Escape")
        self.assertIsNone(self.viewer("v.panes.pin"))
        self.settle()
        zoom = self.viewer("v.panes.zoom")
        self.browser.run("window.scrollTo(0, 0);")
        left, top, width, height = self.box(".stage canvas", 3)
        if top + height > 900:
            self.browser.run("scrollBy(0, arguments[0]);", top + height - 880)
            left, top, width, height = self.box(".stage canvas", 3)
        place = (left + width / 2 + (x + 0.5 - 48) * zoom, top + height / 2 + (y + 0.5 - 36) * zoom)
        self.browser.click(*place)
        self.assertEqual(self.viewer("v.panes.pin"), [x, y])
        card = self.browser.run("return document.querySelector('.pixel').textContent;")
        for part in (f"Pixel {x}, {y}", "VIOLATION", "In no legal set", "legal is ", "nominal ", "Surface: instance ", "Object", "Lights"):
            self.assertIn(part, card)

    def test_a_page_opens_on_the_stage_that_failed(self):
        lit = page("lit.html", ("render", "builtin:cornell", "--size", "96x72", "-o", "right.exr", "--aov", PLANES),
                   ("render", "builtin:cornell,lights=3", "--size", "96x72", "-o", "lit.png"),
                   ("validate", "builtin:cornell", "--gbuffer", "right.exr", "--map",
                    "depth,position,normal,albedo,id.object", "--image", "lit.png", "--quick", "-o", "lit.html"))
        for path, stage in ((wrong_page(), "gbuffer"), (lit, "lighting")):
            self.open(path)
            self.assertEqual(self.viewer("[...v.chosen]"), ["reference", "test", "difference", "classes-" + stage])
            way = self.browser.run("return document.querySelector('.verdict a').getAttribute('href');")
            self.assertEqual(way, "#stage-" + stage)
            self.assertEqual(self.browser.run("return document.querySelector(arguments[0]).textContent;", way), "Stage " + stage)

    def test_legal_ranges_and_the_way_to_a_value_are_there(self):
        path = page("right.html", ("render", "builtin:cornell", "--size", "96x72", "-o", "right.exr", "--aov", PLANES),
                    ("validate", "builtin:cornell", "--gbuffer", "right.exr", "--quick", "-o", "right.html"))
        self.open(path)
        points = self.viewer("v.manifest.points.filter(p => p.legal)")
        self.assertGreater(len(points), 20)
        for point in points[:20]:
            self.viewer(f"v.go_to({point['x']}, {point['y']})")
            self.browser.wait("document.querySelectorAll('.values tbody tr').length >= 4")
            rows = self.browser.run("return [...document.querySelectorAll('.values tbody tr')].slice(0, 4).map(r => [...r.cells].map(c => c.textContent));")
            for cells in rows:
                low, high = (float(end) for end in (cells[4].split(" \u2026 ") if "\u2026" in cells[4] else [cells[4]] * 2))
                self.assertTrue(low <= int(cells[2]) <= high, f"{point['x']},{point['y']}: {cells}")
            card = self.browser.run("return document.querySelector('.pixel').textContent;")
            self.assertIn("How the reference gets its value", card)
        command = self.browser.run("return document.querySelector('.pixel .command code').textContent;")
        self.assertTrue(command.startswith("trueshade explain builtin:cornell "))
        stored = trueshade(*command.split()[1:]).splitlines()[-1]
        self.assertIn(", ".join(cells[1] for cells in rows), stored)

    def test_a_class_can_be_switched_off(self):
        self.open(wrong_page())
        x, y = self.viewer("v.manifest.marks[0].pixels[0].slice(0, 2)")
        self.viewer(f"v.panes.centre_on({x}, {y}, 30)")
        self.settle()
        self.assertEqual(self.color_at(3, x, y), [255, 40, 80])
        self.browser.run("[...document.querySelectorAll('.legend label')].find(l => l.textContent.includes('VIOLATION')).querySelector('input').click();")
        self.settle()
        self.assertNotEqual(self.color_at(3, x, y), [255, 40, 80])
        self.assertLess(sum(self.color_at(3, x, y)), 3 * 0.4 * 255)
        counts = self.browser.run("return [...document.querySelectorAll('.legend .count')].map(c => c.textContent);")
        self.assertTrue(all(any(letter.isdigit() for letter in count) for count in counts))

    def test_keys_do_what_buttons_do(self):
        self.open(wrong_page())
        self.browser.run("document.querySelector('.stage').focus();")
        self.browser.key("n")
        pinned = self.viewer("v.panes.pin")
        self.assertEqual(pinned, self.viewer("v.manifest.marks[0].pixels[0].slice(0, 2)"))
        self.browser.key("ArrowRight", "ArrowRight", modifiers=8)
        self.assertEqual(self.viewer("v.panes.pin"), [pinned[0] + 1, pinned[1]])
        self.browser.key("0")
        self.assertEqual(self.viewer("v.panes.view.zoom"), 0)
        self.browser.key("+")
        self.assertGreater(self.viewer("v.panes.zoom"), self.viewer("v.panes.fit_zoom"))
        self.browser.key("o")
        self.assertEqual(self.viewer("v.mode"), "one")
        one = self.viewer("v.one")
        self.browser.key("]")
        self.assertNotEqual(self.viewer("v.one"), one)
        self.browser.key("?")
        self.assertFalse(self.browser.run("return document.querySelector('.keys').hidden;"))
        self.browser.key("Escape")
        self.assertIsNone(self.viewer("v.panes.pin"))

    def test_every_button_of_the_bar_does_what_it_says(self):
        self.open(wrong_page())
        fit = self.viewer("v.panes.fit_zoom")
        self.press("+")
        larger = self.viewer("v.panes.zoom")
        self.assertGreater(larger, fit)
        self.press("+")
        self.assertAlmostEqual(self.viewer("v.panes.zoom"), 2 * larger)
        self.press("\u2212")
        self.assertAlmostEqual(self.viewer("v.panes.zoom"), larger)
        self.press("1:1")
        self.assertEqual(self.viewer("v.panes.zoom"), 1)
        self.press("Fit")
        self.assertEqual(self.viewer("v.panes.view.zoom"), 0)
        for is_hidden in (False, True):
            self.press("?")
            self.assertEqual(self.browser.run("return document.querySelector('.keys').hidden;"), is_hidden)

    def test_light_and_dark_follow_the_system_and_the_button(self):
        background = "return getComputedStyle(document.body).backgroundColor;"
        self.open(wrong_page(), theme="dark")
        dark = self.browser.run(background)
        self.browser.theme("light")
        light = self.browser.run(background)
        self.assertNotEqual(dark, light)
        self.browser.run("document.getElementById('theme').click();")
        self.assertEqual(self.browser.run(background), dark)
        self.browser.run("localStorage.clear();")

    def test_words_have_enough_contrast_in_both_themes(self):
        for theme in ("light", "dark"):
            self.open(wrong_page(), theme=theme)
            colors = self.browser.run("const s = getComputedStyle(document.documentElement);"
                                      "return Object.fromEntries(['page', 'card', 'text', 'quiet', 'accent', 'bad', 'good'].map(n => [n, s.getPropertyValue('--' + n).trim()]));")

            def luminance(color):
                parts = [int(color[i:i + 2], 16) / 255 for i in (1, 3, 5)]
                linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in parts]
                return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]

            for under in ("page", "card"):
                for word in ("text", "quiet", "accent", "bad", "good"):
                    a, b = sorted((luminance(colors[under]), luminance(colors[word])))
                    self.assertGreater((b + 0.05) / (a + 0.05), 4.5, f"{theme}: {word} on {under} (WCAG 2.1, 1.4.3)")

    def test_it_fits_a_phone(self):
        for path in (wrong_page(), render_page()):
            self.open(path, 400, 800)
            self.assertLessEqual(self.browser.run("return document.documentElement.scrollWidth;"), 400)
            self.assertEqual(self.viewer("v.mode"), "one")

    def test_on_paper_there_are_the_pictures_and_the_tables(self):
        self.open(wrong_page())
        pdf = self.browser.pdf()
        self.assertTrue(pdf.startswith(b"%PDF"))
        self.assertGreaterEqual(pdf.count(b"/Subtype /Image") + pdf.count(b"/Subtype/Image"), 5)
        self.assertGreaterEqual(pdf.count(b"/Type /Page\n") + pdf.count(b"/Type /Page "), 2)

    def test_without_scripts_there_are_the_pictures_and_the_tables(self):
        self.browser.scripts(False)
        try:
            self.browser.open("/dev/null")
            self.browser.open(wrong_page())
            self.browser.scripts(True)  # what follows asks the page, whose own scripts have not run
            self.assertGreater(self.box(".static img")[2], 100)
            self.assertEqual(self.browser.run("return document.getElementById('viewer').childElementCount;"), 0)
            self.assertGreaterEqual(self.browser.run("return document.querySelectorAll('table').length;"), 4)
        finally:
            self.browser.scripts(True)

    def test_a_comparison_shows_both_pictures_and_the_worst_pixel(self):
        for seed in ("1", "2"):
            trueshade("render", f"builtin:city,objects=40,seed={seed}", "--size", "120x90", "-o", f"seed{seed}.exr",
                      "--target", "rgba16f", "--aov", "normal", "-q")
        path = page("compare.html", ("compare", "seed1.exr", "seed2.exr", "--no-judge", "-o", "compare.html"))
        self.open(path)
        self.assertIn("Exposure", self.browser.run("return document.querySelector('.side').textContent;"))
        self.browser.run("document.querySelector('.next').click();")
        self.browser.wait("document.querySelectorAll('.values tbody tr').length >= 4")
        x, y = self.viewer("v.panes.pin")
        told = json.loads(trueshade("compare", "seed1.exr", "seed2.exr", "--no-judge", "--json", codes=(1,)))
        self.assertEqual(told["unequal_pixels"] > 0, True)
        codes = [self.viewer(f"v.layers.get('group0-{side}').pixel({x}, {y})") for side in ("reference", "test")]
        largest = max(abs(struct.unpack("f", struct.pack("I", a))[0] - struct.unpack("f", struct.pack("I", b))[0])
                      for a, b in zip(*codes))
        self.assertAlmostEqual(largest, max(c["largest"] for c in told["channels"] if c["name"] in "RGBA"), places=6)
        self.assertIn("Difference N", self.browser.run("return document.querySelector('.choices').textContent;"))

    def test_an_image_of_16384_by_16384_is_shown(self):
        def chunk(kind, data):
            return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

        side = 16384
        for name, odd in (("huge1.png", 0), ("huge2.png", 200)):
            row = bytes([0]) + bytes([40]) * side
            last = bytes([0]) + bytes([40]) * (side - 1) + bytes([40 + odd])
            with open(os.path.join(FOLDER.name, name), "wb") as file:
                file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", side, side, 8, 0, 0, 0, 0)) +
                           chunk(b"IDAT", zlib.compress(row * (side - 1) + last, 1)) + chunk(b"IEND", b""))
        path = page("huge.html", ("compare", "huge1.png", "huge2.png", "--max-expansion", "100000", "-o", "huge.html"))
        self.open(path)
        self.browser.run("document.querySelector('.next').click();")
        self.assertEqual(self.viewer("v.panes.pin"), [side - 1, side - 1])
        self.browser.wait(f"document.getElementById('viewer').viewer.layers.get('group0-test').pixel({side - 1}, {side - 1})")
        self.assertEqual(self.viewer(f"v.layers.get('group0-test').pixel({side - 1}, {side - 1})"), [240])
        self.settle()
        self.assertLessEqual(self.viewer("Math.max(...v.panes.list.map(p => p.canvas.width))"), 1280)

    def test_names_from_outside_are_text(self):
        name = "<img src=x onerror=alert(1)>.exr"
        with open(os.path.join(FOLDER.name, name), "wb") as file, open(wrong_page().replace(".html", ".exr"), "rb") as wrong:
            file.write(wrong.read())
        path = page("name.html", ("validate", "builtin:cornell", "--gbuffer", name, "--quick", "-o", "name.html"))
        self.open(path)
        self.assertEqual(self.browser.run("return document.querySelectorAll('img[src=x]').length;"), 0)
        self.assertIn(name, self.browser.run("return document.body.textContent;"))

    def test_a_very_wide_image_is_shown_in_tiles(self):
        path = page("wide.html", ("render", "builtin:cornell", "--size", "16384x256", "-o", "wide.html"))
        self.open(path)
        self.assertEqual(self.viewer("v.panes.width"), 16384)
        self.settle()
        self.assertLessEqual(self.viewer("Math.max(...v.panes.list.map(p => p.canvas.width))"), 1280)
        self.viewer("v.go_to(16383, 255)")
        self.settle()
        self.browser.wait("document.getElementById('viewer').viewer.layers.get('color').pixel(16383, 255)")
        self.settle()
        self.assertEqual(self.color_at(0, 16383, 255), self.viewer("v.layers.get('color').pixel(16383, 255)")[:3])

    def test_planes_of_a_render_are_read_value_by_value(self):
        self.open(render_page(), fragment="#80,60")
        self.browser.wait("document.querySelector('.planes') && !document.querySelector('.planes').textContent.includes('\u2026')")
        shown = self.browser.run("return Object.fromEntries([...document.querySelectorAll('.planes tr')].map(r => [r.cells[0].textContent, r.cells[1].textContent]));")
        normal = [float(v.replace("\u2212", "-")) for v in shown["Normal X Y Z"].split()]
        self.assertAlmostEqual(sum(v * v for v in normal), 1, places=5)
        for name in ("Image R G B A", "Lights per pixel", "Albedo R G B A", "Depth", "Position X Y Z", "Object"):
            self.assertRegex(shown[name], "[0-9]")

    def test_pages_look_as_they_did(self):
        expected_path, found = os.path.join(HERE, "expected.json"), {}
        shots = os.path.join(FOLDER.name, "shots")
        os.makedirs(shots, exist_ok=True)
        for theme in ("light", "dark"):
            for name, path in (("wrong", wrong_page()), ("render", render_page())):
                self.open(path, theme=theme)
                self.settle()
                shot = os.path.join(shots, f"{name}_{theme}.png")
                self.browser.screenshot(shot)
                found[f"{name}_{theme}"] = mean_colors(shot)
        if ACCEPT:
            with open(expected_path, "w", encoding="utf-8") as file:
                file.write("{\n" + ",\n".join(f'"{name}": {json.dumps(cells, separators=(",", ":"))}' for name, cells in found.items()) + "\n}\n")
        with open(expected_path, encoding="utf-8") as file:
            expected = json.load(file)
        for name, cells in expected.items():
            apart = [max(abs(a - b) for a, b in zip(cell, other)) for cell, other in zip(cells, found[name])]
            far = sum(1 for a in apart if a > 24)
            self.assertLess(far, len(apart) * 0.06, f"{name}: {far} of {len(apart)} cells are of another colour (see {shots})")


if __name__ == "__main__":
    TRUESHADE = os.path.abspath(sys.argv[1])
    ACCEPT = "--accept" in sys.argv
    unittest.main(argv=[sys.argv[0], "-v"] + [a for a in sys.argv[2:] if a != "--accept"])
