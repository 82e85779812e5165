"""docs/arithmetic.md sections 14 and 15: how lights come to pixels, and transparent surfaces."""
import numpy as np

import blending
import formats
import host
import surfaces as sf
import triangles as tri
from fragments import Draw
from lights import LightTerm, Viewed, added
from resolved import floats

f32 = np.float32
ADD_LIGHT = {"enabled": True, "rgb": {"equation": "add", "src": "one", "dst": "one"},
             "alpha": {"equation": "add", "src": "one", "dst": "one"}, "constant": [0, 0, 0, 0],
             "mask": [True, True, True, False]}
MESHES = ("box", "sphere", "cone")
WIDEST_CONE = 1.5


def extent_of(light, volumes):
    """Section 14: what bounds a light."""
    if light["type"] not in ("point", "spot") or np.isinf(float(light["range"])):
        return "unbounded"
    extent = volumes["point"] if light["type"] == "point" else volumes["spot"]
    if extent != "cone":
        return extent
    narrow = light["type"] == "spot" and float(light["cone_rad"]) + float(light["penumbra_rad"]) <= WIDEST_CONE
    return "cone" if narrow else "sphere"


class Lights:
    """The lights of a scene, and where each is drawn."""

    def __init__(self, scene):
        self.scene, pipeline = scene, scene["pipeline"]
        volumes = pipeline["light_volumes"]
        self.extents = [extent_of(light, volumes) for light in scene["lights"]]
        assert self.extents == [light["extent"] for light in scene["lights"]], "extents"
        self.volumes = pipeline["strategy"] == "deferred-volumes"
        self.draw = self.draw_of_meshes(volumes) if self.volumes else None

    def drawn_as_mesh(self, index):
        return self.volumes and self.extents[index] in MESHES

    def analytic(self, index):
        return self.extents[index] != "unbounded" and not self.drawn_as_mesh(index)

    def draw_of_meshes(self, volumes):
        meshes = self.scene["light_meshes"]
        units = {e: host.unit_mesh(e, volumes["slices"], volumes["stacks"]) for e in MESHES}
        for e in MESHES:
            assert units[e] == meshes[e]["unit_vertices"], e
        vertices, rows, self.owner, first = [], [], [], 0
        for index, light in enumerate(self.scene["lights"]):
            if not self.drawn_as_mesh(index):
                continue
            extent = self.extents[index]
            vertices.append(host.light_vertices(light, extent, units[extent]))
            assert np.array_equal(vertices[-1], light["vertices"]), "vertices of a light"
            rows.append(np.array(meshes[extent]["triangles"], np.int64) + first)
            self.owner += [index] * len(rows[-1])
            first += len(vertices[-1])
        if not rows:
            return None
        window = tri.Window(self.scene["viewport"], self.scene["pipeline"]["geometry"], volumes["depth_clamp"])
        clip = tri.transformed(host.rounded(self.scene["camera"]["clip_from_world"]), np.concatenate(vertices).T)
        return Draw(clip, np.concatenate(rows), window, lambda triangle: [[], [], []])

    def times_drawn(self, samples):
        """How often each light is drawn at each sample, [lights, samples]."""
        count = np.array([[0 if self.drawn_as_mesh(i) else 1] * len(samples) for i in range(len(self.extents))])
        cull = self.scene["pipeline"]["light_volumes"]["cull_face"]
        front_face = self.scene["pipeline"]["geometry"]["front_face"]
        for k, sample in enumerate(samples if self.draw else []):
            for f in self.draw.fragments(sample):
                if not tri.is_culled(f.counter_clockwise, cull, front_face, False, False):
                    count[self.owner[f.triangle], k] += 1
        return count


