"""Makes tests/scenes/gltf/data/blender_tangents.gltf, a model with the tangents that Blender gives it. They are those
of MikkTSpace, by Blender's version of the code of Morten S. Mikkelsen. Run as

    blender --background --factory-startup --python scripts/blender_tangents.py -- OUT.gltf

Each object is a case of MikkTSpace's rules. All faces are triangles, so that the exported triangles are those that
tangents were made for. Texture coordinates are multiples of 1/1024, of which the exporter's 1 - v is exact."""
import json
import math
import sys

import bmesh
import bpy

TEXELS = 1024


def normal_mapped():
    """A material with a normal map, which is level and has two by two texels."""
    image = bpy.data.images.new("level", 2, 2)
    image.colorspace_settings.name = "Non-Color"
    image.pixels = [0.5, 0.5, 1.0, 1.0] * 4
    image.file_format = "PNG"
    image.pack()
    material = bpy.data.materials.new("bumps")
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    texture, bumps = nodes.new("ShaderNodeTexImage"), nodes.new("ShaderNodeNormalMap")
    texture.image = image
    links.new(texture.outputs["Color"], bumps.inputs["Color"])
    links.new(bumps.outputs["Normal"], nodes["Principled BSDF"].inputs["Normal"])
    return material


def add(name, material, vertices, faces, flat=(), scale=(1.0, 1.0, 1.0)):
    """Adds an object. A face is a list of (vertex, u, v), of three or more; `flat` are the indices of flat faces."""
    mesh = bmesh.new()
    layer = mesh.loops.layers.uv.new("UVMap")
    corners = [mesh.verts.new(vertex) for vertex in vertices]
    for index, face in enumerate(faces):
        made = mesh.faces.new([corners[vertex] for vertex, _, _ in face])
        made.smooth = index not in flat
        for loop, (_, u, v) in zip(made.loops, face):
            loop[layer].uv = (round(u * TEXELS) / TEXELS, round(v * TEXELS) / TEXELS)
    bmesh.ops.triangulate(mesh, faces=mesh.faces[:])
    mesh.normal_update()
    data = bpy.data.meshes.new(name)
    mesh.to_mesh(data)
    mesh.free()
    data.materials.append(material)
    thing = bpy.data.objects.new(name, data)
    thing.scale = scale
    thing.location.x = 3.0 * len(bpy.context.scene.collection.objects)
    bpy.context.scene.collection.objects.link(thing)


# --- Shapes: vertices, and faces with their texture coordinates -------------------------------------------------------


def bend(x, y):
    return 0.3 * math.sin(1.7 * x) + 0.2 * math.cos(2.3 * y + x)


def turned(x, y):
    """Texture coordinates of a picture that lies turned and bent over a plane."""
    return 0.5 + 0.3 * x - 0.2 * y + 0.05 * x * y, 0.4 + 0.25 * x + 0.3 * y - 0.07 * x * x


def torus(columns, rows, repeats):
    """Its picture is repeated along the ring, and has seams."""
    vertices = []
    for j in range(rows):
        for i in range(columns):
            a, b = 2.0 * math.pi * i / columns, 2.0 * math.pi * j / rows
            ring = 1.0 + 0.4 * math.cos(b)
            vertices.append((ring * math.cos(a), ring * math.sin(a), 0.4 * math.sin(b)))

    def corner(i, j):
        return j % rows * columns + i % columns, repeats * i / columns, j / rows

    return vertices, quads(columns, rows, corner)


def sheet(columns, rows, uv):
    """A bent grid of quads whose vertex (i, j) has the texture coordinates uv(i, j)."""
    vertices = [(0.7 * i, 0.6 * j, bend(i, j)) for j in range(rows + 1) for i in range(columns + 1)]
    return vertices, quads(columns, rows, lambda i, j: (j * (columns + 1) + i, *uv(i, j)))


def quads(columns, rows, corner):
    return [[corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)]
            for j in range(rows) for i in range(columns)]


def fan(angles, closed):
    """Triangles around a vertex, of these angles in degrees as seen from above."""
    vertices, uv, at = [(0.0, 0.0, 0.3)], [(0.5, 0.5)], 0.0
    for k, angle in enumerate(angles if closed else [*angles, 0]):
        x, y, length = math.cos(math.radians(at)), math.sin(math.radians(at)), 0.6 + 0.35 * math.sin(3.0 * k)
        vertices.append((length * x, length * y, 0.25 * math.cos(5.0 * k)))
        uv.append((0.5 + 0.3 * x + 0.12 * math.sin(2.0 * k), 0.5 + 0.4 * y + 0.1 * math.cos(7.0 * k)))
        at += angle
    rim = [(k, *uv[k]) for k in range(1, len(vertices))]
    return vertices, [[(0, *uv[0]), rim[k], rim[(k + 1) % len(rim)]] for k in range(len(angles))]


def fan_without_area():
    """A fan, one of whose triangles has an edge without length in texture coordinates."""
    vertices, faces = fan([70, 40, 100, 150], closed=True)
    centre, second, third = faces[2]
    faces[2] = [centre, second, (third[0], *second[1:])]
    return vertices, faces


def sheet_without_area():
    """A sheet of which one quad is a line and another a point in texture coordinates, which no other quad has."""
    vertices, faces = sheet(3, 3, lambda i, j: turned(0.5 * i, 0.4 * j))
    line = [(0.5, 0.25), (0.25, 0.5), (0.5, 0.25), (0.75, 0.0)]
    faces[4] = [(vertex, *uv) for (vertex, _, _), uv in zip(faces[4], line)]
    faces[8] = [(vertex, 0.5, 0.5) for vertex, _, _ in faces[8]]
    return vertices, faces


