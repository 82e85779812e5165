"""docs/arithmetic.md section 8: what lights add to pixels. Arrays of f32 over the pixels; NumPy rounds each + - * /
and sqrt once."""
import numpy as np

import host
import powers
from resolved import floats

f32 = np.float32


def dot3(a, b):
    return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2]


def one_over_length(length2):
    return np.where(length2 > 0, f32(1) / np.sqrt(length2), f32(0))


def unit(v):
    r = one_over_length(dot3(v, v))
    return [c * r for c in v]


def to_unit_range(x):
    """Clamped to [0, 1]; what is no number counts as 0."""
    return np.where(x > 0, np.where(x > 1, f32(1), x), f32(0)).astype(f32)


class Viewed:
    """A pixel's part of the terms: vectors of [n] arrays."""

    def __init__(self, scene, planes):
        self.scene, self.model = scene, scene["pipeline"]["light_model"]
        self.p = list(planes.position.T[:3])
        self.n = list(planes.normal.T[:3])
        self.albedo, self.specular = list(planes.albedo.T), list(planes.specular.T)
        self.emission = list(planes.emission.T)
        if self.model["renormalize"]:
            self.n = unit(self.n)
        if self.model["viewer"] == "infinite":
            axis = view_axis(scene["camera"]["clip_from_world"])
            assert np.array_equal(axis, floats(scene["camera"]["view_axis"])), "view_axis"
            self.v = [np.full(len(planes.position), c, f32) for c in axis]
        else:
            eye = floats(scene["camera"]["eye"])
            self.v = unit([eye[k] - self.p[k] for k in range(3)])
        from_albedo = self.model["alpha_from_albedo"]
        self.alpha = self.albedo[3] if from_albedo else np.ones(len(planes.position), f32)

    def sum_starts(self):
        """RGB that the sum starts from."""
        model = self.model
        ambient = floats(model["global_ambient"])
        out = []
        for k in range(3):
            share = None
            if ambient.any():
                share = self.albedo[k] * ambient[k]
                if model["order"] == "albedo_last":
                    share = np.full_like(self.albedo[k], ambient[k])
                if model["emission"]:
                    share = share * self.emission[3]
            start = self.emission[k] if model["emission"] else np.zeros_like(self.albedo[k])
            if share is not None:
                start = start + share if model["emission"] else share
            out.append(start)
        return out

    def result(self, color):
        """RGBA [n, 4] of a sum, before a target's format."""
        if self.model["order"] == "albedo_last":
            color = [c * a for c, a in zip(color, self.albedo)]
        out = np.stack(list(color) + [self.alpha], axis=1)
        return to_unit_range(out) if self.model["clamp_result"] else out


def view_axis(clip_from_world):
    """RN32(-unit(w)), f64."""
    axis = clip_from_world[3][:3]
    if axis == [0, 0, 0]:
        axis = clip_from_world[2][:3]
    return np.array([-c for c in host.unit([float(c) for c in axis])], np.float64).astype(f32)


class Cone:
    """The numbers of a spot's cone, f64 rounded once each; `kind` None: there is none."""

    def __init__(self, light, model):
        self.kind = model["cone"] if light["type"] == "spot" and model["cone"] != "none" else None
        if self.kind is None:
            return
        widest = float(light["cone_rad"]) + float(light["penumbra_rad"])
        outer, inner = host.cosine(widest), host.cosine(float(light["cone_rad"]))
        self.numbers = {}
        if self.kind == "exponent":
            if f32(widest) >= f32(host.PI):
                self.kind = None
            self.numbers["e0"] = f32(outer)
            self.power = float(light["spot_exponent"])
        elif self.kind == "squared_penumbra":
            scale = 1 / max(0.001, inner - outer)
            self.numbers = {"offset": f32(-outer * scale), "scale": f32(scale)}
        else:
            e0, e1 = f32(outer), f32(outer * 0.9 + 0.1 if self.kind == "smooth_cutoff" else inner)
            with np.errstate(all="ignore"):
                self.numbers = {"e0": e0, "one_over_e1_minus_e0": f32(np.float64(1) / (np.float64(e1) - np.float64(e0)))}

    def share(self, c):
        n = self.numbers
        if self.kind == "exponent":
            return np.where(c >= n["e0"], powers.power(np.where(c > 0, c, f32(0)), self.power), f32(0))
        if self.kind == "squared_penumbra":
            t = to_unit_range(c * n["scale"] + n["offset"])
            return t * t
        t = to_unit_range((c - n["e0"]) * n["one_over_e1_minus_e0"])
        return (t * t) * (f32(3) - f32(2) * t)


def falloff(model, light, d, d2, r):
    kind, reach = model["falloff"], f32(light["range"])
    k0, k1, k2 = floats(light["attenuation"])
    if kind == "linear_range":
        f = f32(1) - d / reach
        return np.where(f > 0, f, f32(0))
    if kind == "linear":
        return f32(1) - d / reach
    if kind == "none":
        return np.ones_like(d)
    if kind == "quadratic":
        return f32(1) / ((f32(1) + k1 * d) + (k2 * d) * d)
    if kind == "attenuation":
        f = f32(1) / ((k0 + k1 * d) + (k2 * d) * d)
        return np.where(f > f32(1e18), f32(1e18), f)
    u = d2 / (reach * reach)
    w, q = f32(1) - u * u, r * r
    q = np.where(q > f32(1e18), f32(1e18), q)
    return np.where((w > 0) & (d < reach), w * q, f32(0))


