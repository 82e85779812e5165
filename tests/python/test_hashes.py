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
        trueshade.load_scene(path, 1.25),
        trueshade.Pipeline(size=SIZE, scene=trueshade.load_scene(str(path))),
    )
    assert trueshade.render(trueshade.load_scene(path, 1.25), trueshade.Pipeline(size=SIZE)).hash == frame.hash
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


def test_a_file_of_a_frame_is_the_commands_byte_by_byte(command):
    path = command.folder / "s.json"
    path.write_text(json.dumps({
        "version": 1,
        "camera": {"eye": [0, 1, 4], "target": [0, 0, 0], "fov_deg": 50, "near": 0.1, "far": 50},
        "objects": [{"mesh": "cube", "color": [0.8, 0.5, 0.3]}],
        "lights": [{"type": "ring", "count": 5, "center": [0, 1, 0], "radius": 2, "range": 6, "turn_s": 3}],
    }))  # fmt: skip
    frame = trueshade.render(
        trueshade.load_scene(path, 0.5), trueshade.Pipeline(size=SIZE, target="rgba16f"), planes=["normal", "id.object"]
    )
    for ending, more in (("png", []), ("exr", ["--aov", "normal,id.object"])):
        command("render", path, "--size", "64x48", "--target", "rgba16f", "--time", "0.5", "-o", "theirs." + ending, *more)
        frame.save(command.folder / ("ours." + ending))
        ours, theirs = ((command.folder / f"{name}.{ending}").read_bytes() for name in ("ours", "theirs"))
        assert ours == theirs, ending


def test_a_model_with_lights_of_ours_is_drawn_as_the_command_draws_it(command):
    path = command.folder / "pyramid.ply"
    path.write_text(
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 2\nproperty list uchar int vertex_indices\nend_header\n"
        "-1 0 -1\n1 0 -1\n1 0 1\n0 1 0\n3 0 1 2\n3 1 3 2\n"
    )
    scene = trueshade.load_scene(path)
    for preset in ("many-lights", "punctual", "many-lights"):
        frame = trueshade.render(scene, trueshade.Pipeline(preset, size=SIZE))
        told = command("render", path, "--preset", preset, "--size", "64x48", "--hash")
        assert frame.hash == hash_of(told), preset
        stored = trueshade.explain(scene, 30, 30, trueshade.Pipeline(preset, size=SIZE))["values"]["stored"]
        assert np.array_equal(np.array(stored, np.float32), frame.color[30, 30].astype(np.float32))


def test_a_changed_scene_is_drawn_anew():
    """What was prepared for the frame before is not kept beyond a change."""
    scene = trueshade.load_scene("builtin:cornell")
    pipeline = trueshade.Pipeline(size=SIZE)
    first, version = trueshade.render(scene, pipeline).hash, scene.hash
    scene.add_light("point", position=(0, 0.5, 0), color=(9, 0, 0), range=2)
    assert trueshade.render(scene, pipeline).hash != first and scene.hash != version
    fresh = trueshade.load_scene("builtin:cornell")
    fresh.add_light("point", position=(0, 0.5, 0), color=(9, 0, 0), range=2)
    assert trueshade.render(fresh, pipeline).hash == trueshade.render(scene, pipeline).hash


def test_a_light_program_is_drawn_judged_and_explained(command, tmp_path):
    shader = tmp_path / "mine.glsl"
    shader.write_text(
        "layout(std140) uniform Parameters { float gain; vec3 tint; };\n"
        "vec3 light(Surface s, Light l, View v) {\n"
        "  vec3 d = l.position - s.position;\n"
        "  return gain * tint * s.albedo.rgb * max(dot(s.normal, normalize(d)), 0.0) / (1.0 + dot(d, d));\n"
        "}\n"
    )
    scene = trueshade.load_scene("builtin:cornell")
    pipeline = trueshade.Pipeline(size=SIZE, light_shader=shader, light_parameters={"gain": 4, "tint": (1, 0.5, 0.25)})
    frame = trueshade.render(scene, pipeline, planes=["depth", "position", "normal", "albedo", "id.object"])
    told = command(
        "render", "builtin:cornell", "--size", "64x48", "--light-shader", str(shader), "--light-parameter", "gain=4",
        "--light-parameter", "tint=1,0.5,0.25", "--hash",
    )  # fmt: skip
    assert frame.hash == hash_of(told)
    assert trueshade.validate(scene, frame.color, frame.planes, pipeline)["pass"]
    wrong = trueshade.Pipeline(size=SIZE, light_shader=shader, light_parameters={"gain": 4.2, "tint": (1, 0.5, 0.25)})
    assert not trueshade.validate(scene, frame.color, frame.planes, wrong)["pass"]
    assert trueshade.explain(scene, 30, 20, pipeline)["values"]["stored"] == frame.color[20, 30].tolist()
    shipped = trueshade.render(scene, trueshade.Pipeline(size=SIZE, light_shader="wrapped", light_parameters={"wrap": 0.5}))
    assert shipped.hash != frame.hash


