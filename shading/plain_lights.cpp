#include "shading/plain_lights.h"

#include <algorithm>
#include <limits>

namespace trueshade {
namespace {

bool within(float x, float most) { return x >= 0.0f && x <= most; }

bool is_plain(const LightRow& row) {
  bool plain = row.kind == LightKind::placed && row.cut2 == std::numeric_limits<float>::infinity() &&
               within(row.k1, kMostPlainFalloff) && within(row.k2, kMostPlainFalloff);
  for (int c = 0; c < 3; ++c) plain = plain && plain_place(row.position[c]) && within(row.color[c], kMostPlainColor);
  return plain;
}

bool is_plain(const LightModel& model, const LightTable& lights) {
  bool plain = is_plain(shape_of(model, true)) && !model.emission && model.global_ambient == glm::vec3(0.0f);
  for (int c = 0; c < 3; ++c)
    plain = plain && within(model.specular_color[c], kMostPlainAlbedo) && plain_place(lights.eye[c]);
  return plain;
}

}  // namespace

PlainLights make_plain_lights(const LightTable& lights, const LightModel& model) {
  PlainLights out;
  const size_t count = lights.size();
  constexpr size_t kFewest = 32, kMost = 16384;  // fewer are as soon added up; of more hardly a sum would be settled
  if (count < kFewest || count > kMost || !is_plain(model, lights)) return out;
  for (const LightRow& row : lights.row)
    if (!is_plain(row)) return out;
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
  return out;
}

}  // namespace trueshade
