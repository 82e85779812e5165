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


GOOD = np.zeros((4, 3), np.float32)
FACES = np.array([[0, 1, 2]], np.uint32)
GREY = np.zeros((4, 4), np.uint8)


def with_nan(array, place, value=np.nan):
    array = array.copy()
    array[place] = value
    return array


WRONG_MESHES = {
    "a list": ([[0, 0, 0]], FACES, "no NumPy array but of the type list"),
    "None": (None, FACES, "there are none"),
    "float64": (GOOD.astype(np.float64), FACES, "float64"),
    "float16": (GOOD.astype(np.float16), FACES, "float16"),
    "objects": (GOOD.astype(object), FACES, "object"),
    "text": (GOOD.astype("U4"), FACES, "<U4"),
    "records": (np.zeros(4, [("x", "f4"), ("y", "f4"), ("z", "f4")]), FACES, "holds"),
    "swapped bytes": (GOOD.astype(">f4"), FACES, ">f4"),
    "masked": (np.ma.masked_array(GOOD, GOOD == 0), FACES, "masked"),
    "two columns": (GOOD[:, :2].copy(), FACES, r"shape \(4, 2\)"),
    "flat": (GOOD.reshape(-1), FACES, r"shape \(12,?\)"),
    "no dimension": (np.float32(3) * np.ones((), np.float32), FACES, r"no NumPy array|shape \(\)"),
    "columns apart": (np.zeros((4, 6), np.float32)[:, ::2], FACES, "not C-contiguous"),
    "rows backwards": (GOOD[::-1], FACES, "not C-contiguous"),
    "by columns": (np.asfortranarray(GOOD), FACES, "not C-contiguous"),
    "huge without memory": (np.broadcast_to(np.float32(0), (1 << 40, 3)), FACES, "not C-contiguous"),
    "NaN": (with_nan(GOOD, (2, 1)), FACES, r"\[2, 1\] is not finite"),
    "infinite": (with_nan(GOOD, (3, 0), np.inf), FACES, r"\[3, 0\] is not finite"),
    "too far": (with_nan(GOOD, (1, 2), 1e30), FACES, r"\[1, 2\] is over 1e18"),
    "empty": (GOOD[:0], FACES[:0], "empty"),
    "no faces": (GOOD, FACES[:0], "empty"),
    "index too large": (GOOD, FACES + 2, r"\[0, 2\] is 4, and there are 4 positions"),
    "index below 0": (GOOD, np.array([[0, -1, 2]]), "-1"),
    "index of 2**32": (GOOD, np.array([[0, 1, 1 << 32]]), "4294967296"),
    "float indices": (GOOD, FACES.astype(np.float32), "float32"),
    "boolean indices": (GOOD, FACES.astype(bool), "bool"),
    "quads": (GOOD, np.array([[0, 1, 2, 3]], np.uint32), r"shape \(1, 4\)"),
}


def one_clear_error(call, about):
    with pytest.raises(trueshade.Error, match=about) as caught:
        call()
    assert "\n" not in str(caught.value) and len(str(caught.value)) < 400
    assert caught.value.exit_code in (2, 3, 4, 5)


@pytest.mark.parametrize("mistake", WRONG_MESHES)
def test_a_wrong_mesh_is_one_clear_error(mistake):
    positions, indices, about = WRONG_MESHES[mistake]
    scene = trueshade.Scene()
    one_clear_error(lambda: scene.add_mesh(positions, indices), about)
    assert scene.meshes == 0


def test_wrong_streams_of_a_mesh_are_one_clear_error():
    scene = trueshade.Scene()
    for streams, about in [
        ({"normals": GOOD[:3].copy()}, "there are 3, and 4 positions"),
        ({"uv": GOOD}, r"uv: .*shape \(4, 3\)"),
        ({"colors": GOOD}, r"colors: .*shape \(4, 3\)"),
        ({"normals": with_nan(GOOD, (0, 0))}, "normals: .*not finite"),
    ]:
        one_clear_error(lambda streams=streams: scene.add_mesh(GOOD, FACES, **streams), about)


def test_arrays_that_cannot_be_written_to_are_read_and_are_copied():
    positions = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)
    positions.flags.writeable = False
    scene = trueshade.Scene()
    mesh = scene.add_mesh(positions, FACES)
    scene.add_instance(mesh, scene.add_material())
    before = scene.hash
    positions.flags.writeable = True
    positions[...] = 7
    assert scene.hash == before


