"""docs/arithmetic.md sections 2, 5, 6, 7 and 13: what surfaces a pixel has, and what its planes hold."""
import math

import numpy as np

import formats
import host
import textures
import triangles as tri
from fragments import Draw
from resolved import floats

f32 = np.float32
TRIANGLES_AT_ONCE = 400000


def unit_rows(v):
    """Of f32 vectors [n, 3]."""
    with np.errstate(all="ignore"):
        length2 = (v[:, 0] * v[:, 0] + v[:, 1] * v[:, 1]) + v[:, 2] * v[:, 2]
        r = np.where(length2 > 0, f32(1) / np.sqrt(length2), f32(0))
        return v * r[:, None]


class Geometry:
    """The triangles of a scene. Attributes of corners: position (3), normal (3), colour (4), then (u, v) of each set, and
    the tangent (3) and its w where the mesh has any."""

    def __init__(self, scene):
        self.scene, self.window = scene, tri.Window(scene["viewport"], scene["pipeline"]["geometry"])
        self.matrices = [self.matrices_of(o) for o in scene["objects"]]
        self.draws = []
        group, count = [], 0
        for index, o in enumerate(scene["objects"]):
            group.append(index)
            count += len(scene["meshes"][o["mesh"]]["triangles"])
            if count >= TRIANGLES_AT_ONCE or index + 1 == len(scene["objects"]):
                self.draws.append(self.draw_of(group))
                group, count = [], 0

    def matrices_of(self, o):
        """clip, world and normal from object, made from world_from_object and held to what the document says."""
        world = floats(o["world_from_object"])
        square = [[float(v) for v in row] for row in world] + [[0.0, 0.0, 0.0, 1.0]]
        clip = host.rounded(host.product(self.scene["camera"]["clip_from_world"], square))
        normal = host.normal_from_object(world)
        assert same(clip, floats(o["clip_from_object"])), "clip_from_object"
        assert same(normal, floats(o["normal_from_object"])), "normal_from_object"
        return clip, world, normal

    def draw_of(self, objects):
        clip, rows, owner, first = [], [], [], 0
        for index in objects:
            mesh = self.scene["meshes"][self.scene["objects"][index]["mesh"]]
            clip.append(tri.transformed(self.matrices[index][0], mesh["position"]))
            rows.append(mesh["triangles"].astype(np.int64) + first)
            owner.append((first, index))
            first += mesh["position"].shape[1]
        starts = np.cumsum([0] + [len(r) for r in rows])

        def place_of(triangle):
            k = int(np.searchsorted(starts, triangle, side="right")) - 1
            return objects[k], int(triangle - starts[k])

        draw = Draw(np.concatenate(clip), np.concatenate(rows), self.window,
                    lambda triangle: self.attributes(*place_of(triangle)))
        draw.place_of = place_of
        return draw

    def attributes(self, index, triangle):
        o = self.scene["objects"][index]
        mesh = self.scene["meshes"][o["mesh"]]
        _, world, normal = self.matrices[index]
        v = mesh["triangles"][triangle]
        position = tri.transformed(world, mesh["position"][:, v])
        x, y, z = mesh["normal"][:, v]
        turned = np.stack([(m[0] * x + m[1] * y) + m[2] * z for m in normal], axis=1)
        if self.scene["pipeline"]["gbuffer"]["unit_normals"] != "fragment":
            turned = unit_rows(turned)
        color = np.ones((3, 4), f32) if mesh["color"] is None else mesh["color"][:, v].T
        sets = [np.zeros((3, 2), f32) if uv is None else uv[:, v].T for uv in mesh["uv"]]
        if mesh["tangent"] is not None:
            x, y, z, w = mesh["tangent"][:, v]
            sets.append(np.stack([(m[0] * x + m[1] * y) + m[2] * z for m in world] + [w], axis=1))
        return [[float(a) for a in row] for row in np.concatenate([position, turned, color] + sets, axis=1)]

    def fragments(self, sample):
        """Those that culling and alpha masks leave, in the order of submission, with their object and depth."""
        geometry = self.scene["pipeline"]["geometry"]
        found = []
        for draw in self.draws:
            for f in draw.fragments(sample):
                f.object, f.triangle = draw.place_of(f.triangle)
                o = self.scene["objects"][f.object]
                material = self.scene["materials"][o["material"]]
                if tri.is_culled(f.counter_clockwise, geometry["cull_face"], geometry["front_face"], o["mirrored"],
                                 material["double_sided"]):
                    continue
                f.transparent = material["transparent"] and self.scene["pipeline"]["transparency"]["mode"] != "none"
                f.stored_depth = stored_depth(f.depth(self.window), geometry["depth_format"])
                if float(material["alpha_cutoff"]) > 0 and albedo_of(self.scene, f)[3] < f32(material["alpha_cutoff"]):
                    continue
                found.append(f)
        return found


def same(a, b):
    return np.array_equal(np.asarray(a).view(np.uint32), np.asarray(b).view(np.uint32))


def stored_depth(depth, name):
    if name == "d32f":
        return f32(depth)
    largest = f32(2 ** {"d24": 24, "d16": 16}[name] - 1)
    return np.rint(f32(depth) * largest) / largest


