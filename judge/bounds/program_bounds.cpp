#include "judge/bounds/program_bounds.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <string_view>

#include "core/error.h"
#include "judge/bounds/program_total.h"
#include "programs/front/light_program.h"
#include "scenes/light_models/stated_model.h"
#include "scenes/pipeline/light_mesh.h"
#include "scenes/pipeline/program_inputs.h"

namespace trueshade::oracle {

namespace {

using programs::NodeId;
using programs::Op;
using programs::ProgramNode;
using programs::Rate;

/// A constant of the source. A compiler may have made it of others, in double or in floats: a part in 2^23, unless it
/// has so few digits that it was written down.
Interval constant_of(const ProgramNode& node) {
  if (node.type != programs::Type::f32)
    return Interval::of(node.type == programs::Type::i32 ? double(int32_t(node.bits)) : double(node.bits));
  const auto x = double(std::bit_cast<float>(node.bits));
  return (node.bits & 0xFFF) == 0 || !std::isfinite(x) ? Interval::of(x) : Interval::rounded_once(x);
}

}  // namespace

Pipeline with_planes_that_program_reads(const Pipeline& pipeline) {
  const LightProgram& given = pipeline.light_program;
  if (!given.used()) return pipeline;
  std::vector<std::string> inputs;
  for (const programs::ProgramInput& input : programs::kept_program(given.file, given.text)->inputs)
    inputs.push_back(input.name);
  return with_planes_of(pipeline, program_reads(given.file, inputs));
}

/// The pipeline's own, or its light model's, as other renderers have it too.
static std::shared_ptr<const programs::Program> program_judged(const Pipeline& pipeline) {
  const LightProgram& given = pipeline.light_program;
  const LightProgram light =
      given.used() ? given : program_of(pipeline.light_model, "light_model", Spelling::as_renderers_write);
  return programs::kept_program(light.file, light.text);
}

ProgramBounds::ProgramBounds(const Scene& scene, const Pipeline& pipeline, const Arithmetic& arithmetic)
    : ProgramBounds(scene, pipeline, arithmetic, *program_judged(pipeline)) {}

ProgramBounds::ProgramBounds(const Scene& scene, const Pipeline& pipeline, const Arithmetic& arithmetic,
                             programs::Program program)
    : ProgramBounds(scene, pipeline, arithmetic, std::move(program), pipeline.light_program.used()) {}

ProgramBounds::ProgramBounds(const Scene& scene, const Pipeline& pipeline, const Arithmetic& arithmetic,
                             programs::Program program, bool is_users)
    : scene_(scene),
      arithmetic_(arithmetic),
      of_(arithmetic),
      program_(std::move(program)),
      volumes_(pipeline.light_volumes),
      alpha_from_albedo_(pipeline.light_model.alpha_from_albedo),
      is_users_(is_users) {
  make_steps();
  set_constants(scene, pipeline);
  set_lights();
}

void ProgramBounds::set_constants(const Scene& scene, const Pipeline& pipeline) {
  constant_values_.resize(
      std::max<size_t>(1, slots_[size_t(Rate::constant)]));  // operands that are none read the first
  for (NodeId id = 0; id < program_.nodes.size(); ++id) {
    const ProgramNode& node = program_.nodes[id];
    if (node.rate != Rate::constant) continue;
    if (node.op == Op::constant) constant_values_[place_[id].slot] = constant_of(node);
    if (node.op == Op::input)
      constant_values_[place_[id].slot] = frame_field(program_.inputs[node.bits].name, scene, pipeline);
  }
  std::vector<Interval> terms;
  run(constants_, constant_values_, {constant_values_.data()}, terms);
}

void ProgramBounds::set_lights() {
  std::vector<Interval> terms;
  constexpr uint64_t kMost = uint64_t(1) << 24;  // half a GiB
  if (uint64_t(light_slots_read_) * scene_.lights.size() > kMost)
    throw Error(ErrorKind::limit, program_.name, "makes too many values of lights alone for so many lights",
                "judge it under fewer lights");
  std::vector<Interval> values(slots_[size_t(Rate::light)] + 1);
  light_values_.resize(light_slots_read_ * scene_.lights.size() + 1);
  for (uint32_t i = 0; i < scene_.lights.size(); ++i) {
    for (NodeId id = 0; id < program_.nodes.size(); ++id) {
      const ProgramNode& node = program_.nodes[id];
      if (node.op == Op::input && node.rate == Rate::light)
        values[place_[id].slot] = light_field(program_.inputs[node.bits].name).at(scene_.lights[i], i);
    }
    run(of_lights_, values, {constant_values_.data(), values.data()}, terms);
    std::copy_n(values.begin(), light_slots_read_, &light_values_[size_t(i) * light_slots_read_]);
  }
}

ProgramBounds::Values ProgramBounds::values_of(const Registers& r) const {
  Values values{};
  for (size_t rate = 0; rate < values.size(); ++rate) values[rate] = r.of[rate].data();
  values[size_t(Rate::constant)] = constant_values_.data();
  values[size_t(Rate::light)] = values_of_light(r.light);
  return values;
}

Interval ProgramBounds::evaluated(const Step& step, const Values& values, std::vector<Interval>& terms) const {
  const auto at = [&](const Place& p) -> const Interval& { return values[p.rate][p.slot]; };
  if (step.terms > 0) {
    terms.clear();
    for (uint32_t i = 0; i < step.terms; ++i) {
      const ProgramTerm& term = terms_[step.first_term + i];
      const Interval& x = at(term.from);
      terms.push_back(term.negated ? Interval{-x.value, -x.high, -x.low, x.maybe_nan} : x);
    }
    double other = 0;
    for (uint32_t i = 0; i < step.mixes; ++i) {
      const ProgramMix& mix = mixes_[step.first_mix + i];
      other += 2 * arithmetic_.roundoff * at(mix.a).size() * (at(mix.x).size() + at(mix.y).size());
    }
    return of_.sum(terms, other);
  }
  if (step.squares) return of_.square(at(step.from[0]));
  if (step.of_itself) {
    const bool nan = at(step.from[0]).maybe_nan, holds = step.node.op == Op::f_eq || step.node.op == Op::f_le;
    const bool same = step.node.op == Op::f_lt ? false : holds;
    return {same ? 1.0 : 0.0, same && !nan ? 1.0 : 0.0, same || (nan && step.node.op == Op::f_ne) ? 1.0 : 0.0, false};
  }
  Interval out = of_(step.node, at(step.from[0]), at(step.from[1]), at(step.from[2]));
  if (step.chained) out = of_.reordered(out);
  if (step.of_unit_vector && !out.maybe_nan) {  // however far the vector is off: |v_k| <= |v|, and some roundings
    const double most = largest_of_unit(arithmetic_);
    out.low = std::clamp(out.low, -most, most), out.high = std::clamp(out.high, -most, most);
  }
  if (step.normalizes && arithmetic_.wgsl) out = of_.normalizing(out);
  if (step.normalizes && !arithmetic_.exact_pow && !at(step.from[0]).is_true()) out.maybe_nan = true;
  return out;
}

void ProgramBounds::run(std::span<const Step> steps, std::vector<Interval>& out, const Values& values,
                        std::vector<Interval>& terms) const {
  for (const Step& step : steps) out[step.slot] = evaluated(step, values, terms);
}

/// Evaluates steps of one surface and one light.
///   follow: a comparison that may go either way takes the result that r.decided says, or is added to r.open
void ProgramBounds::run_pair(std::span<const Step> steps, Registers& r, bool follow) const {
  const Values values = values_of(r);
  std::vector<Interval>& out = r.of[size_t(Rate::pair)];
  for (const Step& step : steps) {
    Interval& x = out[step.slot];
    x = evaluated(step, values, r.terms);
    if (!follow || info(step.node.op).result != programs::Type::boolean || step.node.op == Op::select || x.known())
      continue;
    if (step.node.op >= Op::b_and && step.node.op <= Op::b_not) continue;  // of comparisons, which are open
    if (r.decided[step.slot] >= 0)
      x = Interval::of(r.decided[step.slot]);
    else
      r.open.push_back(step.slot);
  }
}

const Interval& ProgramBounds::output(int number, const Values& values) const {
  const Place& place = place_[program_.output[size_t(number)]];
  return values[place.rate][place.slot];
}

ProgramBounds::Outcome ProgramBounds::outcome(Registers& r) const {
  const Values values = values_of(r);
  return {output(programs::kLightOutput, values), output(programs::kLightOutput + 1, values),
          output(programs::kLightOutput + 2, values)};
}

/// What one light may add: one result for each way that its open comparisons may go.
std::vector<ProgramBounds::Outcome> ProgramBounds::outcomes(Registers& r, size_t& nominal, Interval& counted) const {
  nominal = 0;
  r.open.clear();
  run_pair(of_pairs_, r, true);
  std::vector<Outcome> out{outcome(r)};
  run_pair(of_reaches_, r, false);
  counted = output(programs::kReachesOutput, values_of(r));
  const std::vector<uint32_t> open = r.open;
  if (open.empty() || open.size() > kMostForks) return out;
  out.clear();
  for (size_t i = 0; i < open.size(); ++i)
    if (r.of[size_t(Rate::pair)][open[i]].value != 0) nominal |= size_t(1) << i;
  for (size_t set = 0; set < size_t(1) << open.size(); ++set) {
    for (size_t i = 0; i < open.size(); ++i) r.decided[open[i]] = int8_t(set >> i & 1);
    run_pair(of_pairs_, r, true);
    out.push_back(outcome(r));
    run_pair(of_reaches_, r, false);
    counted = hull(counted, output(programs::kReachesOutput, values_of(r)));
  }
  for (const uint32_t slot : open) r.decided[slot] = -1;
  return out;
}

/// Whether the light reaches the surface: by its range where the pipeline gives it an extent, else surely.
ProgramBounds::Reach ProgramBounds::reach_of(const Light& light, const ShadedSurface& surface) const {
  if (drawn_extent(light, volumes_) == LightExtent::unbounded) return Reach::surely;
  Bounded3 offset;
  for (size_t k = 0; k < 3; ++k)
    offset[k] = difference(arithmetic_, {double(light.position[int(k)]), 0}, surface.position[k]);
  const Bounded d = square_root(arithmetic_, dot(arithmetic_, offset, offset));
  const auto range = double(light.range);
  if (d.low() >= range) return Reach::none;
  if (d.high() < range) return Reach::surely;
  return d.value < range ? Reach::perhaps : Reach::perhaps_not_nominally;
}

bool ProgramBounds::reads(std::string_view field) const {
  return std::any_of(program_.inputs.begin(), program_.inputs.end(),
                     [field](const programs::ProgramInput& input) { return input.name.starts_with(field); });
}

bool ProgramBounds::is_unlit(const ShadedSurface& s) const {
  return is_users_ && s.material > 0 && s.material <= scene_.materials.size() && scene_.materials[s.material - 1].unlit;
}

void ProgramBounds::look_at(const ShadedSurface& surface, Registers& r) const {
  for (size_t rate = 0; rate < r.of.size(); ++rate) r.of[rate].resize(slots_[rate]);
  r.light = 0;  // another's, perhaps, of more lights
  r.decided.resize(slots_[size_t(Rate::pair)], -1);
  std::vector<Interval>& own = r.of[size_t(Rate::surface)];
  for (const auto& [slot, field] : surface_inputs_) own[slot] = field.at(surface);
  run(of_surfaces_, own, values_of(r), r.terms);
}

/// Adds what one light may add to a surface, and counts it. Call look_at() of the surface before.
///   ends: the light ends at its extent
void ProgramBounds::add(const ShadedSurface& surface, uint32_t light, bool ends, Registers& r,
                        ProgramTotal& total) const {
  const Reach reach = ends ? reach_of(scene_.lights[light], surface) : Reach::surely;
  if (reach == Reach::none) return;
  r.light = light;
  size_t nominal = 0;
  Interval counted;
  const std::vector<Outcome> all = outcomes(r, nominal, counted);
  if (reach == Reach::surely && counted.is_true()) ++total.lit.lights_low;
  if (!counted.is_false()) ++total.lit.lights_high;
  const bool is_in = reach != Reach::perhaps_not_nominally;
  total.add(all, is_in ? std::optional(nominal) : std::nullopt, reach == Reach::perhaps);
}

LitRange ProgramBounds::at(const ShadedSurface& surface, std::span<const uint32_t> lights, Registers& r) const {
  look_at(surface, r);
  ProgramTotal total;
  if (is_unlit(surface)) return total.lit;
  for (size_t k = 0; k < 3; ++k) total.start(k, output(programs::kStartOutput + int(k), values_of(r)));
  for (const uint32_t light : lights) add(surface, light, true, r, total);
  return total.finished(arithmetic_.roundoff);
}

LitRange ProgramBounds::alone(const ShadedSurface& surface, uint32_t light, bool ends, Registers& r) const {
  look_at(surface, r);
  ProgramTotal total;
  if (!is_unlit(surface)) add(surface, light, ends, r, total);
  return total.lit;
}

ProgramBounds::Finished ProgramBounds::finished(const ShadedSurface& surface, const Bounded3& sum, Registers& r) const {
  Finished out;
  if (is_unlit(surface)) {
    out.color = surface.albedo;
    return out;
  }
  if (program_.defines_finish) look_at(surface, r);
  std::vector<Interval>& own = r.of[size_t(Rate::sum)];
  own.resize(slots_[size_t(Rate::sum)]);
  for (const auto& [slot, channel] : sum_inputs_) own[slot] = interval_of(sum[channel]);
  const Values values = values_of(r);
  run(of_sums_, own, values, r.terms);
  for (size_t k = 0; k < 4; ++k) {
    const Interval& x = output(programs::kFinishOutput + int(k), values);
    out.color[k] = bounded_of(x);
    out.undefined = out.undefined || x.maybe_nan || !std::isfinite(out.color[k].error);
  }
  if (!program_.defines_finish && alpha_from_albedo_) out.color[3] = surface.albedo[3];
  return out;
}

}  // namespace trueshade::oracle