def specular(viewed, l, nl, a, steps):
    """s, and the colour ks. `steps` gets the numbers on the way."""
    model, n, v = viewed.model, viewed.n, viewed.v
    own = model["specular_source"] in ("material", "metallic_roughness")
    shininess = viewed.specular[3] if own else np.full_like(nl, f32(model["shininess"]))
    if model["specular"] == "blinn_phong":
        h = [l[k] + v[k] for k in range(3)]
        h2, nh = dot3(h, h), dot3(n, h)
        t = np.where(nh > 0, nh, f32(0))
        steps.update(h2=h2, nh=nh)
    else:
        m = f32(2) * to_unit_range(nl)
        reflected = [m * n[k] - l[k] for k in range(3)]
        base = to_unit_range(dot3(reflected, v))
        steps.update(m=m, R=reflected)
    s = np.zeros_like(nl)
    for p in np.unique(shininess):
        exponent = float(p)
        if model["specular"] == "blinn_phong":
            if exponent % 2 == 0 and exponent <= 8192:
                x, exponent = np.where(h2 > 0, (t * t) / h2, f32(0)), exponent / 2
            else:
                x = np.where(h2 > 0, t / np.sqrt(h2), f32(0))
            if model["renormalize"]:
                x = np.where(x > 1, f32(1), x)
        else:
            x = base
        s = np.where(shininess == p, powers.power(x.astype(f32), exponent), s)
        steps.update(x=x, s=s, p=exponent)
    if model["specular_masked"]:
        s = np.where(a > 0, s, f32(0))
    if own:
        return s, viewed.specular[:3]
    if model["specular_source"] == "albedo":
        return s, viewed.albedo[:3]
    return s, [np.full_like(nl, c) for c in floats(model["specular_color"])]


class LightTerm:
    """What one light adds to each pixel: `color`, three arrays, where `lit`. `inside`: where its extent lets it be.
    `steps`: numbers on the way, by the page's names."""

    def __init__(self, viewed, light, analytic_extent):
        model = viewed.model
        color = [c * f32(model["damping"]) for c in floats(light["color"])]
        self.hold(light, color, model)
        count = len(viewed.alpha)
        self.inside, self.steps = np.ones(count, bool), {}
        if light["type"] == "ambient":
            self.lit = np.ones(count, bool)
            share = [viewed.albedo[k] * color[k] for k in range(3)]
            if model["order"] == "albedo_last":
                share = [np.full(count, color[k], f32) for k in range(3)]
            self.color = [c * viewed.emission[3] for c in share] if model["emission"] else share
            return
        with np.errstate(all="ignore"):
            self.of_placed(viewed, light, color, analytic_extent)

    def hold(self, light, color, model):
        """The document's numbers of the light are those computed here."""
        assert np.array_equal(np.array(color, f32), floats(light["in_model"]["color"])), "colour in the model"
        cone, said = Cone(light, model), light["in_model"]["cone"]
        assert (cone.kind is None) == (said is None), "cone"
        for key, value in (said or {}).items():
            assert f32(float(value)) == cone.numbers[key], key
        self.cone = cone

    def of_placed(self, viewed, light, color, analytic_extent):
        model, n = viewed.model, viewed.n
        axis = [-c for c in floats(light["direction"])]
        if light["type"] == "directional":
            l = [np.full_like(viewed.alpha, c) for c in axis]
            a = nl = dot3(n, l)
            f, self.lit = np.ones_like(a), np.ones(a.shape, bool)
        else:
            place = floats(light["position"])
            d_vector = [place[k] - viewed.p[k] for k in range(3)]
            d2 = dot3(d_vector, d_vector)
            d = np.sqrt(d2)
            r = np.where(d2 > 0, f32(1) / d, f32(0))
            a = dot3(n, d_vector)
            nl, l = a * r, [c * r for c in d_vector]
            f, self.lit = falloff(model, light, d, d2, r), np.isfinite(d2)
            self.steps.update(D=d_vector, d2=d2, d=d, r=r, f=f)
            if analytic_extent:
                self.inside = d < f32(light["range"])
            if self.cone.kind is not None:
                g = self.cone.share(dot3(l, axis))
                self.lit &= g > 0
                f = f * g
        self.steps.update(a=a, nl=nl, L=l)
        s = ks = None
        if model["specular"] != "none":
            s, ks = specular(viewed, l, nl, a, self.steps)
        always = model["order"] == "with_ambient" or model["diffuse"] == "unclamped"
        if not always and (s is None or model["specular_masked"]):
            self.lit &= a > 0
        self.color = self.reflected(viewed, light, color, f, nl, s, ks)

    def reflected(self, viewed, light, color, f, nl, s, ks):
        model = viewed.model
        c = np.where(nl > 0, nl, f32(0))
        if model["specular"] == "phong":
            c = np.where(c > 1, f32(1), c)
        if model["diffuse"] == "unclamped":
            c = nl
        ambient = floats(light["ambient"])
        out = []
        for k in range(3):
            albedo = viewed.albedo[k]
            if model["order"] == "separate":
                term = ((c * albedo) * color[k]) * f
                out.append(term if s is None else term + ((color[k] * s) * ks[k]) * f)
                continue
            if model["order"] == "albedo_last":
                out.append((c * f) * color[k] if s is None else ((c + s) * f) * color[k])
                continue
            if s is None:
                whole = albedo * c
            elif model["specular_source"] == "albedo":
                whole = albedo * (c + s)
            else:
                whole = albedo * c + ks[k] * s
            if model["order"] == "with_ambient":
                out.append((albedo * ambient[k] + whole * color[k]) * f)
            else:
                out.append(whole * (color[k] * f))
        return out


def added(color, term, where):
    """The sum with a light's term, where the light adds one."""
    return [np.where(where, c + t, c).astype(f32) for c, t in zip(color, term)]
