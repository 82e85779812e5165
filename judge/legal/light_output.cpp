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
  if (pipeline.light_program.used())
    take_program(scene);
  else
    start_.emplace(bounds(dark_));
}

void LightOutputs::take_program(const Scene& scene) {
  all_.camera = scene.camera, all_.lights = scene.lights, all_.materials = scene.materials;
  program_.emplace(all_, pipeline_, profile_.arithmetic);
  Pipeline unbounded = pipeline_;
  unbounded.light_volumes.point = unbounded.light_volumes.spot = LightExtent::unbounded;
  programs::Program program = program_->program();
  const auto zero = programs::NodeId(program.nodes.size());
  program.nodes.push_back({programs::Op::constant, programs::Type::f32});
  for (int k = 0; k < 3; ++k) program.output[size_t(programs::kStartOutput + k)] = zero;
  apart_.emplace(all_, unbounded, profile_.arithmetic, std::move(program));
}

void LightOutputs::set_lights(std::span<const Light> lights, uint32_t first) {
  scene_.lights.assign(lights.begin(), lights.end());
  first_ = first;
  if (!program_) lights_.emplace(bounds(scene_));
}

LightBounds LightOutputs::bounds(const Scene& scene) const {
  return {scene, pipeline_.light_model, view_axis_, profile_.arithmetic, profile_.exact_planes, limits_};
}

LightOutput LightOutputs::term(const ShadedSurface& surface, uint32_t light) const {
  return output(surface, alone(surface, light));
}

LitRange LightOutputs::alone(const ShadedSurface& surface, uint32_t light) const {
  if (!program_) return lights_->alone(surface, light);
  ProgramBounds::Registers registers;
  light += first_;
  return apart_->at(surface, {&light, 1}, registers);
}

void LightOutputs::terms(const ShadedSurface& surface, std::span<const uint32_t> lights, LitApart& lit) const {
  if (!program_) return lights_->apart(surface, lights, lit);
  ProgramBounds::Registers registers;
  lit.color.resize(lights.size()), lit.one_outcome.resize(lights.size());
  for (size_t i = 0; i < lights.size(); ++i) {
    const uint32_t light = first_ + lights[i];
    const LitRange one = apart_->at(surface, {&light, 1}, registers);
    lit.color[i] = one.color, lit.one_outcome[i] = one.branches.empty() && !one.undefined;
  }
}

LightOutput LightOutputs::first(const ShadedSurface& surface) const {
  if (!program_) return output(surface, lights_->one_by_one(surface));
  ProgramBounds::Registers registers;
  return output(surface, program_->at(surface, {&first_, 1}, registers));
}
LightOutput LightOutputs::start(const ShadedSurface& surface) const {
  if (!program_) return output(surface, start_->one_by_one(surface));
  ProgramBounds::Registers registers;
  return output(surface, program_->at(surface, {}, registers));
}

bool are_numbers(const std::array<Range, 4>& color) {
  return std::none_of(color.begin(), color.end(),
                      [](const Range& r) { return std::isnan(r.value) || std::isnan(r.low) || std::isnan(r.high); });
}

LightOutput LightOutputs::of_color(const ShadedSurface& surface, const Bounded3& color) const {
  LightOutput out;
  if (program_) {
    LitRange lit;
    lit.color = color;
    return output(surface, lit);
  }
  for (size_t k = 0; k < 3; ++k) out.nominal[k] = output_range(pipeline_.light_model, color[k]);
  out.nominal[3] = alpha(surface);
  out.undefined = !are_numbers(out.nominal);
  return out;
}

Range LightOutputs::alpha(const ShadedSurface& surface) const {
  const LightModel& model = pipeline_.light_model;
  return output_range(model, model.alpha_from_albedo ? surface.albedo[3] : Bounded{1, 0});
}

/// Whichever way the program's comparisons go, what it may make of the sum is one set.
static LightOutput output_by_program(const ProgramBounds& program, const ShadedSurface& surface, LitRange lit) {
  ProgramBounds::Registers registers;
  LightOutput out;
  out.either_way = !lit.branches.empty();
  const ProgramBounds::Finished nominal = program.finished(surface, lit.color, registers);
  for (const OtherBranch& branch : lit.branches)
    for (size_t k = 0; k < 3; ++k) lit.color[k].error += std::fabs(branch.change[k]);
  const ProgramBounds::Finished all = program.finished(surface, lit.color, registers);
  for (size_t k = 0; k < 4; ++k) out.nominal[k] = range_of(nominal.color[k]), out.other[k] = range_of(all.color[k]);
  out.undefined =
      lit.undefined || nominal.undefined || all.undefined || !are_numbers(out.nominal) || !are_numbers(out.other);
  return out;
}

LightOutput LightOutputs::output(const ShadedSurface& surface, const LitRange& lit) const {
  const LightModel& model = pipeline_.light_model;
  LightOutput out;
  if (program_) return output_by_program(*program_, surface, lit);
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
  const LitRange one = alone(surface, light);
  const bool adds = std::any_of(one.color.begin(), one.color.end(), [](const Bounded& c) { return c.value != 0; });
  return {one.lights_low > 0 && (adds || program_), one.lights_high > 0};
}

}  // namespace trueshade::oracle
