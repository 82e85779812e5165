"""Scenes built from arrays are the same scenes as JSON; a wrong array is one clear error."""

import json

import numpy as np
import pytest
import trueshade

SIZE = (40, 30)
PLY = """ply
format ascii 1.0
element vertex {n}
property float x
property float y
property float z
property float nx
property float ny
property float nz
element face {t}
property list uchar int vertex_indices
end_header
"""


def exact(value):
    """A float32 as JSON that gives it back."""
    return float(np.float32(value))


def random_scene(random, folder):
    """The same scene twice: from arrays, and from files."""
    n, t = int(random.integers(6, 30)), int(random.integers(4, 20))
    positions = random.uniform(-1.5, 1.5, (n, 3)).astype(np.float32)
    normals = random.normal(size=(n, 3)).astype(np.float32)
    triangles = np.stack([random.permutation(n)[:3] for _ in range(t)]).astype(np.uint32)
    text = PLY.format(n=n, t=t)
    for p, m in zip(positions, normals):
        text += " ".join(repr(exact(v)) for v in (*p, *m)) + "\n"
    for a, b, c in triangles:
        text += f"3 {a} {b} {c}\n"
    (folder / "mesh.ply").write_text(text)
    color = [exact(v) for v in random.uniform(0.1, 1, 3)]
    eye = [exact(v) for v in (random.uniform(-1, 1), random.uniform(-1, 1), 4)]
    scene = trueshade.Scene()
    mesh = scene.add_mesh(positions, triangles, normals)
    material = scene.add_material([*color, 1.0])
    scene.add_instance(mesh, material)
    scene.set_camera(eye, (0, 0, 0), fov_deg=55.0, near=0.5, far=20.0)
    lights = []
    for _ in range(int(random.integers(1, 12))):
        light = {
            "type": "point",
            "position": [exact(v) for v in random.uniform(-3, 3, 3)],
            "color": [exact(v) for v in random.uniform(0, 1, 3)],
            "intensity": exact(random.uniform(0.2, 2)),
            "range": exact(random.uniform(1, 6)),
        }
        lights.append(light)
        scene.add_light(
            "point", position=light["position"], color=light["color"], intensity=light["intensity"],
            range=light["range"],
        )  # fmt: skip
    document = {
        "version": 1,
        "camera": {"eye": eye, "target": [0, 0, 0], "fov_deg": 55.0, "near": 0.5, "far": 20.0},
        "objects": [{"geometry": "mesh.ply", "color": color}],
        "lights": lights,
    }
    (folder / "scene.json").write_text(json.dumps(document))
    return scene, trueshade.load_scene(str(folder / "scene.json"))


def test_a_thousand_random_scenes_from_arrays_equal_the_same_scenes_from_files(tmp_path):
    random = np.random.default_rng(7)
    drawn = 0
    for i in range(1000):
        from_arrays, from_files = random_scene(random, tmp_path)
        preset = trueshade.presets()[i % len(trueshade.presets())]
        pipeline = trueshade.Pipeline(preset, size=SIZE, target="rgba32f")
        a, b = trueshade.render(from_arrays, pipeline), trueshade.render(from_files, pipeline)
        assert a.hash == b.hash, i
        drawn += a.stats["covered_pixels"]
    assert drawn > 1000 * 50


def test_textures_instances_and_spot_lights_are_drawn():
    scene = trueshade.Scene()
    quad = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], np.float32)
    uv = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], np.float32)
    texels = np.zeros((2, 2, 4), np.uint8)
    texels[..., 3] = 255
    texels[0, 0] = (255, 0, 0, 255)
    texture = scene.add_texture(texels, srgb=False, mipmaps=False)
    mesh = scene.add_mesh(quad, np.array([[0, 1, 2], [0, 2, 3]]), uv=uv)
    scene.add_instance(mesh, scene.add_material(color_map=texture), np.eye(4))
    scene.add_light("ambient", color=(1, 1, 1))
    scene.add_light("spot", position=(0, 0, 2), direction=(0, 0, -2), cone_deg=10, penumbra_deg=5, range=9)
    scene.set_camera((0, 0, 3), (0, 0, 0), fov_deg=45)
    frame = trueshade.render(scene, trueshade.Pipeline("light-volumes", size=(64, 64)))
    red = frame.color[50, 14]  # texel [0, 0] is at u = v = 0, the quad's lower left corner
    assert red[0] > 200 and red[1] == 0
    assert frame.color[18, 45, 0] < 10  # the middle of texel [1, 1], which is black


def wrong_meshes():
    good = np.zeros((4, 3), np.float32)
    faces = np.array([[0, 1, 2]], np.uint32)
    nan = good.copy()
    nan[2, 1] = np.nan
    return [
        ((good.astype(np.float64), faces), "float64"),
        ((good[:, :2], faces), r"shape \(4, 2\)"),
        ((np.zeros((4, 6), np.float32)[:, ::2], faces), "not C-contiguous"),
        ((nan, faces), r"\[2, 1\] is not finite"),
        ((good, faces + 2), r"\[0, 2\] is 4, and there are 4 positions"),
        ((good, faces.astype(np.float32)), "float32"),
        ((good, np.array([[0, -1, 2]])), "-1"),
        ((good, faces, good[:3]), "there are 3, and 4 positions"),
    ]


@pytest.mark.parametrize("arguments, about", wrong_meshes())
def test_a_wrong_array_is_one_clear_error(arguments, about):
    with pytest.raises(trueshade.Error, match=about) as caught:
        trueshade.Scene().add_mesh(*arguments)
    assert "\n" not in str(caught.value)
    assert caught.value.exit_code == 3


def test_wrong_names_and_numbers_are_one_clear_error():
    scene = trueshade.Scene()
    for call, about in [
        (lambda: trueshade.load_scene("nothing.json"), "nothing.json"),
        (lambda: trueshade.load_scene("builtin:nowhere"), "nowhere"),
        (lambda: trueshade.Pipeline("nothing"), "no preset 'nothing'"),
        (lambda: trueshade.Pipeline(values={"sice": 3}), "sice"),
        (lambda: trueshade.Pipeline(size=(0, 5)), "1 to 65536"),
        (lambda: trueshade.Pipeline(strategy="deferred"), "strategy"),
        (lambda: scene.add_instance(0, 0), "no mesh 0"),
        (lambda: scene.add_light("laser"), "laser"),
        (lambda: scene.add_light(position=(1, 2)), "2 numbers"),
        (lambda: scene.set_camera((0, 0, "x"), (0, 0, 0)), "no number"),
        (lambda: trueshade.render(scene, planes=["depths"]), "depths"),
        (lambda: trueshade.image_hash(np.zeros((4, 4, 4))), "float64"),
        (lambda: trueshade.explain(scene, 900, 0), "900,0 is not in the picture"),
    ]:
        with pytest.raises(trueshade.Error, match=about):
            call()
