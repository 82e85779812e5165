"""Frames of the module have the hashes of the command."""

import json

import numpy as np
import pytest
import trueshade

SCENES = ["city", "sphere", "cornell", "circle", "lecture", "atrium", "rabbits", "red"]
SIZE = (64, 48)


def hash_of(output):
    return output.split()[0]


@pytest.mark.parametrize("scene", SCENES)
def test_every_preset_has_the_commands_hash(command, scene):
    loaded = trueshade.load_scene("builtin:" + scene)
    presets = trueshade.presets() if scene not in ("rabbits", "red") else ["many-lights"]
    for preset in presets:
        frame = trueshade.render(loaded, trueshade.Pipeline(preset, size=SIZE))
        told = command("render", "builtin:" + scene, "--preset", preset, "--size", "64x48", "--hash")
        assert frame.hash == hash_of(told), preset


@pytest.mark.parametrize("strategy", trueshade.strategies())
def test_every_strategy_and_target_has_the_commands_hash(command, strategy):
    loaded = trueshade.load_scene("builtin:cornell")
    for target in ("rgba8", "srgb8_a8", "rgb10_a2", "rgba16", "r11g11b10f", "rgb16f", "rgba16f", "rgba32f"):
        pipeline = trueshade.Pipeline("light-volumes", size=SIZE, strategy=strategy, target=target)
        frame = trueshade.render(loaded, pipeline)
        told = command(
            "render", "builtin:cornell", "--preset", "light-volumes", "--size", "64x48", "--strategy", strategy,
            "--target", target, "--hash",
        )  # fmt: skip
        assert frame.hash == hash_of(told)
        assert frame.format == target
        assert trueshade.image_hash(frame.color, target) == frame.hash


def test_a_scene_of_its_own_pipeline_and_time_is_drawn_as_the_command_draws_it(command):
    scene = {
        "version": 1,
        "camera": {"eye": [0, 1, 4], "target": [0, 0, 0], "fov_deg": 50, "near": 0.1, "far": 50},
        "objects": [{"mesh": "cube", "color": [0.8, 0.5, 0.3]}],
        "lights": [{"type": "ring", "count": 5, "center": [0, 1, 0], "radius": 2, "range": 6, "turn_s": 3}],
        "pipeline": {"preset": "many-lights", "target": "rgba16f"},
    }
    del scene["pipeline"]["preset"]
    path = command.folder / "s.json"
    path.write_text(json.dumps(scene))
    frame = trueshade.render(
        trueshade.load_scene(str(path), 1.25),
        trueshade.Pipeline(size=SIZE, scene=trueshade.load_scene(str(path))),
    )
    assert frame.format == "rgba16f"
    assert frame.hash == hash_of(command("render", path, "--size", "64x48", "--time", "1.25", "--hash"))


def test_threads_and_simd_targets_change_no_bit():
    scene = trueshade.load_scene("builtin:city")
    pipeline = trueshade.Pipeline(size=SIZE)
    frames = [trueshade.render(scene, pipeline, threads=t, simd=s) for t in (1, 2, 3) for s in ("best", "scalar")]
    assert len({frame.hash for frame in frames}) == 1


def test_planes_are_those_of_the_command(command):
    scene = trueshade.load_scene("builtin:cornell")
    planes = ["depth", "position", "normal", "albedo", "id.object", "light.count", "light.0"]
    frame = trueshade.render(scene, trueshade.Pipeline(size=SIZE), planes=planes)
    assert sorted(frame.planes) == sorted(planes)
    assert frame.planes["normal"].shape == (48, 64, 4)
    assert frame.planes["id.object"].dtype == np.uint32
    assert frame.color.shape == (48, 64, 4)
    assert frame.stats["covered_pixels"] == int((frame.planes["id.object"] > 0).sum())
    told = json.loads(command("info", "builtin:cornell", "--resolved", "--size", "64x48"))
    assert len(told["lights"]) == frame.stats["lights"]


def test_shade_makes_of_the_planes_the_frame():
    scene = trueshade.load_scene("builtin:city")
    pipeline = trueshade.Pipeline(size=SIZE)
    frame = trueshade.render(scene, pipeline, planes=["depth", "position", "normal", "albedo", "id.object"])
    assert trueshade.shade(scene, frame.planes, pipeline).hash == frame.hash


def test_validate_accepts_the_frame_and_convicts_another():
    scene = trueshade.load_scene("builtin:city")
    pipeline = trueshade.Pipeline(size=SIZE)
    frame = trueshade.render(scene, pipeline, planes=["depth", "position", "normal", "albedo", "id.object"])
    assert trueshade.validate(scene, frame.color, frame.planes, pipeline)["pass"]
    wrong = frame.color.copy()
    wrong[20:30, 20:30, 0] ^= 16
    assert not trueshade.validate(scene, wrong, frame.planes, pipeline)["pass"]


def test_explain_ends_in_the_pixel():
    scene = trueshade.load_scene("builtin:lecture")
    pipeline = trueshade.Pipeline("redsdk", size=SIZE)
    frame = trueshade.render(scene, pipeline)
    random = np.random.default_rng(1)
    for _ in range(20):
        x, y = int(random.integers(64)), int(random.integers(48))
        assert trueshade.explain(scene, x, y, pipeline)["values"]["stored"] == frame.color[y, x].tolist()
