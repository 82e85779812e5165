// Normal and specular maps on a real driver: what the driver stores against the formulas of docs/arithmetic.md section
// 13 in long double, of the driver's own normals and texture coordinates, within the roundings of the shader; then the
// pictures of all strategies against ours.
#include <algorithm>
#include <cmath>

#include "oracle/matrices.h"
#include "oracle/texture_lookup.h"
#include "scenes/builtin/builtin.h"
#include "scenes/pipeline/presets.h"
#include "shading/frame.h"
#include "tests/catch.hpp"
#include "tests/gl/driver.h"
#include "tests/judge/mutants/surface_mutants.h"
#include "tests/stated_presets.h"

using namespace trueshade;
using namespace trueshade::testing;
using namespace trueshade::oracle;

namespace {

using Real = long double;
using Real3 = std::array<Real, 3>;

Real dot(const Real3& a, const Real3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Real3 cross(const Real3& a, const Real3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Texels of bumps: x, y anywhere, z up. Nearest and without levels, so that every lookup is one texel.
Texture bumps(TextureFormat format, int width, int height, uint32_t seed) {
  Texture texture{"bumps", format, {{width, height, {}}}};
  for (int i = 0; i < width * height; ++i) {
    float value[3];
    for (float& v : value) {
      seed = seed * 1664525u + 1013904223u;
      v = float(seed >> 8) / float(1 << 24);
    }
    append_texel(format, {value[0], value[1], 0.6f + 0.4f * value[2], 1.0f}, texture.levels[0].bytes);
  }
  return texture;
}

TextureSlot slot_of(int texture) {
  TextureSlot slot;
  slot.texture = texture;
  slot.sampler.mag_filter = slot.sampler.min_filter = Filter::nearest;
  slot.sampler.mip_filter = MipFilter::none;
  return slot;
}

/// The scene with bumps and gloss on everything; meshes without texture coordinates get some, mirrored on every other.
Scene bumpy(const char* name) {
  Scene scene = builtin_scene(name);
  add_texture_coordinates(scene);
  const auto first = int(scene.textures.size());
  scene.textures.push_back(bumps(TextureFormat::rgba8, 8, 12, 1));
  scene.textures.push_back(bumps(TextureFormat::rgba32f, 5, 3, 2));
  for (size_t i = 0; i < scene.materials.size(); ++i) {
    Material& m = scene.materials[i];
    m.specular_color = {0.3f, 0.2f, 0.4f};
    m.specular_map = slot_of(first + int(i + 1) % 2);
    if (i % 3 == 2) continue;  // a material without a normal map among the others
    m.normal_map = slot_of(first + int(i) % 2);
    m.normal_scale = i % 2 == 0 ? 1.0f : 0.5f;
  }
  return scene;
}

struct Frames {
  Capture bent, level;  ///< with the scene's normal maps, and without
};

Frames drawn(const GlContext& context, const Scene& scene, const Pipeline& pipeline) {
  GlRenderer renderer(context, scene);
  GlDraw draw;
  draw.shader_options = renderer.shader_options(draw);
  draw.shader_options.normal_maps = false;
  const GlslShaders plain = shaders_of(pipeline, draw.shader_options);
  draw.shaders = &plain;
  return {renderer.draw(pipeline).capture, renderer.draw(pipeline, draw).capture};
}

/// The texel at a driver's stored texture coordinates; nothing where float's error may choose another.
std::optional<std::array<float, 4>> texel_at(const Texture& texture, const Image& uv, int x, int y) {
  int index[2];
  for (int k = 0; k < 2; ++k) {
    const TextureLevel& level = texture.levels[0];
    const int side = k == 0 ? level.width : level.height;
    const Real p = Real(uv.value(x, y, k)) * side, nearest = std::round(p);
    if (std::fabs(p - nearest) <= 0x1p-22L * (std::fabs(p) + side)) return {};
    index[k] = int(((texel_index(Real(uv.value(x, y, k)), side) % side) + side) % side);
  }
  return texel_value(texture, 0, index[0], index[1]);
}

/// Where u and v grow on a triangle, in the world.
std::array<Real3, 2> frame_of(const Scene& scene, const InstanceRows& rows, size_t instance, size_t triangle) {
  const Mesh& mesh = scene.meshes[scene.instances[instance].mesh];
  Real3 p[3];
  Real u[3], v[3];
  for (size_t k = 0; k < 3; ++k) {
    const size_t i = mesh.indices[3 * triangle + k];
    for (size_t r = 0; r < 3; ++r) {
      p[k][r] = Real(rows.world[r][3]);
      for (size_t c = 0; c < 3; ++c) p[k][r] += Real(rows.world[r][c]) * Real(mesh.position[c][i]);
    }
    u[k] = Real(mesh.uv[0][i]), v[k] = Real(mesh.uv[1][i]);
  }
  const Real a1 = u[1] - u[0], b1 = v[1] - v[0], a2 = u[2] - u[0], b2 = v[2] - v[0];
  const Real sign = a1 * b2 - a2 * b1 < 0 ? -1 : 1;
  std::array<Real3, 2> out{};
  for (size_t r = 0; r < 3; ++r) {
    out[0][r] = sign * ((p[1][r] - p[0][r]) * b2 - (p[2][r] - p[0][r]) * b1);
    out[1][r] = sign * ((p[2][r] - p[0][r]) * a1 - (p[1][r] - p[0][r]) * a2);
  }
  return out;
}

struct Bent {
  Real3 normal;
  Real bound;  ///< of each component's error
};

/// Section 13 with the driver's own N, and what the shader's roundings make of it, u = 2^-23 (docs/gl_rules.md section
/// 6): U to the world 3.5, N.U, its quotient, product and difference 8 of |U|, so 12 of |U| / |T|; T's unit length 4.5,
/// C and B 7 more; 2 r - 1 of a texel 3.5 each; products and sums 4.
Bent bent(const Real3& n, const std::array<Real3, 2>& frame, const std::array<float, 4>& texel, float scale) {
  const Real n2 = dot(n, n), un = dot(n, frame[0]) / n2;
  Real3 t{frame[0][0] - n[0] * un, frame[0][1] - n[1] * un, frame[0][2] - n[2] * un};
  const Real length = std::sqrt(dot(t, t)), grown = std::sqrt(dot(frame[0], frame[0])) / length;
  for (Real& c : t) c /= length;
  Real3 b = cross(n, t);
  const Real turn = dot(b, frame[1]) < 0 ? -1 : 1;
  for (Real& c : b) c *= turn / std::sqrt(n2);
  const Real x = (2 * Real(texel[0]) - 1) * Real(scale), y = (2 * Real(texel[1]) - 1) * Real(scale);
  const Real z = 2 * Real(texel[2]) - 1;
  Bent out;
  for (size_t k = 0; k < 3; ++k) out.normal[k] = (t[k] * x + b[k] * y) + n[k] * z;
  const Real length_n = std::sqrt(n2), t_error = 12 * grown + 4.5L, b_error = t_error + 7;
  out.bound = 0x1p-23L * (std::fabs(x) * t_error + std::fabs(y) * b_error +
                          4 * (std::fabs(x) + std::fabs(y) + length_n * std::fabs(z)) + 3.5L * (2 + length_n));
  return out;
}

struct Tally {
  int bent = 0, ambiguous = 0, wrong = 0, gloss = 0, wrong_gloss = 0;
  Real worst = 0;  ///< error by its bound
};

Tally judged(const Scene& scene, const Pipeline& pipeline, const Frames& frames) {
  const auto plane = [](const Capture& c, const char* name) -> const Image& { return *c.plane(name); };
  const Image &objects = plane(frames.bent, "id.object"), &triangles = plane(frames.bent, "id.primitive");
  const Image &uv = plane(frames.bent, "uv"), &normal = plane(frames.bent, "normal");
  const Image &level = plane(frames.level, "normal"), &gloss = plane(frames.bent, "specular");
  CHECK(plane(frames.level, "uv").texels == uv.texels);  // the same surfaces
  std::vector<InstanceRows> rows;
  for (const Instance& i : scene.instances)
    rows.push_back(instance_rows(i, projection_of(scene.camera, pipeline.geometry, pipeline.width, pipeline.height)));
  Tally tally;
  for (int y = 0; y < pipeline.height; ++y)
    for (int x = 0; x < pipeline.width; ++x) {
      const auto object = size_t(objects.value(x, y, 0));
      if (object == 0) continue;
      const Material& m = scene.materials[scene.instances[object - 1].material];
      const auto lookup = [&](const TextureSlot& s) { return texel_at(scene.textures[size_t(s.texture)], uv, x, y); };
      if (const auto texel = lookup(m.specular_map)) {
        ++tally.gloss;
        for (int c = 0; c < 3; ++c) {  // a fetch and a product
          const Real right = Real(m.specular_color[c]) * Real((*texel)[size_t(c)]);
          tally.wrong_gloss += std::fabs(Real(gloss.value(x, y, c)) - right) > 0x1p-23L * 2.25L * right ? 1 : 0;
        }
      }
      Real3 n{}, given{};
      for (size_t k = 0; k < 3; ++k)
        n[k] = Real(level.value(x, y, int(k))), given[k] = Real(normal.value(x, y, int(k)));
      if (!m.normal_map.used()) {
        tally.wrong += given == n ? 0 : 1;
        continue;
      }
      const auto texel = lookup(m.normal_map);
      if (!texel) {
        ++tally.ambiguous;
        continue;
      }
      ++tally.bent;
      const auto frame = frame_of(scene, rows[object - 1], object - 1, size_t(triangles.value(x, y, 0)) - 1);
      const Bent right = bent(n, frame, *texel, m.normal_scale);
      Real error = 0;
      for (size_t k = 0; k < 3; ++k) error = std::max(error, std::fabs(given[k] - right.normal[k]));
      tally.worst = std::max(tally.worst, error / right.bound);
      tally.wrong += error <= right.bound ? 0 : 1;
    }
  return tally;
}

Pipeline glossy_pipeline() {
  Pipeline pipeline = presets().front().pipeline;
  pipeline.light_model.specular_source = SpecularSource::material;
  pipeline.width = 200, pipeline.height = 150;
  return pipeline;
}

}  // namespace

TEST_CASE("llvmpipe bends normals and multiplies gloss as the formulas say, within the roundings of the shader") {
  const GlContext* context = opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  for (const char* name : {"lecture", "city,objects=200", "rabbits,objects=4"}) {
    const Scene scene = bumpy(name);
    const Pipeline pipeline = glossy_pipeline();
    const Frames frames = drawn(*context, scene, pipeline);
    const Tally tally = judged(scene, pipeline, frames);
    INFO(name);
    CAPTURE(tally.bent, tally.ambiguous, double(tally.worst), tally.gloss);
    Scene wrong = scene;  // by 1 part in 10,000
    for (Material& m : wrong.materials) m.normal_scale *= 1.0001f, m.specular_color *= 1.0001f;
    const Tally rejected = judged(wrong, pipeline, frames);
    CHECK(rejected.wrong > rejected.bent / 2);
    CHECK(rejected.wrong_gloss > rejected.gloss / 2);
    CHECK(tally.bent > 5000);
    CHECK(tally.ambiguous < tally.bent / 50);
    CHECK(tally.wrong == 0);
    CHECK(tally.gloss > 5000);
    CHECK(tally.wrong_gloss == 0);
  }
}

TEST_CASE("Triangles that start with another vertex are bent alike") {
  const GlContext* context = opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  const Scene scene = bumpy("city,objects=200");
  const Pipeline pipeline = glossy_pipeline();
  const Image first = *GlRenderer(*context, scene).draw(pipeline).capture.plane("normal");
  const Image turned = *GlRenderer(*context, scene, 1).draw(pipeline).capture.plane("normal");
  int apart = 0;
  for (int y = 0; y < first.height; ++y)
    for (int x = 0; x < first.width; ++x)
      for (int k = 0; k < 3; ++k) apart += std::fabs(first.value(x, y, k) - turned.value(x, y, k)) > 1e-4 ? 1 : 0;
  CHECK(apart < first.width * first.height / 100);  // other texels and edges
}

TEST_CASE("Pictures with normal and specular maps are ours in every strategy, under models that read them or do not",
          "[slow]") {
  const GlContext* context = opened(GlDriver::llvmpipe);
  if (context == nullptr) return;
  const std::string aovs[] = {"id.object"};
  KeptPrograms programs;
  for (const char* name : {"lecture,lights=6", "city,objects=200,lights=40"}) {
    const Scene scene = bumpy(name);
    const PreparedScene prepared(scene);
    GlRenderer renderer(*context, scene, 0, &programs);
    for (const Preset& preset : stated_presets())
      for (size_t strategy = 0; strategy < std::size(kStrategyNames); ++strategy) {
        Pipeline pipeline = preset.pipeline;
        pipeline.strategy = Strategy(strategy);
        pipeline.width = 160, pipeline.height = 120;
        const Capture gl = renderer.draw(pipeline).capture;
        const Frame ours = render_frame(prepared, pipeline, {}, aovs);
        const Image &ids = ours.aovs[0].image, &gl_ids = *gl.plane("id.object");
        int covered = 0, far = 0;
        for (int y = 0; y < pipeline.height; ++y)
          for (int x = 0; x < pipeline.width; ++x) {
            if (ids.value(x, y, 0) != gl_ids.value(x, y, 0) || ids.value(x, y, 0) == 0) continue;
            ++covered;
            double worst = 0;
            for (int k = 0; k < 3; ++k)
              worst = std::max(worst, 255 * std::fabs(gl.color.value(x, y, k) - ours.color.value(x, y, k)));
            far += worst > 2.5 ? 1 : 0;
          }
        INFO(name << ", " << preset.name << ", " << kStrategyNames[strategy]);
        CAPTURE(covered, far);
        CHECK(covered > 5000);
        CHECK(far <= covered / 20);  // other texels: each is another normal; every channel of a wrong frame is off
      }
  }
}
