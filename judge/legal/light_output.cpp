#include "judge/legal/light_output.h"

#include <algorithm>
#include <cmath>

#include "oracle/scalar_renderer.h"

namespace trueshade::oracle {

Range output_range(const LightModel& model, const Bounded& value) {
  const Range r = range_of(value);
  if (!model.clamp_result) return r;
  return {std::clamp(r.value, 0.0, 1.0), std::clamp(r.low, 0.0, 1.0), std::clamp(r.high, 0.0, 1.0)};
}

LightOutputs::LightOutputs(const Scene& scene, const Pipeline& pipeline, const Profile& profile)
    : pipeline_(pipeline), profile_(profile) {
  scene_.camera = dark_.camera = scene.camera;
  if (is_forward(pipeline.strategy)) limits_ = pipeline.light_volumes;  // else a light's fragments end where it does
  view_axis_ = view_axis(projection_of(scene.camera, pipeline.geometry, pipeline.width, pipeline.height));
  start_.emplace(bounds(dark_));
}

void LightOutputs::set_lights(std::span<const Light> lights) {
  scene_.lights.assign(lights.begin(), lights.end());
  lights_.emplace(bounds(scene_));
}

LightBounds LightOutputs::bounds(const Scene& scene) const {
  return {scene, pipeline_.light_model, view_axis_, profile_.arithmetic, profile_.exact_planes, limits_};
}

LightOutput LightOutputs::term(const ShadedSurface& surface, uint32_t light) const {
  return output(surface, lights_->alone(surface, light));
}
LightOutput LightOutputs::first(const ShadedSurface& surface) const {
  return output(surface, lights_->one_by_one(surface));
}
LightOutput LightOutputs::start(const ShadedSurface& surface) const {
  return output(surface, start_->one_by_one(surface));
}

bool are_numbers(const std::array<Range, 4>& color) {
  return std::none_of(color.begin(), color.end(),
                      [](const Range& r) { return std::isnan(r.value) || std::isnan(r.low) || std::isnan(r.high); });
}

LightOutput LightOutputs::of_color(const ShadedSurface& surface, const Bounded3& color) const {
  LightOutput out;
  for (size_t k = 0; k < 3; ++k) out.nominal[k] = output_range(pipeline_.light_model, color[k]);
  out.nominal[3] = alpha(surface);
  out.undefined = !are_numbers(out.nominal);
  return out;
}

Range LightOutputs::alpha(const ShadedSurface& surface) const {
  const LightModel& model = pipeline_.light_model;
  return output_range(model, model.alpha_from_albedo ? surface.albedo[3] : Bounded{1, 0});
}

LightOutput LightOutputs::output(const ShadedSurface& surface, const LitRange& lit) const {
  const LightModel& model = pipeline_.light_model;
  LightOutput out;
  out.either_way = !lit.branches.empty();
  for (size_t k = 0; k < 3; ++k) {
    Bounded c = lit.color[k];
    out.nominal[k] = output_range(model, c);
    for (const OtherBranch& branch : lit.branches) c.value += branch.change[k];
    out.other[k] = output_range(model, c);
  }
  out.nominal[3] = out.other[3] = alpha(surface);
  out.undefined = lit.undefined || !are_numbers(out.nominal) || !are_numbers(out.other);
  return out;
}

LightOutputs::InRange LightOutputs::in_range(const ShadedSurface& surface, uint32_t which) const {
  const Light& light = scene_.lights[which];
  const Arithmetic& a = profile_.arithmetic;
  Bounded3 offset;
  for (size_t k = 0; k < 3; ++k) offset[k] = difference(a, {double(light.position[int(k)]), 0}, surface.position[k]);
  const Bounded d = square_root(a, dot(a, offset, offset));
  const auto range = double(light.range);
  return {d.high() < range, d.low() < range, d.value < range};
}

LightOutputs::Lit LightOutputs::lit(const ShadedSurface& surface, uint32_t light) const {
  const LitRange one = lights_->alone(surface, light);
  const bool adds = std::any_of(one.color.begin(), one.color.end(), [](const Bounded& c) { return c.value != 0; });
  return {one.lights_low > 0 && adds, one.lights_high > 0};
}

}  // namespace trueshade::oracle
