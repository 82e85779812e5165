#!/usr/bin/python3
"""Recomputes pixels of pictures from `trueshade info --resolved` alone, and compares them with what
`trueshade render` stored, bit for bit. See README.md."""
import argparse
import itertools
import os
import random
import subprocess
import sys
import tempfile

try:
    import numpy as np
except ImportError:
    print("SKIPPED: there is no NumPy (package python3-numpy)")
    sys.exit(0)

import formats
import host
import resolved
import strategies
import surfaces
from exr_file import read_exr
from wrong_rules import RULES

SCENES = ("builtin:city", "builtin:sphere", "builtin:lecture", "builtin:cornell")
PRESETS = ("many-lights", "touchdesigner", "gl-fixed", "punctual", "lecture", "light-volumes", "light-volumes-literal",
           "redsdk")
STRATEGIES = ("forward-multipass", "forward-loop", "deferred-volumes", "deferred-loop")


def run(command):
    outcome = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False)
    if outcome.returncode != 0:
        sys.exit("%s: exit code %d\n%s" % (" ".join(command), outcome.returncode, outcome.stderr.decode()))


def drawn(command, folder, scene, options):
    """The scene's numbers, and the picture [height, width, 4], the bottom row first, as the target is read back."""
    run([command, "info", scene, "--resolved", "-o", os.path.join(folder, "scene")] + options)
    picture = os.path.join(folder, "picture.exr")
    run([command, "render", scene, "-q", "-o", picture] + options)
    planes = read_exr(picture)
    one = np.ones_like(planes["R"])
    rgba = np.stack([planes[c].astype(np.float32) if c in planes else one for c in "RGBA"], axis=2)
    return resolved.read_scene(os.path.join(folder, "scene")), rgba[::-1]


def prepared(scene, before):
    """Adds the geometry, which scenes of the same objects and camera share, and the geometry of lights."""
    camera = scene["camera"]
    if camera["target"] is not None:
        matrix = host.clip_from_world(camera, scene["viewport"], scene["pipeline"]["geometry"]["clip_depth"])
        assert matrix == camera["clip_from_world"], "clip_from_world"
    shared = before is not None and all(
        before[key] == scene[key] for key in ("hash", "time", "viewport", "camera", "objects")
    ) and before["pipeline"]["geometry"] == scene["pipeline"]["geometry"]
    scene["geometry"] = before["geometry"] if shared else surfaces.Geometry(scene)
    scene["geometry"].scene = scene
    scene["drawn_lights"] = strategies.Lights(scene)
    return scene


def bits(values, target):
    """What the target stores, channel by channel: codes, or the bits of floats."""
    if target in formats.UNORM_BITS:
        return np.rint(values * formats.largest_codes(target)).astype(np.int64)
    return np.ascontiguousarray(values, np.float32).view(np.uint32).astype(np.int64)


def chosen_pixels(picture, count, chance):
    """Half of them anywhere, half from the tenth of the picture with the largest steps to a neighbour: edges."""
    height, width, _ = picture.shape
    with np.errstate(all="ignore"):
        steps = np.abs(np.diff(picture[:, :, :3], axis=1, append=picture[:, -1:, :3])).sum(axis=2)
        steps += np.abs(np.diff(picture[:, :, :3], axis=0, append=picture[-1:, :, :3])).sum(axis=2)
    edges = np.argsort(-steps, axis=None, kind="stable")[: max(width * height // 10, 1)]
    anywhere = [chance.randrange(width * height) for _ in range((count + 1) // 2)]
    return [(k % width, k // width) for k in anywhere + [int(edges[chance.randrange(len(edges))])
                                                         for _ in range(count // 2)]]


def differing(scene, picture, count, chance, say=print):
    """Recomputes pixels, and returns how many are not what the picture holds."""
    pixels = chosen_pixels(picture, count, chance)
    color = strategies.Picture(scene, [(256 * i + 128, 256 * j + 128) for i, j in pixels]).recomputed()
    target = scene["pipeline"]["target"]
    ours, theirs = bits(color, target), bits(np.array([picture[j, i] for i, j in pixels]), target)
    channels = formats.channels_of(target)
    wrong = np.flatnonzero((ours != theirs)[:, :channels].any(axis=1))
    for k in wrong[:3]:
        i, j = pixels[k]
        say("  pixel (%d, %d) from the lower left: stored %s, recomputed %s"
            % (i, j, picture[j, i].tolist(), color[k].tolist()))
    return len(wrong)


def options_of(preset, strategy, options, target):
    more = ["--preset", preset, "--strategy", strategy, "--size", options.size]
    for name, value in (("--target", target), ("--pipeline", options.pipeline), ("--time", options.time)):
        more += [name, value] if value else []
    return more


def recompute_all(options):
    """Every scene, preset and strategy; returns the exit code."""
    chance, pictures, total, wrong = random.Random(options.seed), 0, 0, 0
    for name in options.scenes:
        before = None
        for preset, strategy in itertools.product(options.presets, options.strategies):
            target = options.targets[pictures % len(options.targets)] if options.targets else None
            more = options_of(preset, strategy, options, target)
            with tempfile.TemporaryDirectory() as folder:
                scene, picture = drawn(options.command, folder, name, more)
                before = scene = prepared(scene, before)
                differ = differing(scene, picture, options.pixels, chance)
            pictures, total, wrong = pictures + 1, total + options.pixels, wrong + differ
            if differ:
                print("%s %s: %d of %d pixels differ" % (name, " ".join(more), differ, options.pixels), flush=True)
    print("%d pixels of %d pictures recomputed, %d differ" % (total, pictures, wrong))
    return 1 if wrong else 0


def try_wrong_rules(options):
    """Each wrong rule must make some pixel of the first scene differ; returns the exit code."""
    unnoticed = 0
    for rule, (preset, strategy, target, change) in RULES.items():
        with tempfile.TemporaryDirectory() as folder:
            more = options_of(preset, strategy, options, target)
            scene, picture = drawn(options.command, folder, options.scenes[0], more)
            scene = prepared(scene, None)
            restore = change(scene)
            differ = differing(scene, picture, options.pixels, random.Random(options.seed), lambda line: None)
            restore()
        print("%s: %d of %d pixels differ" % (rule, differ, options.pixels))
        unnoticed += differ == 0
    return 1 if unnoticed else 0


def words(text):
    return [word for word in text.split(",") if word]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("command", help="the program trueshade")
    parser.add_argument("--scene", action="append", dest="scenes", help="may be repeated")
    parser.add_argument("--presets", type=words, default=PRESETS)
    parser.add_argument("--strategies", type=words, default=STRATEGIES)
    parser.add_argument("--targets", type=words, default=[], help="formats that take turns, not the presets' own")
    parser.add_argument("--pipeline", help="as for trueshade render")
    parser.add_argument("--time", help="as for trueshade render")
    parser.add_argument("--size", default="160x120")
    parser.add_argument("--pixels", type=int, default=80, help="of each picture")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--wrong", action="store_true", help="try rules that are wrong: each must be noticed")
    options = parser.parse_args()
    options.scenes = options.scenes or SCENES
    return try_wrong_rules(options) if options.wrong else recompute_all(options)


if __name__ == "__main__":
    sys.exit(main())