class Picture:
    """What the target holds at samples, [n, 4], as read back."""

    def __init__(self, scene, samples):
        self.scene, self.samples = scene, samples
        pipeline = scene["pipeline"]
        assert pipeline["profile"] == "ideal" and pipeline["view"] == "lit"
        self.target, self.half_round = pipeline["target"], pipeline["gbuffer"]["half_round"]
        self.lights = scene["drawn_lights"]
        clear = np.broadcast_to(floats(scene["clear"]), (len(samples), 4))
        self.color = formats.stored(clear.astype(f32), self.target, self.half_round)

    def recomputed(self):
        geometry = self.scene["pipeline"]["geometry"]
        fragments = [self.scene["geometry"].fragments(s) for s in self.samples]
        seen = [sf.visible(f, geometry) for f in fragments]
        strategy = self.scene["pipeline"]["strategy"]
        hit = np.array([i for i, (winner, _) in enumerate(seen) if winner is not None], int)
        depths = [depth for _, depth in seen]
        glass = [sf.transparent(f, depth, geometry) for f, depth in zip(fragments, depths)]
        mode = self.scene["pipeline"]["transparency"]["mode"]
        if hit.size:
            planes = self.planes([seen[i][0] for i in hit], hit, [depths[i] for i in hit])
            if mode == "into-albedo":
                self.into_albedo(planes, [glass[i] for i in hit])
            viewed = Viewed(self.scene, planes)
            if strategy == "deferred-volumes":
                self.by_volumes(viewed, hit)
            else:
                last = 1 if strategy == "forward-multipass" else len(self.scene["lights"])
                self.by_loop(viewed, hit, last)
        if strategy == "forward-multipass":
            self.by_passes(fragments, depths)
        if mode == "after-lights":
            self.after_lights(glass)
        return self.color

    def planes(self, fragments, places, depths, forward=None):
        chosen = [sf.Surface(self.scene, f) for f in fragments]
        return sf.Planes(self.scene, chosen, [self.samples[i] for i in places], depths, forward)

    def by_loop(self, viewed, places, last):
        color = viewed.sum_starts()
        for index, light in enumerate(self.scene["lights"][:last]):
            term = LightTerm(viewed, light, self.lights.analytic(index))
            color = added(color, term.color, term.lit & term.inside)
        self.color[places] = formats.stored(viewed.result(color), self.target, self.half_round)

    def blend(self, places, viewed, term, drawn, state):
        zero = [np.zeros_like(viewed.alpha)] * 3
        source = viewed.result(added(zero, term.color, term.lit))
        now = self.color[places]
        after = blending.blended(source, now, state, self.target, self.half_round)
        self.color[places] = np.where(drawn[:, None], after, now)

    def by_volumes(self, viewed, places):
        pipeline = self.scene["pipeline"]
        if pipeline["light_volumes"]["base"]:
            self.color[places] = formats.stored(viewed.result(viewed.sum_starts()), self.target, self.half_round)
        times = self.lights.times_drawn([self.samples[i] for i in places])
        for index, light in enumerate(self.scene["lights"]):
            if not times[index].any():
                continue
            term = LightTerm(viewed, light, self.lights.analytic(index))
            for draw in range(times[index].max()):
                self.blend(places, viewed, term, (times[index] > draw) & term.inside, pipeline["blend"])

    def by_passes(self, fragments, depths):
        """The draws after the first, of every fragment whose depth is the stored one."""
        equal = [[f for f in found if not f.transparent and f.stored_depth == depth]
                 for found, depth in zip(fragments, depths)]
        rounds = []
        for k, places in in_turn(equal):
            planes = self.planes([equal[i][k] for i in places], places, [depths[i] for i in places])
            rounds.append((places, Viewed(self.scene, planes)))
        for index, light in enumerate(self.scene["lights"][1:], 1):
            for places, viewed in rounds:
                term = LightTerm(viewed, light, self.lights.analytic(index))
                self.blend(places, viewed, term, term.inside, ADD_LIGHT)

    # --- Section 15 ----------------------------------------------------------------------------------------------

    def into_albedo(self, planes, glass):
        pipeline = self.scene["pipeline"]
        target = pipeline["gbuffer"]["albedo"]["format"]
        for k, places in in_turn(glass):
            source = np.array([sf.Surface(self.scene, glass[i][k]).albedo for i in places], f32)
            state = pipeline["transparency"]["blend"]
            planes.albedo[places] = blending.blended(source, planes.albedo[places], state, target, self.half_round)
            if formats.channels_of(target) == 3:
                planes.albedo[places, 3] = 1

    def after_lights(self, glass):
        for k, places in in_turn(glass):
            viewed = Viewed(self.scene, self.planes([glass[i][k] for i in places], places, None, True))
            viewed.alpha = viewed.albedo[3]
            color = viewed.sum_starts()
            for index, light in enumerate(self.scene["lights"]):
                term = LightTerm(viewed, light, self.lights.extents[index] != "unbounded")
                color = added(color, term.color, term.lit & term.inside)
            state = self.scene["pipeline"]["transparency"]["blend"]
            self.color[places] = blending.blended(viewed.result(color), self.color[places], state, self.target,
                                                  self.half_round)


def in_turn(lists):
    """For each k, which lists have an element k."""
    for k in range(max((len(e) for e in lists), default=0)):
        yield k, np.array([i for i, e in enumerate(lists) if len(e) > k], int)
