// Faults of materials: how maps are read, what the alpha test drops, and glass.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "tests/judge/diagnosis/plants.h"

namespace trueshade::testing {

namespace {

constexpr std::string_view kTextured = "lecture";

/// A map of codes by a formula of the texel, for scenes without maps; coordinates are made of positions.
template <class Formula>
int32_t add_map(Scene& s, const Formula& formula) {
  Texture map;
  map.format = TextureFormat::rgba8;
  map.levels.push_back({32, 32, {}});
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) append_texel(map.format, formula(x, y), map.levels[0].bytes);
  build_mip_chain(map);
  s.textures.push_back(std::move(map));
  for (Mesh& mesh : s.meshes) {
    for (size_t k = 0; k < 2; ++k) mesh.uv[k].resize(mesh.vertex_count());
    for (size_t v = 0; v < mesh.vertex_count(); ++v) {
      mesh.uv[0][v] = mesh.position[0][v] + 0.37f * mesh.position[1][v];
      mesh.uv[1][v] = mesh.position[2][v] - 0.21f * mesh.position[1][v];
    }
  }
  return int32_t(s.textures.size() - 1);
}

void bumpy(Scene& s, Pipeline&) {
  const int32_t map = add_map(s, [](int x, int y) {
    const float a = 0.5f + 0.2f * std::sin(0.39f * float(x)), b = 0.5f + 0.15f * std::cos(0.59f * float(y));
    return std::array<float, 4>{a, b, 0.9f, 1.0f};
  });
  for (Material& m : s.materials) m.normal_map.texture = map;
}
/// With tangents that follow no texture coordinates, mirrored in each second mesh.
void bumpy_along_tangents(Scene& s, Pipeline& p) {
  bumpy(s, p);
  float sign = 1;
  for (Mesh& mesh : s.meshes) {
    if (mesh.normal[0].empty()) continue;
    for (FloatStream& stream : mesh.tangent) stream.resize(mesh.vertex_count());
    for (size_t i = 0; i < mesh.vertex_count(); ++i) {
      const glm::vec3 n(mesh.normal[0][i], mesh.normal[1][i], mesh.normal[2][i]);
      const glm::vec3 t = glm::normalize(glm::cross(n, glm::vec3(0.31f, 0.83f, 0.47f)));
      for (size_t k = 0; k < 3; ++k) mesh.tangent[k][i] = t[int(k)];
      mesh.tangent[3][i] = sign;
    }
    sign = -sign;
  }
}
void masked(Scene& s, Pipeline&) {
  const int32_t map = add_map(s, [](int x, int y) {
    return std::array<float, 4>{0.8f, 0.6f, 0.3f, 0.5f + 0.5f * std::sin(0.4f * float(x)) * std::cos(0.4f * float(y))};
  });
  for (Material& m : s.materials) m.color_map.texture = map, m.alpha_cutoff = 0.5f;
}

void add_maps(std::vector<Plant>& all) {
  const auto in = [&](std::string_view plane, std::string_view name, Names names, Input input, int variants) -> Plant& {
    all.push_back({name, std::move(names), plane, {"many-lights", "touchdesigner"}, variants, std::move(input)});
    return all.back();
  };
  in(
      "albedo", "texels offset by a half", {"texture-offset"},
      [](Scene& s, Pipeline&, int v) {
        for (const Instance& object : s.instances) {
          TextureSlot& slot = s.materials[object.material].color_map;
          Mesh& mesh = s.meshes[object.mesh];
          if (!slot.used() || !mesh.more_uv.empty()) continue;
          const TextureLevel& level = s.textures[size_t(slot.texture)].levels[0];
          mesh.more_uv.push_back(mesh.uv);
          for (float& u : mesh.more_uv[0][0]) u += (v == 1 ? 0.0f : 0.5f) / float(level.width);
          for (float& w : mesh.more_uv[0][1]) w -= (v == 2 ? 0.0f : 0.5f) / float(level.height);
        }
        for (Material& m : s.materials) m.color_map.uv_set = 1;
        return true;
      },
      3)
      .scenes = {kTextured};
  in(
      "albedo", "mip levels with a bias", {"texture-lod-bias", "texture-filter"},
      [](Scene& s, Pipeline&, int v) {
        for (Material& m : s.materials) m.color_map.sampler.lod_bias += pick({2.0f, -1.0f, -2.0f}, v);
        return true;
      },
      3)
      .scenes = {kTextured};
  in(
      "albedo", "a map with a gain", {"material-color", "object-color", "albedo-scaled"},
      [](Scene& s, Pipeline&, int v) {
        for (Material& m : s.materials)
          if (m.color_map.texture == v) m.base_color *= glm::vec4(0.8f, 0.8f, 0.8f, 1.0f);
        return true;
      },
      2)
      .scenes = {kTextured};
  in(
      "albedo", "another colour map", {"material-color-map"},
      [](Scene& s, Pipeline&, int v) {
        for (Material& m : s.materials)
          if (m.color_map.texture == v) m.color_map.texture = 1 - v;
        return true;
      },
      2)
      .scenes = {kTextured};
  in(
      "G-buffer", "texture coordinates offset", {"uv-offset"},
      [](Scene& s, Pipeline&, int v) {
        for (Mesh& mesh : s.meshes)
          for (float& u : mesh.uv[0]) u += pick({0.1f, -0.5f}, v);
        return true;
      },
      2)
      .scenes = {kTextured};
  in(
      "normal", "a normal map's green turned", {"normal-map-green"},
      [](Scene& s, Pipeline&, int) {
        for (TextureLevel& level : s.textures.back().levels)
          for (size_t i = 1; i < level.bytes.size(); i += 4) level.bytes[i] = uint8_t(255 - level.bytes[i]);
        return true;
      },
      1)
      .base = bumpy;
  in(
      "normal", "a normal map decoded as sRGB", {"normal-map-srgb"},
      [](Scene& s, Pipeline&, int) {
        s.textures.back().format = TextureFormat::srgb8_a8;
        return true;
      },
      1)
      .base = bumpy;
  in(
      "normal", "normal maps not read", {"normal-map-missing"},
      [](Scene& s, Pipeline&, int) {
        for (Material& m : s.materials) m.normal_map.texture = -1;
        return true;
      },
      1)
      .base = bumpy;
  in(
      "normal", "tangents not read", {"tangents-missing"},
      [](Scene& s, Pipeline&, int) {
        for (Mesh& mesh : s.meshes) mesh.tangent = {};
        for (TextureLevel& level : s.textures.back().levels)  // green stays where it was
          for (size_t i = 1; i < level.bytes.size(); i += 4) level.bytes[i] = uint8_t(255 - level.bytes[i]);
        return true;
      },
      1)
      .base = bumpy_along_tangents;
  in(
      "normal", "the sign of tangents not read", {"tangent-sign-missing"},
      [](Scene& s, Pipeline&, int) {
        bool any = false;
        for (Mesh& mesh : s.meshes)
          for (float& w : mesh.tangent[3]) any = any || w < 0, w = 1;
        return any;
      },
      1)
      .base = bumpy_along_tangents;
  in(
      "G-buffer", "another cutoff of the alpha test", {"alpha-cutoff"},
      [](Scene& s, Pipeline&, int v) {
        s.materials[size_t(v) % s.materials.size()].alpha_cutoff = pick({0.3f, 0.0f, 0.6f, 0.4f}, v);
        return true;
      },
      4)
      .base = masked;
}

/// Some objects are of glass, half of it before others.
void glazed(Scene& s, Pipeline&) {
  const size_t count = s.instances.size();
  for (size_t i = 1; i < count; ++i) {
    if (i % 3 == 0 && count > 8) continue;
    s.materials.push_back(s.materials[s.instances[i].material]);
    s.materials.back().transparent = true, s.materials.back().base_color.a = 0.3f + 0.1f * float(i % 4);
    s.instances[i].material = uint32_t(s.materials.size() - 1);
  }
}
std::vector<size_t> glass_of(const Scene& s) {
  std::vector<size_t> all;
  for (size_t i = 0; i < s.instances.size(); ++i)
    if (s.materials[s.instances[i].material].transparent) all.push_back(i);
  return all;
}

void add_glass(std::vector<Plant>& all) {
  const auto in = [&](std::string_view name, Names names, Input input, int variants = 1) {
    all.push_back({name, std::move(names), "picture", {"many-lights", "touchdesigner"}, variants, std::move(input)});
    all.back().base = glazed;
  };
  in("glass missing", {"glass-missing"}, [](Scene& s, Pipeline&, int) {
    const auto nothing = uint32_t(s.meshes.size());
    s.meshes.emplace_back();
    for (const size_t i : glass_of(s)) s.instances[i].mesh = nothing;
    return true;
  });
  in(
      "a glass object missing", {"glass-object-missing"},
      [](Scene& s, Pipeline&, int v) {
        const std::vector<size_t> glass = glass_of(s);
        const auto nothing = uint32_t(s.meshes.size());
        s.meshes.emplace_back();
        s.instances[glass[size_t(v) * 5 % glass.size()]].mesh = nothing;
        return true;
      },
      3);
  in("glass in the opposite order", {"glass-reversed", "glass-near-first", "glass-far-first"},
     [](Scene& s, Pipeline&, int) {
       const std::vector<size_t> glass = glass_of(s);
       for (size_t a = 0, b = glass.size() - 1; a < b; ++a, --b)
         std::swap(s.instances[glass[a]], s.instances[glass[b]]);
       return true;
     });
  in("glass not multiplied by its alpha", {"glass-unmultiplied"}, [](Scene&, Pipeline& p, int) {
    p.transparency.blend.rgb.src = BlendFactor::one;
    return true;
  });
  in("glass added", {"glass-added"}, [](Scene&, Pipeline& p, int) {
    p.transparency.blend.rgb.dst = BlendFactor::one;
    return true;
  });
  in("glass not blended", {"glass-opaque"}, [](Scene&, Pipeline& p, int) {
    p.transparency.blend.enabled = false;
    return true;
  });
  in("glass with alpha encoded as sRGB", {"glass-alpha-srgb-encoded"}, [](Scene& s, Pipeline&, int) {
    for (Material& m : s.materials)
      if (m.transparent) m.base_color.a = 1.055f * std::pow(m.base_color.a, 1 / 2.4f) - 0.055f;
    return true;
  });
}

}  // namespace

const std::vector<Plant>& plants_of_materials() {
  static const std::vector<Plant> all = [] {
    std::vector<Plant> made;
    add_maps(made), add_glass(made);
    return made;
  }();
  return all;
}

}  // namespace trueshade::testing