COMPARISONS = {"less": np.less, "lequal": np.less_equal, "greater": np.greater, "gequal": np.greater_equal,
               "equal": np.equal, "notequal": np.not_equal}


def passes(f, depth, geometry):
    func = geometry["depth_func"]
    return func == "always" or (func != "never" and bool(COMPARISONS[func](f.stored_depth, depth)))


def visible(fragments, geometry):
    """The opaque fragment that the depth test leaves, and the depth plane."""
    depth, winner = stored_depth(f32(geometry["clear_depth"]), geometry["depth_format"]), None
    for f in fragments:
        if not f.transparent and passes(f, depth, geometry):
            depth, winner = f.stored_depth, f
    return winner, depth


def transparent(fragments, depth, geometry):
    """Section 15: those that come over the opaque surface."""
    return [f for f in fragments if f.transparent and passes(f, depth, geometry)]


# --- A fragment's values -----------------------------------------------------------------------------------------


def material_of(scene, f):
    return scene["materials"][scene["objects"][f.object]["material"]]


def texel_at(scene, f, kind):
    """Four f32 of a material's map, or None."""
    lookup = material_of(scene, f)["maps"][kind]
    if lookup is None:
        return None
    interpolation = scene["pipeline"]["gbuffer"]["uv"]["interpolation"]
    first = 10 + 2 * lookup["uv_set"]
    uv = [f.attribute(first + k, interpolation) for k in range(2)]
    slopes = [f.slopes(first + k, interpolation) for k in range(2)]
    along_x, along_y = [s[0] for s in slopes], [s[1] for s in slopes]
    return textures.looked_up(scene, lookup, uv, along_x, along_y)


def albedo_of(scene, f):
    interpolation = scene["pipeline"]["gbuffer"]["albedo"]["interpolation"]
    color = np.array([f.attribute(6 + k, interpolation) for k in range(4)], f32)
    texel = texel_at(scene, f, "color")
    if texel is not None:
        color = color * texel
    return color * floats(material_of(scene, f)["base_color"])


def is_back(scene, f):
    front_face = scene["pipeline"]["geometry"]["front_face"]
    front = f.counter_clockwise == (front_face == "ccw")
    return front == scene["objects"][f.object]["mirrored"]


def normal_of(scene, f):
    state = scene["pipeline"]["gbuffer"]
    normal = np.array([f.attribute(3 + k, state["normal"]["interpolation"]) for k in range(3)], f32)
    material = material_of(scene, f)
    if state["unit_normals"] != "vertex":
        normal = unit_rows(normal[None])[0]
    texel = texel_at(scene, f, "normal")
    if texel is not None:
        normal = bent(scene, f, normal, texel, float(material["normal_scale"]))
    return -normal if material["double_sided"] and is_back(scene, f) else normal


def bent(scene, f, normal, texel, scale):
    """Section 13, normal map: f64 of the floats, on the triangle as it was submitted."""
    if scene["meshes"][scene["objects"][f.object]["mesh"]]["tangent"] is not None:
        return bent_at(normal, vertex_tangent(scene, f), texel, scale)
    first = 10 + 2 * material_of(scene, f)["maps"]["normal"]["uv_set"]
    corners = [c[:3] + c[first : first + 2] for c in scene["geometry"].attributes(f.object, f.triangle)]
    least = corners.index(min(corners))
    p, q, s = (corners[(least + k) % 3] for k in range(3))
    e1, e2 = [q[k] - p[k] for k in range(3)], [s[k] - p[k] for k in range(3)]
    a1, a2, b1, b2 = q[3] - p[3], s[3] - p[3], q[4] - p[4], s[4] - p[4]
    area = a1 * b2 - a2 * b1
    if area == 0:
        return normal
    sign = -1 if area < 0 else 1
    u = [sign * (e1[k] * b2 - e2[k] * b1) for k in range(3)]
    v = [sign * (e2[k] * a1 - e1[k] * a2) for k in range(3)]
    return bent_at(normal, (u, lambda c: host.dot(c, v) < 0), texel, scale)


def vertex_tangent(scene, f):
    """U of vertices' tangents, and whether B is turned: by the corners' w and by a matrix that mirrors."""
    o = scene["objects"][f.object]
    first = 10 + 2 * len(scene["meshes"][o["mesh"]]["uv"])
    interpolation = scene["pipeline"]["gbuffer"]["normal"]["interpolation"]
    u = [float(f.attribute(first + k, interpolation)) for k in range(3)]
    w = sum(corner[first + 3] for corner in scene["geometry"].attributes(f.object, f.triangle))
    columns = [[float(row[k]) for row in floats(o["world_from_object"])] for k in range(3)]
    turned = w < 0
    if host.dot(columns[0], host.cross(columns[1], columns[2])) < 0:
        turned = not turned
    return u, lambda c: turned


