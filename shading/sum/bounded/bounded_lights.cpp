#include "shading/sum/bounded/bounded_lights.h"

#include <algorithm>
#include <cstring>
#include <limits>

#include "shading/light/lists/light_clusters.h"

namespace trueshade {
namespace {

bool within(float x, float most) { return x >= 0.0f && x <= most; }

bool in_proof_range(const LightRow& row) {
  bool holds = row.kind == LightKind::point && row.cut2 == std::numeric_limits<float>::infinity() &&
               within(row.k1, kMostProvenFalloff) && within(row.k2, kMostProvenFalloff);
  for (int c = 0; c < 3; ++c)
    holds = holds && coordinate_in_proof_range(row.position[c]) && within(row.color[c], kMostProvenColor);
  return holds;
}

bool starts_in_proof_range(const LightModel& model, const LightTable& lights) {
  bool holds = !model.emission && model.global_ambient == glm::vec3(0.0f);
  for (int c = 0; c < 3; ++c)
    holds = holds && within(model.specular_color[c], kMostProvenAlbedo) && coordinate_in_proof_range(lights.eye[c]);
  return holds;
}

void make_window_lights(const LightTable& lights, BoundedLights& out) {
  for (const LightRow& row : lights.row)
    for (int c = 0; c < 3; ++c) {
      const bool has_position = row.kind != LightKind::other;
      if (!within(row.color[c], kMostWindowColor) || (has_position && !coordinate_in_proof_range(row.position[c])))
        return;
      out.most_color = std::max(out.most_color, row.color[c]);
    }
  out.window.resize(lights.size() + 1);
  for (size_t i = 0; i < lights.size(); ++i) {
    const LightRow& row = lights.row[i];
    WindowLight& light = out.window[i];
    for (int c = 0; c < 3; ++c) light.position[c] = row.position[c], light.color[c] = row.color[c];
    light.cut2 = row.cut2, light.half_share = 0.5f / row.range;
  }
}

}  // namespace

BoundedLights make_bounded_lights(const LightTable& lights, const LightModel& model) {
  BoundedLights out;
  const size_t count = lights.size();
  constexpr size_t kFewest = 32, kMost = 16384;  // fewer are as soon added up; of more hardly a sum would be proved
  const LightShape shape = shape_with_power(model);
  if (count > kMost || !starts_in_proof_range(model, lights)) return out;
  if (shape == WindowBlinn::shape && count < LightClusters::kFewest) make_window_lights(lights, out);
  if (count < kFewest || shape != QuadraticBlinn::shape) return out;
  if (!std::all_of(lights.row.begin(), lights.row.end(), in_proof_range)) return out;
  out.quadratic.reserve(count);
  const size_t padded = lights.cut2.size();
  for (auto* stream : {&out.k1, &out.k2, &out.strongest}) stream->resize(padded, 0.0f);
  for (size_t i = 0; i < count; ++i) {
    const LightRow& r = lights.row[i];
    out.quadratic.push_back(
        {{r.position[0], r.position[1], r.position[2]}, r.k1, r.k2, {r.color[0], r.color[1], r.color[2]}});
    out.k1[i] = r.k1, out.k2[i] = r.k2;
    out.strongest[i] = *std::max_element(r.color, r.color + 3);
  }
  out.relative = (float(count + count / kSumPart + kSumPart) * 1.02f + 160.0f) * 0x1p-24f;
  return out;
}

const BoundedLights& kept_bounded_lights(const LightTable& lights, const LightModel& model) {
  struct Kept {
    BoundedLights lights;
    uint64_t version = 0;  // of the table; it differs between models too
    float eye[3];
  };
  thread_local Kept kept;
  if (kept.version == 0 || kept.version != lights.version || std::memcmp(kept.eye, lights.eye, sizeof kept.eye) != 0) {
    kept.lights = make_bounded_lights(lights, model);
    kept.version = lights.version;
    std::copy_n(lights.eye, 3, kept.eye);
  }
  return kept.lights;
}

}  // namespace trueshade