WRONG_PICTURES = {
    "float64": (np.zeros((4, 4, 4)), "astype.numpy.float32"),
    "booleans": (np.zeros((4, 4, 4), bool), "bool"),
    "int64": (np.zeros((4, 4, 3), np.int64), "int64"),
    "two channels of codes": (np.zeros((4, 4, 2), np.uint8), r"\(4, 4, 2\)"),
    "five channels": (np.zeros((4, 4, 5), np.float32), r"\(4, 4, 5\)"),
    "four dimensions": (np.zeros((1, 4, 4, 4), np.uint8), r"\(1, 4, 4, 4\)"),
    "no rows": (np.zeros((0, 4, 4), np.uint8), r"\(0, 4, 4\)"),
    "swapped bytes": (np.zeros((4, 4, 4), ">u2"), ">u2"),
    "backwards": (np.zeros((4, 4, 4), np.uint8)[::-1], "not C-contiguous"),
    "channels first": (np.moveaxis(np.zeros((3, 4, 4), np.float32), 0, -1), "not C-contiguous"),
    "masked": (np.ma.zeros((4, 4, 4), np.uint8), "masked"),
    "an array of objects": (np.zeros((4, 4, 4), object), "object"),
    "a list": ([[1, 2], [3, 4]], "no NumPy array|expected"),
}


@pytest.mark.parametrize("mistake", WRONG_PICTURES)
def test_a_wrong_picture_is_one_clear_error(mistake, tmp_path):
    picture, about = WRONG_PICTURES[mistake]
    scene, pipeline = trueshade.Scene(), trueshade.Pipeline(size=(4, 4))
    one_clear_error(lambda: trueshade.image_hash(picture), about)
    one_clear_error(lambda: trueshade.write_image(tmp_path / "a.png", picture), about)
    one_clear_error(lambda: trueshade.validate(scene, picture, {}, pipeline), about)
    one_clear_error(lambda: trueshade.validate(scene, None, {"normal": picture}, pipeline), about)
    one_clear_error(lambda: trueshade.shade(scene, {"normal": picture}, pipeline), about)
    if mistake != "a list":  # which is no path either: a TypeError, as open() has it
        one_clear_error(lambda: trueshade.compare(picture, picture), about)
    assert not list(tmp_path.iterdir())


def test_planes_of_any_shape_and_number_are_judged_or_refused():
    """What a program may hand over by mistake neither ends the process nor passes for a G-buffer."""
    scene = trueshade.load_scene("builtin:cornell")
    pipeline = trueshade.Pipeline(size=(8, 6))
    good = trueshade.render(scene, pipeline, planes=["depth", "position", "normal", "albedo", "id.object"])
    random = np.random.default_rng(3)
    kinds = [np.uint8, np.uint16, np.uint32, np.float16, np.float32]
    for _ in range(300):
        planes = {name: np.array(array) for name, array in good.planes.items()}
        name = list(planes)[random.integers(len(planes))]
        shape = [(6, 8, 4), (6, 8), (6, 8, 3), (8, 6, 4), (1, 1)][random.integers(5)]
        wrong = random.choice([0, 1, -1, np.nan, np.inf, 1e30, 255, 4e9], size=shape)
        with np.errstate(all="ignore"):
            planes[name] = wrong.astype(kinds[random.integers(len(kinds))])
        for call in (trueshade.shade, lambda s, p, q: trueshade.validate(s, good.color, p, q)):
            try:
                call(scene, planes, pipeline)
            except trueshade.Error as error:
                assert "\n" not in str(error)


def test_grey_and_opaque_pictures_are_pictures(tmp_path):
    """Arrays of other libraries: (h, w, 3) and (h, w) of codes, against files with and without alpha."""
    color = np.arange(4 * 5 * 3, dtype=np.uint8).reshape(4, 5, 3)
    trueshade.write_image(tmp_path / "a.png", color)
    read = trueshade.read_planes(tmp_path / "a.png")["color"]
    assert np.array_equal(read[..., :3], color) and (read[..., 3] == 255).all()
    assert trueshade.compare(color, tmp_path / "a.png")["outcome"] == "same"
    assert trueshade.compare(read, color)["outcome"] == "same"
    grey = color[..., 0].copy()
    trueshade.write_image(tmp_path / "g.png", grey)
    assert trueshade.compare(tmp_path / "g.png", grey)["outcome"] == "same"
    changed = grey.copy()
    changed[1, 2] += 1
    assert trueshade.compare(tmp_path / "g.png", changed)["unequal_pixels"] == 1


