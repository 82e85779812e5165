// Faults of the G-buffer: how a plane is encoded, and how surfaces are drawn. Where a plane alone is written wrongly
// the picture stays the right one; where surfaces are drawn wrongly it is lit from them.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "tests/judge/diagnosis/plants.h"
#include "tests/judge/diagnosis/view_rows.h"
#include "tests/judge/srgb_in_double.h"

namespace trueshade::testing {

namespace {

using oracle::Capture;
using V = glm::vec3;

float get(const Image& i, int x, int y, int k) {
  float v;
  std::memcpy(&v, i.texel(x, y) + 4 * k, 4);
  return v;
}
void set(Image& i, int x, int y, int k, float v) { std::memcpy(i.texel(x, y) + 4 * k, &v, 4); }

/// Where a surface is drawn.
template <class Change>
void each_surface(Capture& c, const Change& change) {
  const Image ids = *c.plane("id.object");
  for (int y = 0; y < ids.height; ++y)
    for (int x = 0; x < ids.width; ++x)
      if (const uint32_t id = ids.code(x, y, 0); id != 0) change(x, y, id - 1);
}

/// Three floats of a plane, by a formula.
template <class Formula>
Output rewritten(std::string_view name, Formula formula) {
  return [name, formula](const Scene& s, const Pipeline&, Capture& c, int variant) {
    Image* plane = plane_of(c, name);
    each_surface(c, [&](int x, int y, uint32_t object) {
      V v{get(*plane, x, y, 0), get(*plane, x, y, 1), get(*plane, x, y, 2)};
      v = formula(s, v, object, variant);
      for (int k = 0; k < 3; ++k) set(*plane, x, y, k, v[k]);
    });
  };
}

template <class Formula>
Output depths(Formula formula, bool background = true) {
  return [formula, background](const Scene& s, const Pipeline&, Capture& c, int variant) {
    Image *depth = plane_of(c, "depth"), *position = plane_of(c, "position");
    const Image& ids = *c.plane("id.object");
    for (int y = 0; y < depth->height; ++y)
      for (int x = 0; x < depth->width; ++x) {
        const bool drawn = ids.code(x, y, 0) != 0;
        if (!drawn && !background) continue;
        const V p{get(*position, x, y, 0), get(*position, x, y, 1), get(*position, x, y, 2)};
        set(*depth, x, y, 0, formula(s, get(*depth, x, y, 0), p, variant));
      }
  };
}

template <class Where>
Output moved(std::vector<std::string_view> names, bool picture, Where where) {
  return [names, picture, where](const Scene&, const Pipeline&, Capture& c, int variant) {
    std::vector<Image*> images;
    for (NamedImage& p : c.planes)
      if (names.empty() || std::find(names.begin(), names.end(), p.name) != names.end()) images.push_back(&p.image);
    if (picture) images.push_back(&c.color);
    for (Image* image : images) {
      const Image from = *image;
      for (int y = 0; y < from.height; ++y)
        for (int x = 0; x < from.width; ++x) {
          const auto [sx, sy] = where(x, y, from.width, from.height, variant);
          std::memcpy(image->texel(x, y),
                      from.texel(std::clamp(sx, 0, from.width - 1), std::clamp(sy, 0, from.height - 1)),
                      size_t(info(from.format).bytes_per_texel()));
        }
    }
  };
}

/// Albedo codes by a formula of numbers in [0, 1].
template <class Formula>
Output albedos(Formula formula) {
  return [formula](const Scene&, const Pipeline&, Capture& c, int) {
    Image* plane = plane_of(c, "albedo");
    each_surface(c, [&](int x, int y, uint32_t) {
      std::array<double, 4> v;
      for (int k = 0; k < 4; ++k) v[size_t(k)] = plane->value(x, y, k);
      formula(v);
      for (int k = 0; k < 4; ++k)
        if (plane->format == Format::rgba8)
          plane->set_code(x, y, k, uint32_t(std::lround(std::clamp(v[size_t(k)], 0.0, 1.0) * 255)));
        else
          set(*plane, x, y, k, float(v[size_t(k)]));
    });
  };
}

double from_srgb(double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); }

V to_view(const Scene& s, const V& v) {
  const std::array<V, 3> rows = view_rows(s.camera);
  return {dot_of(rows[0], v), dot_of(rows[1], v), dot_of(rows[2], v)};
}
V octahedron(V n) {
  n *= 1 / (std::fabs(n.x) + std::fabs(n.y) + std::fabs(n.z));
  if (n.z >= 0) return {n.x, n.y, 0};
  return {(1 - std::fabs(n.y)) * (n.x >= 0 ? 1.0f : -1.0f), (1 - std::fabs(n.x)) * (n.y >= 0 ? 1.0f : -1.0f), 0};
}
float view_depth(const Scene& s, const V& p) { return -to_view(s, p - s.camera.eye).z; }

using Where = std::pair<int, int>;

/// Checkers with texture coordinates made of positions, for scenes without maps.
void textured(Scene& s, Pipeline&) {
  Texture checkers;
  checkers.format = TextureFormat::rgba8;
  checkers.levels.push_back({32, 32, {}});
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) {
      const bool light = ((x / 4) ^ (y / 4)) & 1;
      const float a = light ? 0.9f : 0.2f + 0.02f * float(x % 4), b = light ? 0.8f - 0.03f * float(y % 4) : 0.3f;
      append_texel(checkers.format, {a, b, 0.5f, 1.0f}, checkers.levels[0].bytes);
    }
  s.textures = {checkers};
  build_mip_chain(s.textures[0]);
  for (Mesh& mesh : s.meshes)
    for (size_t v = 0; v < mesh.vertex_count(); ++v) {
      mesh.uv[0].resize(mesh.vertex_count()), mesh.uv[1].resize(mesh.vertex_count());
      mesh.uv[0][v] = mesh.position[0][v] + 0.37f * mesh.position[1][v];
      mesh.uv[1][v] = mesh.position[2][v] - 0.21f * mesh.position[1][v];
    }
  for (Material& m : s.materials) m.color_map.texture = 0;
}
/// Every object once more, in another colour.
void drawn_twice(Scene& s, Pipeline&) {
  Material other = s.materials[0];
  other.base_color = glm::vec4(0.3f, 0.6f, 0.9f, 1.0f);
  s.materials.push_back(other);
  const size_t count = s.instances.size();
  for (size_t i = 0; i < count; ++i) {
    Instance copy = s.instances[i];
    copy.material = uint32_t(s.materials.size() - 1);
    s.instances.push_back(copy);
  }
}
void stretched(Scene& s, Pipeline&) {
  for (Instance& i : s.instances) i.world_from_object[1] *= 1.5f;
}
/// Normals of boxes as of round things: they differ from corner to corner, and not by a symmetry of the box alone.
void rounded_and_stretched(Scene& s, Pipeline& p) {
  for (Mesh& mesh : s.meshes)
    for (size_t i = 0; i < mesh.vertex_count(); ++i) {
      V n{mesh.position[0][i] + 0.3f, mesh.position[1][i] + 0.2f, mesh.position[2][i] + 0.1f};
      n += V{mesh.normal[0][i], mesh.normal[1][i], mesh.normal[2][i]};
      n *= 1 / std::max(1e-6f, std::sqrt(dot_of(n, n)));
      for (size_t k = 0; k < 3; ++k) mesh.normal[k][i] = n[int(k)];
    }
  stretched(s, p);
}