def cylinder(sides):
    """A side, and two caps that are one polygon each."""
    ring = [(math.cos(2.0 * math.pi * k / sides), math.sin(2.0 * math.pi * k / sides)) for k in range(sides)]
    vertices = [(x, y, z) for z in (-0.8, 0.8) for x, y in ring]
    faces = []
    for k in range(sides):
        after, left, right = (k + 1) % sides, k / sides, (k + 1) / sides
        faces.append([(k, left, 0), (after, right, 0), (sides + after, right, 0.75), (sides + k, left, 0.875)])
    faces.append([(k, *turned(*ring[k])) for k in reversed(range(sides))])
    faces.append([(sides + k, *turned(ring[k][1], ring[k][0])) for k in range(sides)])
    return vertices, faces


def polygon():
    """A polygon that is not convex, and a triangle beside it."""
    ring = [(0, 0), (1.2, -0.3), (1.6, 0.7), (0.9, 0.5), (0.8, 1.4), (-0.2, 1.1), (0.2, 0.6)]
    vertices = [(x, y, 0.15 * bend(2 * x, 3 * y)) for x, y in ring] + [(0.5, -1.1, 0.4)]
    corners = [(k, *turned(x, y)) for k, (x, y) in enumerate(ring)]
    return vertices, [corners, [corners[1], corners[0], (7, *turned(0.7, -0.9))]]


def listed(vertices, uv, triangles):
    return vertices, [[(k, *uv[k]) for k in triangle] for triangle in triangles]


def pages():
    """Three triangles on one edge. The first two of them go along the edge upwards, and the third downwards."""
    return listed([(0, 0, 0), (0, 0, 1), (1, 0.2, 0.4), (-0.5, 0.9, 0.6), (-0.6, -0.8, 0.3)],
                  [(0.5, 0.125), (0.5, 0.875), (0.875, 0.25), (0.125, 0.5), (0.75, 0.5)],
                  [(0, 1, 2), (0, 1, 4), (1, 0, 3)])


def bow_tie():
    """Two pairs of triangles that share a vertex and no edge."""
    return listed([(0, 0, 0), (1, -0.4, 0.1), (1.1, 0.2, 0), (0.9, 0.8, 0.3), (-1, 0.3, 0.2), (-0.9, -0.2, 0),
                   (-0.7, -0.9, 0.1)],
                  [(0.5, 0.5), (0.875, 0.25), (1, 0.5625), (0.75, 0.875), (0.375, 0.9375), (0.125, 0.75),
                   (0.0625, 0.375)],
                  [(0, 1, 2), (0, 2, 3), (0, 4, 5), (0, 5, 6)])


def strip_with_a_line():
    """Of one triangle of the strip, two vertices are at one place."""
    return listed([(0, 0, 0), (1, 0, 0.2), (1, 1, 0.1), (0, 1, 0.3), (1, 0, 0.2), (2, 0.3, 0)],
                  [(0, 0), (0.5, 0.0625), (0.4375, 0.5), (0.125, 0.625), (0.5625, 0.125), (0.875, 0.25)],
                  [(0, 1, 2), (0, 2, 3), (1, 4, 2), (4, 5, 2)])


def add_objects():
    bumps = normal_mapped()
    add("torus", bumps, *torus(8, 6, repeats=1))
    add("torus, scaled unevenly", bumps, *torus(5, 4, repeats=2), scale=(1.0, 0.4, 2.5))
    add("halves that share texels", bumps, *sheet(4, 3, lambda i, j: (abs(i - 2) / 2, 0.3 * j + 0.02 * i * i)))
    add("halves, v mirrored", bumps, *sheet(2, 4, lambda i, j: (0.4 * i + 0.03 * j, abs(j - 2) / 2)))
    add("closed fan", bumps, *fan([8, 25, 90, 50, 3, 74, 15, 95], closed=True))
    add("open fan", bumps, *fan([120, 6, 60, 20], closed=False))
    add("no uv area: alone", bumps, *sheet_without_area())
    add("no uv area: in a fan", bumps, *fan_without_area())
    add("no uv area: between mirrored rows", bumps,
        *sheet(3, 3, lambda i, j: (0.25 * i + 0.03 * (j > 1), (0.0, 0.5, 0.5, 0.125)[j])))
    add("no uv area: rows mirrored first", bumps,
        *sheet(2, 3, lambda i, j: (0.4 * i + 0.05 * (j > 1), (0.75, 0.25, 0.25, 0.875)[j])))
    add("no uv area: between columns", bumps,
        *sheet(4, 2, lambda i, j: ((0.0, 0.25, 0.25, 0.625, 1.0)[i], 0.4 * j + (0.0, 0.05, 0.05, 0.1, 0.0)[i])))
    add("smooth side, flat caps", bumps, *cylinder(7), flat=(7, 8), scale=(0.5, 1.0, 1.0))
    add("flat among smooth", bumps, *sheet(3, 2, lambda i, j: turned(0.5 * i, 0.4 * j)), flat=(1, 3, 5))
    add("pages", bumps, *pages())
    add("bow tie", bumps, *bow_tie())
    add("polygon", bumps, *polygon())
    add("strip with a line", bumps, *strip_with_a_line())


def export(path):
    bpy.ops.export_scene.gltf(filepath=path, export_format="GLTF_EMBEDDED", export_tangents=True,
                              export_animations=False,
                              export_copyright=f"Trueshade; tangents by MikkTSpace in Blender {bpy.app.version_string}")
    with open(path, encoding="utf-8") as file:
        document = json.load(file)
    with open(path, "w", encoding="utf-8") as file:  # without the exporter's indentation
        json.dump(document, file, separators=(",", ":"))
        file.write("\n")


bpy.ops.wm.read_factory_settings(use_empty=True)
add_objects()
export(sys.argv[sys.argv.index("--") + 1])