def test_files_are_read_as_they_were_written(tmp_path):
    scene = trueshade.load_scene("builtin:cornell")
    frame = trueshade.render(scene, trueshade.Pipeline(size=(16, 12), target="rgba16f"), planes=["normal", "id.object"])
    frame.save(tmp_path / "a.exr")
    read = trueshade.read_planes(tmp_path / "a.exr")
    assert np.array_equal(read["color"], frame.color)
    for name in ("normal", "id.object"):
        assert np.array_equal(read[name][..., :3], frame.planes[name][..., :3]), name
    assert trueshade.compare(tmp_path / "a.exr", tmp_path / "a.exr")["outcome"] == "same"
    trueshade.write_image(tmp_path / "b.exr", frame.color, planes={"normal": np.array(frame.planes["normal"])})
    assert np.array_equal(trueshade.read_planes(tmp_path / "b.exr")["normal"], read["normal"])
    for wrong, about in [("a.tga", "no image format"), ("nowhere/a.png", "nowhere")]:
        one_clear_or_io(lambda wrong=wrong: frame.save(tmp_path / wrong), about)


def one_clear_or_io(call, about):
    with pytest.raises(trueshade.Error, match=about) as caught:
        call()
    assert caught.value.exit_code in (2, 5)


def test_instances_from_an_array_are_those_added_one_by_one():
    matrices = np.tile(np.eye(4), (5, 1, 1))
    matrices[:, 0, 3] = np.arange(5)

    def scene_with(add):
        scene = trueshade.Scene()
        mesh = scene.add_mesh(np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32), FACES)
        add(scene, mesh, scene.add_material())
        return scene

    one = scene_with(lambda s, mesh, material: [s.add_instance(mesh, material, m) for m in matrices])
    all_at_once = scene_with(lambda s, mesh, material: s.add_instances(mesh, material, matrices))
    assert one.hash == all_at_once.hash and one.instances == 5
    for wrong, about in [
        (matrices[0], r"shape \(4, 4\)"),
        (matrices[:, :2], r"\(5, 2, 4\)"),
        (with_nan(matrices, (1, 1, 1)), "not finite"),
        (with_nan(matrices, (2, 3, 3), 2.0), "matrix 2: the last row"),
    ]:
        one_clear_error(lambda wrong=wrong: all_at_once.add_instances(0, 0, wrong), about)
    assert all_at_once.instances == 5


def test_faults_are_passed_over_and_paths_trusted_where_that_is_asked_for(tmp_path):
    faces = "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n"
    (tmp_path / "lost.obj").write_text("mtllib lost.mtl\n" + faces)
    (tmp_path / "far.mtl").write_text("newmtl m\n")
    (tmp_path / "here").mkdir()
    (tmp_path / "here" / "far.obj").write_text("mtllib ../far.mtl\n" + faces)
    lost, far = str(tmp_path / "lost.obj"), str(tmp_path / "here" / "far.obj")
    one_clear_error(lambda: trueshade.load_scene(lost), "add lenient=True to look at it all the same")
    one_clear_error(lambda: trueshade.load_scene(far), "or trust_paths=True where you trust the file")
    one_clear_error(lambda: trueshade.load_scene(far, lenient=False), "trust_paths")
    assert trueshade.load_scene(far, trust_paths=True).notes == []
    notes = trueshade.load_scene(lost, lenient=True).notes
    assert [note.split(":")[0] for note in notes[-1:]] == ["As lenient=True asks, which makes this no reference"]


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
        (lambda: trueshade.render(scene, planes="depth"), "a list of names"),
        (lambda: trueshade.render(scene, 3), "pass trueshade.Pipeline"),
        (lambda: scene.add_light(color=(1, float("nan"), 0)), "NaN"),
        (lambda: scene.add_light(intensity=float("inf")), "intensity"),
        (lambda: scene.add_light(range=0), "not above 0"),
        (lambda: scene.add_light(direction=(0, 0, 0)), "no length"),
        (lambda: scene.add_material(shininess=2.5), "whole number"),
        (lambda: scene.add_material(roughness=2), "roughness"),
        (lambda: scene.add_material(color_map=7), "no texture 7"),
        (lambda: scene.add_material(color_map="x"), "color_map: it is a str"),
        (lambda: scene.add_material(normal_map=1.0), "normal_map: it is a float"),
        (lambda: scene.add_material(emission_map=True), "emission_map: it is a bool"),
        (lambda: scene.add_material(color_map=2**70), "no texture"),
        (lambda: scene.set_camera((0, 0, 1)), "target: there is none"),
        (lambda: scene.set_camera((0, 0, 1), (0, 0, 0), near=3, far=2), "near"),
        (lambda: scene.set_camera((0, 0, 1), (0, 0, 0), clip_from_world=np.eye(3)), r"shape \(3, 3\)"),
        (lambda: trueshade.Pipeline(values={"width": {1, 2}}), "nothing that JSON has"),
        (lambda: trueshade.compare("a.png", "b.png", psnr=-1), "below 0"),
        (lambda: trueshade.compare(GREY, np.zeros((4, 4, 3), np.uint8)), "test: the array has 3 channels"),
        (lambda: trueshade.compare(np.zeros((4, 4, 4), np.uint8), GREY), "test: the array has no colours"),
        (lambda: trueshade.compare(GREY, GREY, page="x.txt"), "page: 'x.txt' does not end like a page"),
        (lambda: trueshade.explain(scene, 900, 0), "900,0 is not in the picture"),
    ]:
        with pytest.raises(trueshade.Error, match=about):
            call()


