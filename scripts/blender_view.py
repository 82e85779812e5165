"""What Blender shows of models: run by scripts/model_sheets.py as `blender --background --python blender_view.py -- JOBS.json`.

JOBS.json is a list of {"model", "picture", "camera", "size"}, the camera as `trueshade info --resolved` has it."""
import json
import math
import sys

import bpy
import mathutils
import numpy

numpy.bool = bool  # the glTF importer of Debian 12 has the old name

SAMPLES = 16


def imported(path):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    ending = path.rsplit(".", 1)[-1].lower()
    if ending in ("gltf", "glb"):
        bpy.ops.import_scene.gltf(filepath=path)
    elif ending == "obj":
        bpy.ops.wm.obj_import(filepath=path)
    else:
        bpy.ops.import_mesh.ply(filepath=path)
        for model in bpy.context.selected_objects:
            model.matrix_world = mathutils.Matrix.Rotation(math.radians(90), 4, "X") @ model.matrix_world


def from_y_up(v):
    """Blender's z is up; its importers turn files of glTF and OBJ so."""
    return mathutils.Vector((v[0], -v[2], v[1]))


def seen_through(camera, size):
    data = bpy.data.cameras.new("view")
    data.clip_start, data.clip_end = camera["near"], camera["far"]
    data.sensor_fit, angle = ("HORIZONTAL", camera["fov_x_rad"]) if camera.get("fov_x_rad") else ("VERTICAL",
                                                                                                camera["fov_y_rad"])
    data.angle = angle
    eye, target, up = (from_y_up(camera[name]) for name in ("eye", "target", "up"))
    back = (eye - target).normalized()
    right = up.cross(back).normalized()
    view = bpy.data.objects.new("view", data)
    view.matrix_world = mathutils.Matrix.Translation(eye) @ mathutils.Matrix(
        (right, back.cross(right), back)).transposed().to_4x4()
    bpy.context.scene.collection.objects.link(view)
    scene = bpy.context.scene
    scene.camera = view
    scene.render.resolution_x, scene.render.resolution_y = size
    scene.render.resolution_percentage = 100
    return right, back.cross(right), back


def lit(right, up, back):
    """A grey sky and a sun over the left shoulder; lights of the file stay out, for their units are another matter."""
    for light in [one for one in bpy.data.objects if one.type == "LIGHT"]:
        bpy.data.objects.remove(light)
    scene = bpy.context.scene
    scene.world = bpy.data.worlds.new("sky")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.5, 0.5, 0.52, 1)
    sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    sun.data.energy, sun.data.angle = 2.5, 0.1
    toward = (back - 0.6 * right + 0.8 * up).normalized()
    sun.matrix_world = toward.to_track_quat("Z", "Y").to_matrix().to_4x4()
    scene.collection.objects.link(sun)


def drawn(picture):
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.max_bounces, scene.cycles.use_denoising = SAMPLES, 3, False
    scene.view_settings.view_transform = "Standard"
    scene.render.image_settings.file_format, scene.render.image_settings.color_mode = "PNG", "RGB"
    scene.render.filepath = picture
    bpy.ops.render.render(write_still=True)


for job in json.load(open(sys.argv[sys.argv.index("--") + 1])):
    try:
        imported(job["model"])
        lit(*seen_through(job["camera"], job["size"]))
        drawn(job["picture"])
    except Exception as error:  # a model that Blender does not take has no picture
        print(f"blender_view: {job['model']}: {error}", file=sys.stderr)
