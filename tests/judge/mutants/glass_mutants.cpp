#include "tests/judge/mutants/glass_mutants.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>

#include "scenes/shapes.h"
#include "tests/judge/mutants/surface_mutants.h"

namespace trueshade::oracle {

namespace {

bool glass(const Scene& s, const Instance& i) { return s.materials[i.material].transparent; }

glm::vec3 unit(const glm::vec3& v) { return v * (1 / std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z)); }
glm::vec3 crossed(const glm::vec3& a, const glm::vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// --- what the wrong one is given ------------------------------------------------------------------------------------

void reversed(Scene& s, Pipeline&) {
  std::vector<Instance*> panes;
  for (Instance& i : s.instances)
    if (glass(s, i)) panes.push_back(&i);
  for (size_t k = 0; k < panes.size() / 2; ++k) std::swap(*panes[k], *panes[panes.size() - 1 - k]);
}
void factors_exchanged(Scene&, Pipeline& p) { std::swap(p.transparency.blend.rgb.src, p.transparency.blend.rgb.dst); }
void added(Scene&, Pipeline& p) { p.transparency.blend.rgb = kAccumulate; }
void as_premultiplied(Scene&, Pipeline& p) { p.transparency.blend.rgb.src = BlendFactor::one; }
void alpha_squared(Scene&, Pipeline& p) { p.transparency.blend.alpha.src = BlendFactor::src_alpha; }
void as_opaque(Scene&, Pipeline& p) { p.transparency.mode = TransparencyMode::none; }
void other_mode(Scene&, Pipeline& p) {
  if (is_forward(p.strategy)) return;
  p.transparency.mode = p.transparency.mode == TransparencyMode::into_albedo ? TransparencyMode::after_lights
                                                                             : TransparencyMode::into_albedo;
}
void clearer(Scene& s, Pipeline&) {
  for (Material& m : s.materials)
    if (m.transparent) m.base_color.a *= 0.9f;
}
void triangle_lost(Scene& s, Pipeline&) {
  for (Instance& i : s.instances)
    if (glass(s, i)) {
      Array<uint32_t>& indices = s.meshes[i.mesh].indices;
      if (indices.size() > 3) indices.resize(indices.size() - 3);
      return;
    }
}
void moved(Scene& s, Pipeline&) {
  for (Instance& i : s.instances)
    if (glass(s, i)) i.world_from_object[3] += 0.05f * i.world_from_object[0];
}
void lit_from_behind(Scene& s, Pipeline&) {
  for (const Instance& i : s.instances) {
    if (!glass(s, i)) continue;
    const auto own = uint32_t(&i - s.instances.data());
    Mesh turned = s.meshes[i.mesh];
    for (auto& stream : turned.normal)
      for (float& v : stream) v = -v;
    s.meshes.push_back(turned);
    s.instances[own].mesh = uint32_t(s.meshes.size() - 1);
  }
}

// --- what it makes of several pictures
// --------------------------------------------------------------------------------

/// The scene with those of its glass objects whose bit is set.
Scene with_glass(const Scene& s, unsigned mask) {
  Scene out = s;
  const auto nothing = uint32_t(out.meshes.size());
  out.meshes.emplace_back();
  unsigned bit = 0;
  for (Instance& i : out.instances)
    if (glass(s, i) && (mask >> bit++ & 1u) == 0) i.mesh = nothing;
  return out;
}

unsigned glass_count(const Scene& s) {
  return unsigned(
      std::count_if(s.instances.begin(), s.instances.end(), [&](const Instance& i) { return glass(s, i); }));
}

void copy_texel(const Capture& from, Capture& to, int x, int y) {
  const auto copy = [&](const Image& a, Image& b) {
    std::memcpy(b.texel(x, y), a.texel(x, y), size_t(info(a.format).bytes_per_texel()));
  };
  copy(from.color, to.color);
  for (size_t i = 0; i < to.planes.size(); ++i) copy(from.planes[i].image, to.planes[i].image);
}

/// Of each glass object as if it were opaque: its depth where it is seen, else 2.
std::vector<std::vector<double>> glass_depths(const Scene& s, const Pipeline& p, const Renderer& render) {
  std::vector<std::vector<double>> depths;
  Pipeline solid = p;
  solid.transparency.mode = TransparencyMode::none;
  for (unsigned k = 0; k < glass_count(s); ++k) {
    const Scene alone = with_glass(s, 1u << k);
    const Capture c = render(alone, solid);
    const Image &ids = *c.plane("id.object"), &depth = *c.plane("depth");
    std::vector<double>& list = depths.emplace_back();
    for (int y = 0; y < p.height; ++y)
      for (int x = 0; x < p.width; ++x) {
        const auto id = size_t(ids.value(x, y, 0));
        list.push_back(id > 0 && glass(s, s.instances[id - 1]) ? depth.value(x, y, 0) : 2.0);
      }
  }
  return depths;
}

/// Depth written by glass: what is drawn later behind it is lost.
Capture depth_written(const Scene& s, const Pipeline& p, const Renderer& render) {
  const std::vector<std::vector<double>> depths = glass_depths(s, p, render);
  const unsigned all = (1u << depths.size()) - 1;
  std::map<unsigned, Capture> pictures;
  pictures[all] = render(s, p);
  Capture out = pictures[all];
  for (int y = 0; y < p.height; ++y)
    for (int x = 0; x < p.width; ++x) {
      const size_t at = size_t(y) * size_t(p.width) + size_t(x);
      unsigned drawn = all;
      double front = 1.5;
      for (unsigned k = 0; k < depths.size(); ++k) {
        if (depths[k][at] > 1.5) continue;
        if (depths[k][at] < front)
          front = depths[k][at];
        else
          drawn &= ~(1u << k);
      }
      if (drawn == all) continue;
      if (pictures.count(drawn) == 0) pictures[drawn] = render(with_glass(s, drawn), p);
      copy_texel(pictures[drawn], out, x, y);
    }
  return out;
}

/// Glass not tested against the depth: where all of it is hidden it shines through.
Capture depth_not_tested(const Scene& s, const Pipeline& p, const Renderer& render) {
  Capture out = render(s, p);
  if (p.target != Format::rgba8 || p.transparency.mode != TransparencyMode::after_lights) return out;
  const Capture bare = render(with_glass(s, 0), p);
  Scene alone = s;
  alone.clear = glm::vec4(0.0f);
  const auto nothing = uint32_t(alone.meshes.size());
  alone.meshes.emplace_back();
  for (Instance& i : alone.instances)
    if (!glass(s, i)) i.mesh = nothing;
  const Capture panes = render(alone, p);
  for (int y = 0; y < p.height; ++y)
    for (int x = 0; x < p.width; ++x) {
      const uint8_t *pane = panes.color.texel(x, y), *behind = bare.color.texel(x, y);
      uint8_t* shown = out.color.texel(x, y);
      if (pane[3] == 0 || std::memcmp(shown, behind, 4) != 0) continue;
      for (int k = 0; k < 3; ++k) shown[k] = uint8_t(std::min(255, pane[k] + behind[k] * (255 - pane[3]) / 255));
    }
  return out;
}

constexpr GlassMutant kGlassMutants[] = {
    {"glass drawn in reverse", kNone, reversed, nullptr},
    {"alpha and 1 - alpha exchanged", kNone, factors_exchanged, nullptr},
    {"glass added", kNone, added, nullptr},
    {"glass taken for premultiplied", kNone, as_premultiplied, nullptr},
    {"alpha times itself", kNone, alpha_squared, nullptr},
    {"glass drawn as if opaque", kNone, as_opaque, nullptr},
    {"glass in the other mode", kNone, other_mode, nullptr},
    {"alpha off by a tenth", kNone, clearer, nullptr},
    {"a triangle of glass lost", kNone, triangle_lost, nullptr},
    {"glass moved by a twentieth", kNone, moved, nullptr},
    {"glass lit from behind", kNone, lit_from_behind, nullptr},
    {"depth written by glass", kNone, nullptr, depth_written},
    {"hidden glass drawn", kNone, nullptr, depth_not_tested},
};

}  // namespace

void add_glass(Scene& scene) {
  const Camera& camera = scene.camera;
  const glm::vec3 away = camera.target - camera.eye;
  const float d = std::sqrt(away.x * away.x + away.y * away.y + away.z * away.z);
  const glm::vec3 f = away * (1 / d), s = unit(crossed(f, camera.up)), u = crossed(s, f);
  const auto material = [&](const glm::vec4& color) -> Material& {
    Material m;
    m.base_color = color;
    m.transparent = true;
    return scene.materials.emplace_back(m);
  };
  material({0.9f, 0.4f, 0.3f, 0.4f});
  material({0.3f, 0.8f, 0.5f, 0.6f});
  material({0.4f, 0.5f, 0.9f, 0.25f});
  const auto first = uint32_t(scene.materials.size() - 3);
  Texture& checks = scene.textures.emplace_back(Texture{"checks", TextureFormat::rgba8, {{4, 4, {}}}});
  for (int i = 0; i < 16; ++i) {
    const float v = (i / 4 + i) % 2 == 0 ? 1.0f : 0.4f;
    append_texel(checks.format, {v, 1 - 0.5f * v, 0.5f + 0.5f * v, v}, checks.levels[0].bytes);
  }
  build_mip_chain(checks);
  scene.materials[first + 1].color_map.texture = int32_t(scene.textures.size() - 1);
  scene.materials[first + 1].normal_map.texture = int32_t(scene.textures.size() - 1);
  scene.materials[first + 1].normal_scale = 0.25f;
  Mesh pane = plane_mesh(2);
  for (size_t v = 0; v < pane.vertex_count(); ++v)
    pane.uv[0].push_back(pane.position[0][v]), pane.uv[1].push_back(pane.position[2][v]);
  const auto panes = uint32_t(scene.meshes.size());
  scene.meshes.push_back(std::move(pane));
  scene.meshes.push_back(sphere_mesh(4));
  const auto stand = [&](uint32_t of, float depth, float right, float up, float size, float turn) {
    const glm::vec3 n = unit(s * turn - f), x = unit(crossed(u, n)), z = crossed(x, n);
    const glm::vec3 place = camera.eye + f * (depth * d) + s * (right * d) + u * (up * d);
    scene.instances.push_back({panes, of, glm::mat4x3(x * (size * d), n * (size * d), z * (size * d), place)});
  };
  stand(first, 0.45f, -0.05f, 0.0f, 0.22f, 0.35f);
  stand(first + 1, 0.55f, 0.05f, 0.03f, 0.25f, -0.45f);
  const glm::vec3 ball = camera.eye + f * (0.7f * d) + s * (0.1f * d) - u * (0.08f * d);
  const float r = 0.08f * d;
  scene.instances.push_back(
      {panes + 1, first + 2, glm::mat4x3(glm::vec3(r, 0, 0), glm::vec3(0, r, 0), glm::vec3(0, 0, r), ball)});
  stand(first, 1.0f, 0.0f, 0.05f, 0.6f, 0.6f);
}

std::span<const GlassMutant> glass_mutants() { return kGlassMutants; }

}  // namespace trueshade::oracle