def test_errors_name_arguments_of_python_instead_of_options():
    scene = trueshade.load_scene("builtin:cornell")
    nan = np.full((4, 4, 4), np.nan, np.float32)
    told = [str(trueshade.compare(nan, nan)["failures"])]
    pipeline = trueshade.Pipeline(size=(8, 8), strategy="forward-multipass")
    views = trueshade.Pipeline(size=(8, 8), values={"view": "normal"})
    normal = {"normal": trueshade.render(scene, trueshade.Pipeline(size=(8, 8)), planes=["normal"]).planes["normal"]}
    for call in (
        lambda: trueshade.explain(scene, 900, 0),
        lambda: trueshade.shade(scene, normal, pipeline),
        lambda: trueshade.shade(scene, normal, views),
    ):
        with pytest.raises(trueshade.Error) as caught:
            call()
        told.append(str(caught.value))
    for text, argument in zip(told, ["allow_nonfinite=True", "x, y", "strategy", "values['view']"]):
        assert argument in text and "--" not in text, text


def test_a_wrong_call_is_one_line_that_names_the_argument():
    scene = trueshade.Scene()
    for call, line in [
        (lambda: trueshade.render(scene, plane=["depth"]), "render: there is no argument 'plane' (did you mean 'planes'?)"),
        (lambda: trueshade.Pipeline(sise=(8, 8)), "Pipeline: there is no argument 'sise' (did you mean 'size'?)"),
        (lambda: trueshade.strategies(first=1), "strategies: there is no argument 'first' (it has none)"),
        (lambda: scene.add_light(colour=(1, 1, 1)), "Scene.add_light: there is no argument 'colour' (did you mean 'color'?)"),
        (lambda: scene.set_clear(zzz=1), "Scene.set_clear: there is no argument 'zzz' (it has color)"),
        (lambda: trueshade.render(), "render: missing a required argument: 'scene'"),
        (lambda: scene.set_clear((0, 0, 0, 0), 1), "Scene.set_clear: too many positional arguments"),
        (lambda: scene.add_light(7), "Scene.add_light: type is an int, and has to be a str"),
        (lambda: scene.add_light(range="far"), "Scene.add_light: range is a str, and has to be a number"),
        (lambda: scene.add_mesh(GOOD, FACES, flat="yes"), "Scene.add_mesh: flat is a str, and has to be True or False"),
        (lambda: trueshade.render(scene, threads=1.5), "render: threads is a float, and has to be a whole number"),
        (lambda: trueshade.render(3), "render: scene is an int, and has to be a trueshade.Scene"),
        (lambda: trueshade.explain(None, 1, 1), "explain: scene is None, and has to be a trueshade.Scene"),
        (lambda: trueshade.shade(scene, [1]), "shade: planes is a list, and has to be a dict"),
    ]:
        with pytest.raises(TypeError) as caught:
            call()
        assert str(caught.value) == line
        assert caught.value.__cause__ is None and caught.value.__context__ is None


def test_a_camera_of_a_matrix_needs_no_target():
    """As a scene file has it."""
    scene = trueshade.Scene()
    scene.set_camera((1, 2, 3), clip_from_world=np.eye(4))
    other = trueshade.Scene()
    other.set_camera((1, 2, 3), (0, 0, 0), clip_from_world=np.eye(4))
    assert scene.hash == other.hash


def test_none_for_a_scene_is_one_clear_error():
    pipeline = trueshade.Pipeline(size=(8, 8))
    image = np.zeros((8, 8, 4), np.uint8)
    for call in (lambda: trueshade.render(None, pipeline), lambda: trueshade.shade(None, {}),
                 lambda: trueshade.validate(None, image, {}), lambda: trueshade.explain(None, 1, 1)):
        with pytest.raises(TypeError):
            call()
