// Faults of one light, of all lights' places, and of planes that lights are computed from.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/half.h"
#include "tests/judge/diagnosis/plants.h"
#include "tests/judge/diagnosis/view_rows.h"
#include "tests/judge/diagnosis/wrong_lights.h"

namespace trueshade::testing {

namespace {

using oracle::Capture;
using V = glm::vec3;

template <class Change>
Input one_light(Change change) {
  return [change](Scene& s, Pipeline&, int variant) {
    if (s.lights.empty()) return false;
    change(s.lights[(size_t(variant) * 7 + 3) % s.lights.size()], variant);
    return true;
  };
}

/// Point lights as spots that shine downward.
void spots(Scene& s, Pipeline&) {
  for (Light& l : s.lights) {
    if (l.type != LightType::point) continue;
    l.type = LightType::spot, l.direction = V(0.6f, -0.8f, 0.0f), l.cone_rad = 0.6f, l.penumbra_rad = 0.25f;
    l.color *= 2.0f;
  }
}
/// Normals of boxes as of round things: interpolated, they are shorter than unit length.
void rounded(Scene& s, Pipeline&) {
  for (Mesh& mesh : s.meshes)
    for (size_t i = 0; i < mesh.vertex_count(); ++i) {
      V n(mesh.position[0][i] + mesh.normal[0][i], mesh.position[1][i] + mesh.normal[1][i],
          mesh.position[2][i] + mesh.normal[2][i]);
      n *= 1 / std::max(1e-6f, std::sqrt(dot_of(n, n)));
      for (size_t k = 0; k < 3; ++k) mesh.normal[k][i] = n[int(k)];
    }
}
void rebuilt_positions(Scene&, Pipeline& p) { p.gbuffer.position_from_depth = true; }

/// Three floats of a plane, of each surface.
template <class Formula>
void each_vector(Capture& c, std::string_view name, Formula formula) {
  const Image ids = *c.plane("id.object");
  Image& plane = *plane_of(c, name);
  for (int y = 0; y < ids.height; ++y)
    for (int x = 0; x < ids.width; ++x) {
      if (ids.code(x, y, 0) == 0) continue;
      float v[3];
      std::memcpy(v, plane.texel(x, y), sizeof v);
      const V changed = formula(V(v[0], v[1], v[2]));
      for (int k = 0; k < 3; ++k) v[k] = changed[k];
      std::memcpy(plane.texel(x, y), v, sizeof v);
    }
}

/// What a point becomes whose depth is read by another near plane.
V by_near(const Camera& c, const V& p, float factor) {
  const V offset = p - c.eye;
  const float d = -dot_of(view_rows(c)[2], offset), n = c.near, f = c.far;
  const float z = f * (d - n) / (d * (f - n)), m = n * factor;  // in [0, 1]
  return c.eye + offset * (f * m / (f - z * (f - m)) / d);
}

Output vectors(std::string_view name, V (*formula)(const Scene&, const V&, int)) {
  return [name, formula](const Scene& s, const Pipeline&, Capture& c, int variant) {
    each_vector(c, name, [&](const V& v) { return formula(s, v, variant); });
  };
}

int8_t byte_of(float n) { return int8_t(std::lround(std::clamp(n, -1.0f, 1.0f) * 127)); }

void add_lights(std::vector<Plant>& all) {
  const auto in = [&](std::string_view name, Names names, Names presets, Input input, int variants = 1) -> Plant& {
    all.push_back({name, std::move(names), "picture", std::move(presets), variants, std::move(input)});
    return all.back();
  };
  in("one light's range", {"light-reach"}, {"many-lights", "punctual", "light-volumes"}, one_light([](Light& l, int v) {
       l.range *= pick({0.7f, 1.3f, 0.9f, 1.8f}, v);
     }),
     4);
  in("one light's cone", {"light-cone"}, {"punctual", "lecture", "redsdk"}, one_light([](Light& l, int v) {
       l.cone_rad *= pick({0.8f, 1.2f, 1.0f, 0.5f}, v), l.penumbra_rad *= pick({1.0f, 1.0f, 2.0f}, v);
     }),
     4)
      .base = spots;
  in("one light's attenuation", {"light-falloff", "light-attenuation"}, {"touchdesigner", "gl-fixed"},
     one_light([](Light& l, int v) {
       l.attenuation.y *= pick({0.5f, 2.0f, 1.0f}, v), l.attenuation.z *= pick({0.5f, 1.0f, 1.5f}, v);
     }),
     3);
  in(
      "all cones", {"light-cones"}, {"punctual", "redsdk"},
      [](Scene& s, Pipeline&, int v) {
        for (Light& l : s.lights) l.cone_rad *= pick({0.9f, 2.0f}, v), l.penumbra_rad *= pick({0.9f, 2.0f}, v);
        return true;
      },
      2)
      .base = spots;
  in("lights turned round", {"light-directions-turned"}, {"punctual"}, [](Scene& s, Pipeline&, int) {
    for (Light& l : s.lights) l.direction = -l.direction;
    return true;
  }).base = spots;
  in("light positions as halves", {"light-positions-half"}, {"many-lights", "touchdesigner"},
     [](Scene& s, Pipeline&, int) {
       for (Light& l : s.lights)
         for (int k = 0; k < 3; ++k)
           l.position[k] = float_from_half(half_from_float(l.position[k], HalfRound::nearest));
       return true;
     });
  in("light positions in view space", {"light-positions-view"}, {"many-lights", "touchdesigner"},
     [](Scene& s, Pipeline&, int) {
       const std::array<V, 3> rows = view_rows(s.camera);
       for (Light& l : s.lights) {
         const V d = l.position - s.camera.eye;
         l.position = V(dot_of(rows[0], d), dot_of(rows[1], d), dot_of(rows[2], d));
       }
       return true;
     });
  all.push_back({"positions rebuilt by another near plane",
                 {"lighting-near"},
                 "picture",
                 {"many-lights"},
                 3,
                 nullptr,
                 [](const Scene& s, const Pipeline& p, Capture& c, int v) {
                   Capture moved = c;
                   Pipeline stored = p;
                   stored.gbuffer.position_from_depth = false;
                   each_vector(moved, "position", [&](const V& at) {
                     return by_near(s.camera, at, pick({0.9f, 2.0f, 1.03f}, v));
                   });
                   c.color = slipped_picture(s, stored, moved, LightSlip::none);
                 }});
  all.back().lights_again = true, all.back().base = rebuilt_positions;
}

void add_planes(std::vector<Plant>& all) {
  const auto out = [&](std::string_view plane, std::string_view name, Names names, Output output, int variants = 1) {
    all.push_back(
        {name, std::move(names), plane, {"many-lights", "touchdesigner"}, variants, nullptr, std::move(output)});
  };
  out("position", "positions stored by another near plane", {"position-near", "position-scaled"},
      vectors("position",
              [](const Scene& s, const V& p, int v) {
                return by_near(s.camera, p, pick({0.9f, 2.0f, 1.03f}, v));
              }),
      3);
  out("normal", "normals written as unorm, read as snorm", {"normal-unorm-as-snorm"},
      vectors("normal", [](const Scene&, const V& n, int) {
        V r;
        for (int k = 0; k < 3; ++k)
          r[k] = std::max(-1.0f, float(int8_t(uint8_t(std::lround((n[k] * 0.5f + 0.5f) * 255)))) / 127);
        return r;
      }));
  out("normal", "normals written as snorm, read as unorm", {"normal-snorm-as-unorm"},
      vectors("normal", [](const Scene&, const V& n, int) {
        V r;
        for (int k = 0; k < 3; ++k) r[k] = float(uint8_t(byte_of(n[k]))) / 255 * 2 - 1;
        return r;
      }));
  out("normal", "normals decoded twice", {"normal-doubled"},
      vectors("normal", [](const Scene&, const V& n, int) { return n * 2.0f - 1.0f; }));
  out("normal", "normals unit where interpolated ones are due", {"normal-unit"},
      vectors("normal", [](const Scene&, const V& n, int) { return n * (1 / std::sqrt(dot_of(n, n))); }));
  all.back().base = rounded;
  const auto albedo = [&](std::string_view name, Names names, float (*formula)(float, int k), bool glassy) {
    out("albedo", name, std::move(names), [formula](const Scene&, const Pipeline&, Capture& c, int) {
      Image& plane = *plane_of(c, "albedo");
      for (int y = 0; y < plane.height; ++y)
        for (int x = 0; x < plane.width; ++x)
          for (int k = 0; k < 4; ++k) {
            const float v = formula(float(plane.value(x, y, k)), k);
            if (plane.format == Format::rgba8)
              plane.set_code(x, y, k, uint32_t(std::lround(std::clamp(v, 0.0f, 1.0f) * 255)));
            else
              std::memcpy(plane.texel(x, y) + 4 * k, &v, 4);
          }
    });
    if (glassy)
      all.back().base = [](Scene& s, Pipeline&) {
        for (Material& m : s.materials) m.base_color.a = 0.6f;
      };
  };
  albedo(
      "albedo with a gain", {"albedo-scaled"}, [](float v, int k) { return k < 3 ? v * 0.8f : v; }, false);
  albedo(
      "alpha encoded as sRGB", {"albedo-alpha-srgb-encoded"},
      [](float v, int k) { return k < 3 ? v : 1.055f * std::pow(v, 1 / 2.4f) - 0.055f; }, true);
  const auto in = [&](std::string_view plane, std::string_view name, Names names, Input input, int variants) -> Plant& {
    all.push_back({name, std::move(names), plane, {"many-lights", "touchdesigner"}, variants, std::move(input)});
    return all.back();
  };
  // The inverse transpose of a matrix D is undone where the mesh's normals are D^2 n.
  in(
      "normal", "normals by the model matrix", {"normal-matrix"},
      [](Scene& s, Pipeline&, int) {
        for (Instance& i : s.instances) {
          Mesh mesh = s.meshes[i.mesh];
          const glm::mat4x3& m = i.world_from_object;
          for (size_t v = 0; v < mesh.vertex_count(); ++v) {
            const V n(mesh.normal[0][v], mesh.normal[1][v], mesh.normal[2][v]),
                w = m[0] * n.x + m[1] * n.y + m[2] * n.z;
            for (int k = 0; k < 3; ++k) mesh.normal[size_t(k)][v] = dot_of(m[k], w);
          }
          i.mesh = uint32_t(s.meshes.size());
          s.meshes.push_back(std::move(mesh));
        }
        return true;
      },
      1)
      .base = [](Scene& s, Pipeline&) {
    for (Instance& i : s.instances)
      i.world_from_object[1] *= 1.6f, i.world_from_object[0] += 0.3f * i.world_from_object[1];
  };
  in(
      "G-buffer", "one object's colour", {"object-color", "material-color"},
      [](Scene& s, Pipeline&, int v) {
        Instance& object = s.instances[(size_t(v) * 7) % s.instances.size()];
        s.materials.push_back(s.materials[object.material]);
        object.material = uint32_t(s.materials.size() - 1);
        s.materials.back().base_color *= glm::vec4(pick({0.5f, 1.2f, 0.9f}, v), 0.8f, pick({1.0f, 0.7f}, v), 1.0f);
        return true;
      },
      4)
      .plane = "albedo";
}

}  // namespace

const std::vector<Plant>& plants_of_lights() {
  static const std::vector<Plant> all = [] {
    std::vector<Plant> made;
    add_lights(made), add_planes(made);
    return made;
  }();
  return all;
}

}  // namespace trueshade::testing
