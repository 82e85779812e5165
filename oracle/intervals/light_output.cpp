#include "oracle/intervals/light_output.h"

#include <cmath>

#include "oracle/intervals/captured_surface.h"
#include "oracle/scalar_renderer.h"

namespace trueshade::oracle {

LightOutputs::LightOutputs(const Scene& scene, const Pipeline& pipeline, const Profile& profile)
    : pipeline_(pipeline), profile_(profile), alone_(pipeline.light_model) {
  scene_.camera = dark_.camera = scene.camera;
  alone_.emission = false;
  alone_.global_ambient = glm::vec3(0.0f);
  if (is_forward(pipeline.strategy)) limits_ = pipeline.light_volumes;  // else a light's fragments end where it does
  view_axis_ = view_axis(projection_of(scene.camera, pipeline.geometry, pipeline.width, pipeline.height));
  start_.emplace(bounds(dark_, pipeline.light_model));
}

void LightOutputs::set_light(const Light& light) {
  scene_.lights.assign(1, light);
  term_.emplace(bounds(scene_, alone_));
  first_.emplace(bounds(scene_, pipeline_.light_model));
}

LightBounds LightOutputs::bounds(const Scene& scene, const LightModel& model) const {
  return {scene, model, view_axis_, profile_.arithmetic, profile_.exact_planes, limits_};
}

LightOutput LightOutputs::term(const ShadedSurface& surface) const { return output(surface, *term_); }
LightOutput LightOutputs::first(const ShadedSurface& surface) const { return output(surface, *first_); }
LightOutput LightOutputs::start(const ShadedSurface& surface) const { return output(surface, *start_); }

LightOutput LightOutputs::output(const ShadedSurface& surface, const LightBounds& bounds) const {
  const LightModel& model = pipeline_.light_model;
  const LitRange lit = bounds.one_by_one(surface);
  LightOutput out;
  out.undefined = lit.undefined;
  out.either_way = !lit.branches.empty();
  for (size_t k = 0; k < 3; ++k) {
    Bounded c = lit.color[k];
    out.nominal[k] = output_range(model, c);
    for (const OtherBranch& branch : lit.branches) c.value += branch.change[k];
    out.other[k] = output_range(model, c);
  }
  out.nominal[3] = out.other[3] = output_range(model, model.alpha_from_albedo ? surface.albedo[3] : Bounded{1, 0});
  return out;
}

LightOutputs::InRange LightOutputs::in_range(const ShadedSurface& surface) const {
  const Light& light = scene_.lights.front();
  const Arithmetic& a = profile_.arithmetic;
  Bounded3 offset;
  for (size_t k = 0; k < 3; ++k) offset[k] = difference(a, {double(light.position[int(k)]), 0}, surface.position[k]);
  const Bounded d = square_root(a, dot(a, offset, offset));
  const auto range = double(light.range);
  return {d.high() < range, d.low() < range, d.value < range};
}

}  // namespace trueshade::oracle