def bent_at(normal, frame, texel, scale):
    """`frame`: U, and whether a C is against V."""
    u, against = frame
    n = [float(v) for v in normal]
    nn = host.dot(n, n)
    if nn == 0:
        return normal
    along = host.dot(n, u) / nn
    t = [u[k] - n[k] * along for k in range(3)]
    if not host.dot(t, t) > 0:
        return normal
    t = host.unit(t)
    c = host.cross(n, t)
    turn = (-1 if against(c) else 1) * (1 / math.sqrt(nn))
    x, y, z = (2 * float(texel[0]) - 1) * scale, (2 * float(texel[1]) - 1) * scale, 2 * float(texel[2]) - 1
    return np.array([(t[k] * x + (c[k] * turn) * y) + n[k] * z for k in range(3)], np.float64).astype(f32)


def shininess_of(roughness):
    r = max(float(roughness), 0.04)
    r4 = (r * r) * (r * r)
    return f32(min(max(np.rint(2 / r4 - 2), 1.0), 8192.0))


class Surface:
    """What a fragment's planes are stored from: f32."""

    def __init__(self, scene, f):
        pipeline, material = scene["pipeline"], material_of(scene, f)
        model, state = pipeline["light_model"], pipeline["gbuffer"]
        self.position = [f.attribute(k, state["position"]["interpolation"]) for k in range(3)] + [f32(1)]
        self.normal = list(normal_of(scene, f)) + [f32(1)]
        albedo = albedo_of(scene, f)
        specular = floats(material["specular_color"])
        shininess = f32(material["shininess"])
        if model["specular_source"] == "metallic_roughness":
            metallic, roughness = f32(material["metallic"]), f32(material["roughness"])
            texel = texel_at(scene, f, "metallic_roughness")
            if texel is not None:
                roughness, metallic = roughness * texel[1], metallic * texel[2]
            rest = f32(1) - metallic
            specular = f32(0.04) * rest + albedo[:3] * metallic
            shininess = shininess_of(roughness)
            base = albedo[:3]
            albedo = np.append(base * rest, albedo[3])
        else:
            base = albedo[:3]
            texel = texel_at(scene, f, "specular")
            if texel is not None:
                specular = specular * texel[:3]
        emission, share = floats(material["emission"]), f32(1)
        texel = texel_at(scene, f, "emission")
        if texel is not None:
            emission = emission * texel[:3]
        texel = texel_at(scene, f, "occlusion")
        if texel is not None:
            share = f32(1) + f32(material["occlusion_strength"]) * (texel[0] - f32(1))
        in_albedo = material["transparent"] and pipeline["transparency"]["mode"] == "into-albedo"
        if material["unlit"] and shows_unlit(model) and not in_albedo:
            emission, share, specular, albedo = base, f32(1), np.zeros(3, f32), np.append(np.zeros(3, f32), albedo[3])
        self.albedo, self.specular = albedo, np.append(specular, shininess)
        self.emission = np.append(emission, share)


def shows_unlit(model):
    own = model["specular"] != "none" and model["specular_source"] == "model"
    return model["emission"] and model["order"] != "albedo_last" and not own


class Planes:
    """What lights read of pixels that have a surface, [n, channels] each, as read back; or, `forward`, as computed."""

    def __init__(self, scene, surfaces, samples, depths, forward=None):
        state = scene["pipeline"]["gbuffer"]
        if forward is None:
            forward = scene["pipeline"]["strategy"].startswith("forward")
        rounding = state["half_round"]

        def plane(name, format_name):
            values = np.array([getattr(s, name) for s in surfaces], f32).reshape(len(surfaces), 4)
            if forward:
                return values
            if name == "normal" and format_name == "rgb10_a2":
                values = np.append(values[:, :3] * f32(0.5) + f32(0.5), values[:, 3:], axis=1)
                return formats.stored(values, format_name, rounding) * f32(2) - f32(1)
            read = formats.stored(values, format_name, rounding)
            if formats.channels_of(format_name) == 3 and name in ("albedo", "emission"):
                read = np.append(read[:, :3], np.ones((len(read), 1), f32), axis=1)
            return read

        self.position = plane("position", state["position"]["format"])
        self.normal = plane("normal", state["normal"]["format"])
        self.albedo = plane("albedo", state["albedo"]["format"])
        self.specular = plane("specular", state["specular_format"])
        self.emission = plane("emission", state["emission_format"])
        if state["position_from_depth"] and not forward:
            self.position = positions_from_depth(scene, samples, depths)


def positions_from_depth(scene, samples, depths):
    window = tri.Window(scene["viewport"], scene["pipeline"]["geometry"])
    m = floats(scene["camera"]["world_from_clip"])
    x = np.array([(s[0] - 128) / 256 + 0.5 - window.x for s in samples], f32) * f32(2.0 / window.width) - f32(1)
    y = np.array([(s[1] - 128) / 256 + 0.5 - window.y for s in samples], f32) * f32(2.0 / window.height) - f32(1)
    if window.upper_left:
        y = -y
    z = (np.array(depths, f32) - f32(window.z_offset)) * f32(1 / window.z_scale)
    h = [((row[0] * x + row[1] * y) + row[2] * z) + row[3] for row in m]
    return np.stack([c * (f32(1) / h[3]) for c in h[:3]] + [np.ones_like(x)], axis=1)