def test_a_value_of_another_type_than_its_parameter_is_refused(tmp_path):
    shader = tmp_path / "typed.glsl"
    shader.write_text(
        "layout(std140) uniform Parameters { float gain; int count; uint seed; vec2 pair; };\n"
        "vec3 light(Surface s, Light l, View v) { return vec3(gain, count + int(seed), pair.x + pair.y); }\n"
    )
    scene = trueshade.load_scene("builtin:cornell")
    right = {"gain": 0.5, "count": -1, "seed": 2, "pair": (1, 2)}
    wrong = {"gain": ((1, 2), "a float"), "count": (0.5, "an int"), "seed": (-1, "a uint"), "pair": (3, "a vec2")}

    def draw(**changed):
        return trueshade.render(scene, trueshade.Pipeline(size=SIZE, light_shader=shader, light_parameters=right | changed))

    assert draw().hash
    for name, (value, kind) in wrong.items():
        with pytest.raises((ValueError, trueshade.Error), match=f"'{name}' is {kind}, and .* is given"):
            draw(**{name: value})


def test_a_wrong_light_program_is_said_with_its_place(tmp_path):
    shader = tmp_path / "wrong.glsl"
    shader.write_text("vec3 light(Surface s, Light l, View v) { return s.nothing; }\n")
    scene = trueshade.load_scene("builtin:cornell")
    with pytest.raises(trueshade.Error, match="wrong.glsl:1:"):
        trueshade.render(scene, trueshade.Pipeline(size=SIZE, light_shader=shader))
    with pytest.raises((ValueError, trueshade.Error), match="light_shader"):
        trueshade.Pipeline(light_parameters={"gain": 1})
    with pytest.raises((ValueError, trueshade.Error), match="cannot be read"):
        trueshade.Pipeline(light_shader=str(tmp_path / "none.glsl"))


def test_the_light_program_of_a_preset_goes_through_json():
    loaded = trueshade.load_scene("builtin:cornell")
    named = trueshade.Pipeline("gltf", size=SIZE)
    read = trueshade.Pipeline(values=named.to_json())
    assert read == named
    assert trueshade.render(loaded, read).hash == trueshade.render(loaded, named).hash


def test_a_model_without_a_camera_and_its_orbits_are_seen_as_the_command_sees_them(command):
    path = command.folder / "m.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 0 3 1\nf 1 2 3\n")
    scene = trueshade.load_scene(path)

    def told(*options):
        return hash_of(command("render", path, "--preset", "many-lights", "--size", "64x24", "--hash", *options))

    pipeline = trueshade.Pipeline("many-lights", size=(64, 24))
    assert trueshade.render(scene, pipeline).hash == told()
    scene.set_orbit(30, 20, size=(64, 24))
    assert trueshade.render(scene, pipeline).hash == told("--orbit", "30,20")
    scene.set_orbit(30, 20, 5.5, look_at=(0, 1, 0), fov_deg=40, size=(64, 24))
    assert trueshade.render(scene, pipeline).hash == told("--orbit", "30,20,5.5", "--look-at", "0,1,0", "--fov", "40")
    with pytest.raises(trueshade.Error, match="--camera: m.obj has no camera 'Side'"):
        trueshade.load_scene(path, camera="Side")
    with pytest.raises(trueshade.Error, match="elevation_deg"):
        scene.set_orbit(0, 91)
