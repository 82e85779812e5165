#include "judge/legal/light_output.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace trueshade::oracle {

/// The pipeline by which a light's term is bounded. Outside forward strategies it has no extents: there a light's
/// fragments end where its geometry does, which is judged apart.
static Pipeline with_extents_of_draws(Pipeline pipeline) {
  if (!is_forward(pipeline.strategy)) pipeline.light_volumes = {};
  return pipeline;
}

LightOutputs::LightOutputs(const Scene& scene, const Pipeline& pipeline, const Profile& profile)
    : scene_(scene), profile_(profile), program_(scene, with_extents_of_draws(pipeline), profile.arithmetic) {}

LightOutput LightOutputs::term(const ShadedSurface& surface, uint32_t light) const {
  return output(surface, alone(surface, light));
}

LitRange LightOutputs::alone(const ShadedSurface& surface, uint32_t light) const {
  ProgramBounds::Registers registers;
  return program_.alone(surface, light, !discards_beyond_extent(), registers);
}

void LightOutputs::terms(const ShadedSurface& surface, std::span<const uint32_t> lights, ProgramBounds::Block& block,
                         LitApart& lit) const {
  program_.apart(surface, lights, !discards_beyond_extent(), block, lit);
}

LightOutput LightOutputs::first(const ShadedSurface& surface) const {
  ProgramBounds::Registers registers;
  constexpr uint32_t kFirst[] = {0};
  return output(surface, program_.at(surface, kFirst, registers));
}
LightOutput LightOutputs::start(const ShadedSurface& surface) const {
  ProgramBounds::Registers registers;
  return output(surface, program_.at(surface, {}, registers));
}

bool are_numbers(const std::array<Range, 4>& color) {
  return std::none_of(color.begin(), color.end(),
                      [](const Range& r) { return std::isnan(r.value) || std::isnan(r.low) || std::isnan(r.high); });
}

LightOutput LightOutputs::of_color(const ShadedSurface& surface, const Bounded3& color) const {
  LitRange lit;
  lit.color = color;
  return output(surface, lit);
}

LightOutput LightOutputs::output(const ShadedSurface& surface, LitRange lit) const {
  ProgramBounds::Registers registers;
  return output_of(program_, surface, std::move(lit), registers);
}

LightOutput output_of(const ProgramBounds& program, const ShadedSurface& surface, LitRange lit,
                      ProgramBounds::Registers& registers) {
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

LightOutputs::InRange LightOutputs::in_range(const ShadedSurface& surface, uint32_t which) const {
  const Light& light = scene_.lights[which];
  const Arithmetic& a = profile_.arithmetic;
  Bounded3 offset;
  for (size_t k = 0; k < 3; ++k) offset[k] = difference(a, {double(light.position[int(k)]), 0}, surface.position[k]);
  const Bounded d = square_root(a, dot(a, offset, offset));
  const auto range = double(light.range);
  return {d.high() < range, d.low() < range, d.value < range};
}

static bool adds(const Bounded3& color) {
  return std::any_of(color.begin(), color.end(), [](const Bounded& c) { return c.value != 0; });
}

LightOutputs::Lit LightOutputs::lit(const ShadedSurface& surface, uint32_t light) const {
  const LitRange one = alone(surface, light);
  return {one.lights_low > 0 && (adds(one.color) || program_.is_users()), one.lights_high > 0};
}

LightOutputs::Lit LightOutputs::lit(const LitApart& terms, size_t j) const {
  return {terms.surely_counts[j] != 0 && (adds(terms.color[j]) || program_.is_users()), terms.may_count[j] != 0};
}

}  // namespace trueshade::oracle
