#include "shading/light/bounded/bounded_lights.h"

#include <algorithm>
#include <limits>

#include "shading/light/lists/light_clusters.h"

namespace trueshade {
namespace {

bool within(float x, float most) { return x >= 0.0f && x <= most; }

bool is_plain(const LightRow& row) {
  bool plain = row.kind == LightKind::placed && row.cut2 == std::numeric_limits<float>::infinity() &&
               within(row.k1, kMostPlainFalloff) && within(row.k2, kMostPlainFalloff);
  for (int c = 0; c < 3; ++c) plain = plain && plain_place(row.position[c]) && within(row.color[c], kMostPlainColor);
  return plain;
}

bool starts_plain(const LightModel& model, const LightTable& lights) {
  bool plain = !model.emission && model.global_ambient == glm::vec3(0.0f);
  for (int c = 0; c < 3; ++c)
    plain = plain && within(model.specular_color[c], kMostPlainAlbedo) && plain_place(lights.eye[c]);
  return plain;
}

void make_window_lights(const LightTable& lights, PlainLights& out) {
  for (const LightRow& row : lights.row)
    for (int c = 0; c < 3; ++c) {
      const bool placed = row.kind != LightKind::other;
      if (!within(row.color[c], kMostWindowColor) || (placed && !plain_place(row.position[c]))) return;
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

void make_plain_lights(const LightTable& lights, const LightModel& model, PlainLights& out) {
  for (auto* stream : {&out.k1, &out.k2, &out.strongest}) stream->clear();
  out.light.clear(), out.window.clear();
  out.relative = out.most_color = 0.0f;
  const size_t count = lights.size();
  constexpr size_t kFewest = 32, kMost = 16384;  // fewer are as soon added up; of more hardly a sum would be settled
  const LightShape shape = shape_of(model, true);
  if (count > kMost || !starts_plain(model, lights)) return;
  if (is_window(shape) && count < LightGroups::kFewest) make_window_lights(lights, out);
  if (count < kFewest || !is_plain(shape)) return;
  for (const LightRow& row : lights.row)
    if (!is_plain(row)) return;
  out.light.reserve(count);
  const size_t padded = lights.cut2.size();
  for (auto* stream : {&out.k1, &out.k2, &out.strongest}) stream->resize(padded, 0.0f);
  for (size_t i = 0; i < count; ++i) {
    const LightRow& r = lights.row[i];
    out.light.push_back(
        {{r.position[0], r.position[1], r.position[2]}, r.k1, r.k2, {r.color[0], r.color[1], r.color[2]}});
    out.k1[i] = r.k1, out.k2[i] = r.k2;
    out.strongest[i] = *std::max_element(r.color, r.color + 3);
  }
  out.relative = (float(count + count / kPlainPart + kPlainPart) * 1.02f + 160.0f) * 0x1p-24f;
}

PlainLights make_plain_lights(const LightTable& lights, const LightModel& model) {
  PlainLights out;
  make_plain_lights(lights, model, out);
  return out;
}

}  // namespace trueshade