std::vector<Plant> made_planes() {
  std::vector<Plant> all;
  const auto out = [&](std::string_view plane, std::string_view name, Names names, Output output, int variants = 1) {
    all.push_back(
        {name, std::move(names), plane, {"many-lights", "touchdesigner"}, variants, nullptr, std::move(output)});
  };
  const auto in = [&](std::string_view name, Names names, Input input, int variants = 1) {
    all.push_back({name, std::move(names), "G-buffer", {"many-lights", "touchdesigner"}, variants, std::move(input)});
  };
  out("normal", "normals as [0, 1], not decoded", {"normal-halved"},
      rewritten("normal", [](const Scene&, const V& n, uint32_t, int) { return n * 0.5f + 0.5f; }));
  out("normal", "normals octahedral, not decoded", {"normal-octahedral", "normal-octahedral-halved"},
      rewritten("normal",
                [](const Scene&, const V& n, uint32_t, int v) {
                  const V o = octahedron(n);
                  return v == 0 ? o : V{o.x * 0.5f + 0.5f, o.y * 0.5f + 0.5f, 0.0f};
                }),
      2);
  out("normal", "normals in view space in the G-buffer", {"normal-view"},
      rewritten("normal", [](const Scene& s, const V& n, uint32_t, int) { return to_view(s, n); }));
  out("normal", "normals turned in the G-buffer", {"normal-turned"},
      rewritten("normal", [](const Scene&, const V& n, uint32_t, int) { return -n; }));
  out("normal", "normals unnormalised in the G-buffer", {"normal-unnormalised"},
      rewritten("normal", [](const Scene& s, const V& n, uint32_t object, int) {
        const glm::mat4x3& m = s.instances[object].world_from_object;  // n / |transpose(M) n|
        const V o{dot_of(m[0], n), dot_of(m[1], n), dot_of(m[2], n)};
        return n * (1 / std::sqrt(dot_of(o, o)));
      }));
  all.back().base = stretched;
  out("normal", "normals of 8 bits in the G-buffer", {"normal-bits"},
      rewritten("normal", [](const Scene&, const V& n, uint32_t, int) {
        V r;
        for (int k = 0; k < 3; ++k) r[k] = std::round((n[k] * 0.5f + 0.5f) * 255) / 255 * 2 - 1;
        return r;
      }));
  out("normal", "normals one pixel to the side", {"normal-shift-x"},
      moved({"normal"}, false,
            [](int x, int y, int, int, int v) {
              return Where{x + (v == 0 ? 1 : -1), y};
            }),
      2);
  out("position", "positions in view space", {"position-view"},
      rewritten("position", [](const Scene& s, const V& p, uint32_t, int) { return to_view(s, p - s.camera.eye); }));
  out("position", "positions upside down", {"position-flip-y"},
      moved({"position"}, false, [](int x, int y, int, int h, int) {
        return Where{x, h - 1 - y};
      }));
  out("depth", "depth reversed", {"depth-reversed"},
      depths([](const Scene&, float z, const V&, int) { return 1 - z; }));
  out("depth", "depth linear", {"depth-linear", "depth-over-far", "depth-view"},
      depths(
          [](const Scene& s, float, const V& p, int v) {
            const float d = view_depth(s, p), n = s.camera.near, f = s.camera.far;
            return v == 0 ? (d - n) / (f - n) : v == 1 ? d / f : d;
          },
          false),
      3);
  out("depth", "distances over a background of 0", {"depth-view", "depth-cleared-to-zero"},
      depths([](const Scene& s, float z, const V& p, int) { return z < 1 ? view_depth(s, p) : 0.0f; }));
  out("depth", "depth in [-1, 1]", {"depth-ndc"},
      depths([](const Scene&, float z, const V&, int) { return 2 * z - 1; }));
  out("depth", "depth halved into [0, 1] again", {"depth-halved"},
      depths([](const Scene&, float z, const V&, int) { return z / 2 + 0.5f; }));
  out("depth", "depth of 8 or 16 bits", {"depth-bits", "depth-format"},
      depths([](const Scene&, float z, const V&, int v) {
        const double largest = v == 0 ? 255 : 65535;
        return float(std::nearbyint(double(z) * largest) / largest);
      }),
      2);
  out("depth", "depth with a bias", {"depth-bias"},
      depths([](const Scene&, float z, const V&, int v) { return z + (v == 0 ? 0.001f : -0.01f); }, false), 2);
  out("albedo", "albedo sRGB-encoded", {"albedo-srgb-encoded"}, albedos([](std::array<double, 4>& c) {
        for (size_t k = 0; k < 3; ++k) c[k] = srgb_encoded(c[k]);
      }));
  out("albedo", "albedo decoded once too often", {"albedo-srgb-decoded"}, albedos([](std::array<double, 4>& c) {
        for (size_t k = 0; k < 3; ++k) c[k] = from_srgb(c[k]);
      }));
  out("albedo", "albedo as BGR", {"albedo-bgr"}, albedos([](std::array<double, 4>& c) { std::swap(c[0], c[2]); }));
  out("G-buffer", "the G-buffer upside down, not the picture", {"gbuffer-flip-y"},
      moved({}, false, [](int x, int y, int, int h, int) {
        return Where{x, h - 1 - y};
      }));
  out("G-buffer", "the whole capture upside down", {"gbuffer-flip-y", "upside-down"},
      moved({}, true, [](int x, int y, int, int h, int) {
        return Where{x, h - 1 - y};
      }));
  out("G-buffer", "the whole capture one pixel off", {"gbuffer-shift-x", "gbuffer-shift-y"},
      moved({}, true,
            [](int x, int y, int, int, int v) {
              return Where{x + (v == 0 ? 1 : v == 1 ? -1 : 0), y + (v == 2 ? 1 : v == 3 ? -1 : 0)};
            }),
      4);
  in("front faces culled", {"cull-face", "front-face"}, [](Scene&, Pipeline& p, int) {
    p.geometry.cull_face = CullFace::front;
    return true;
  });
  in("faces wound the other way", {"front-face", "cull-face"}, [](Scene&, Pipeline& p, int) {
    p.geometry.front_face = FrontFace::cw;
    return true;
  });
  all.back().base = culled_back;
  in("LEQUAL for LESS", {"depth-func"}, [](Scene&, Pipeline& p, int) {
    p.geometry.depth_func = DepthFunc::lequal;
    return true;
  });
  all.back().base = drawn_twice;
  in("no depth test", {"depth-func"}, [](Scene&, Pipeline& p, int) {
    p.geometry.depth_func = DepthFunc::always;
    return true;
  });
  in("a reversed depth test", {"depth-func"}, [](Scene&, Pipeline& p, int) {
    p.geometry.depth_func = DepthFunc::greater, p.geometry.clear_depth = 0;
    return true;
  });
  in("a depth buffer of 16 bits", {"depth-format", "depth-bits"}, [](Scene&, Pipeline& p, int) {
    p.geometry.depth_format = Format::d16;
    return true;
  });
  in(
      "polygon offset", {"polygon-offset"},
      [](Scene&, Pipeline& p, int v) {
        p.geometry.polygon_offset_factor = p.geometry.polygon_offset_units = v == 0 ? 1.0f : -1.0f;
        return true;
      },
      2);
  in(
      "half a pixel off", {"half-pixel"},
      [](Scene& s, Pipeline& p, int v) {
        const Matrix4 m = clip_from_world(s.camera, double(p.width) / p.height);
        s.camera.clip_from_world.emplace();
        for (size_t i = 0; i < 16; ++i) (*s.camera.clip_from_world)[i] = float(m[i]);
        const float dx = v == 0 ? 1.0f : v == 1 ? -1.0f : 0.0f, dy = v == 2 ? 1.0f : v == 3 ? -1.0f : 0.0f;
        for (size_t c = 0; c < 4; ++c) {
          (*s.camera.clip_from_world)[4 * c] += (*s.camera.clip_from_world)[4 * c + 3] * dx / float(p.width);
          (*s.camera.clip_from_world)[4 * c + 1] += (*s.camera.clip_from_world)[4 * c + 3] * dy / float(p.height);
        }
        return true;
      },
      4);
  in("a left-handed camera", {"left-handed", "gbuffer-flip-x"}, [](Scene& s, Pipeline& p, int) {
    const Matrix4 m = clip_from_world(s.camera, double(p.width) / p.height);
    s.camera.clip_from_world.emplace();
    for (size_t i = 0; i < 16; ++i) (*s.camera.clip_from_world)[i] = float(i % 4 == 0 ? -m[i] : m[i]);
    return true;
  });
  in("the other range of clip depth", {"clip-depth", "depth-ndc"}, [](Scene& s, Pipeline& p, int) {
    const Matrix4 m = clip_from_world(s.camera, double(p.width) / p.height);
    s.camera.clip_from_world.emplace();
    for (size_t i = 0; i < 16; ++i) (*s.camera.clip_from_world)[i] = float(m[i]);
    p.geometry.clip_depth = ClipDepth::zero_to_one;
    return true;
  });
  all.back().plane = "depth";  // where nothing is nearer than the middle of the range, it is the depths alone
  in(
      "another texture filter", {"texture-filter", "texture-lod-bias"},
      [](Scene& s, Pipeline&, int v) {
        for (Material& m : s.materials) {
          Sampler& sampler = m.color_map.sampler;
          if (v == 0 || v == 4 || v == 5) sampler.mag_filter = Filter::nearest;
          if (v == 0 || v == 3 || v == 5) sampler.min_filter = Filter::nearest;
          if (v == 0 || v == 1) sampler.mip_filter = MipFilter::none;
          if (v == 2 || v == 5) sampler.mip_filter = MipFilter::nearest;
        }
        return true;
      },
      6);
  all.back().base = textured;
  in(
      "another texture wrap", {"texture-wrap"},
      [](Scene& s, Pipeline&, int v) {
        const Wrap wrap = v == 0 ? Wrap::mirrored_repeat : Wrap::clamp_to_edge;
        for (Material& m : s.materials) m.color_map.sampler.wrap = {wrap, wrap};
        return true;
      },
      2);
  all.back().base = textured;
  in("textures upside down", {"texture-flip-v"}, [](Scene& s, Pipeline&, int) {
    for (Texture& t : s.textures)
      for (TextureLevel& level : t.levels) {
        const size_t row = size_t(level.width) * 4;
        std::vector<uint8_t> turned;
        for (int y = level.height - 1; y >= 0; --y)
          turned.insert(turned.end(), level.bytes.begin() + ptrdiff_t(size_t(y) * row),
                        level.bytes.begin() + ptrdiff_t(size_t(y + 1) * row));
        level.bytes = turned;
      }
    return true;
  });
  all.back().base = textured;
  in("textures decoded as sRGB", {"texture-srgb"}, [](Scene& s, Pipeline&, int) {
    for (Texture& t : s.textures) t.format = TextureFormat::srgb8_a8;
    return true;
  });
  all.back().base = textured;
  in("attributes noperspective", {"interpolation"}, [](Scene&, Pipeline& p, int) {
    for (PlaneState* plane : {&p.gbuffer.position, &p.gbuffer.normal, &p.gbuffer.albedo, &p.gbuffer.uv})
      plane->interpolation = Interpolation::noperspective;
    return true;
  });
  in("flat normals", {"normal-flat"}, [](Scene&, Pipeline& p, int) {
    p.gbuffer.normal.interpolation = Interpolation::flat;
    return true;
  });
  in("normals made unit by the fragment shader alone", {"normal-unit-shader"}, [](Scene&, Pipeline& p, int) {
    p.gbuffer.unit_normals = UnitNormals::fragment;
    return true;
  });
  all.back().base = rounded_and_stretched;
  in(
      "an object missing", {"object-missing"},
      [](Scene& s, Pipeline&, int v) {
        const auto empty = uint32_t(s.meshes.size());
        s.meshes.emplace_back();
        s.instances[(size_t(v) * 3) % s.instances.size()].mesh = empty;
        return true;
      },
      3);
  return all;
}

}  // namespace

const std::vector<Plant>& plants_of_planes() {
  static const std::vector<Plant> all = made_planes();
  return all;
}

}  // namespace trueshade::testing
