#include "judge/bounds/program_bounds.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <string_view>

#include "core/error.h"
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

constexpr size_t kMostTerms = 64;         // of a sum whose order is taken to be any, and how deep they may lie
constexpr size_t kMostLaneSlots = 16384;  // values of a surface or a pair, which are 1.5 KiB each in lanes

/// A constant of the source. A compiler may have made it of others, in double or in floats: a part in 2^23, unless it
/// has so few digits that it was written down.
Interval constant_of(const ProgramNode& node) {
  if (node.type != programs::Type::f32)
    return Interval::of(node.type == programs::Type::i32 ? double(int32_t(node.bits)) : double(node.bits));
  const auto x = double(std::bit_cast<float>(node.bits));
  return (node.bits & 0xFFF) == 0 || !std::isfinite(x) ? Interval::of(x) : Interval::rounded_once(x);
}

}  // namespace

/// The sum of what lights add, and the bound of docs/gl_rules.md section 6 on the roundings of its additions.
struct ProgramTotal {
  LitRange lit;
  std::array<double, 3> magnitude{};
  int added = 0;

  void start(size_t k, const Interval& x) {
    lit.color[k] = bounded_of(x);
    lit.undefined = lit.undefined || x.maybe_nan || !std::isfinite(lit.color[k].error);
    magnitude[k] = x.size();
    if (magnitude[k] > 0) added = 1;
  }

  /// nominal: the outcome of real arithmetic; nothing where a light that may reach the surface does not.
  void add(std::span<const std::array<Interval, 3>> outcomes, std::optional<size_t> nominal, bool perhaps_nothing) {
    std::array<Bounded, 3> chosen{};
    bool is_dark = true;  // adding a zero rounds nothing
    for (size_t k = 0; k < 3; ++k) {
      double largest = 0;
      for (const auto& one : outcomes) {
        const Bounded b = bounded_of(one[k]);
        lit.undefined = lit.undefined || one[k].maybe_nan || !std::isfinite(b.error);
        chosen[k].error = std::max(chosen[k].error, b.error), largest = std::max(largest, one[k].size());
      }
      if (nominal) chosen[k].value = outcomes[*nominal][k].value;
      lit.color[k].value += chosen[k].value, lit.color[k].error += chosen[k].error;
      magnitude[k] += largest;
      is_dark = is_dark && largest == 0;
    }
    added += !is_dark;
    for (size_t i = 0; i < outcomes.size(); ++i) {
      OtherBranch other;
      for (size_t k = 0; k < 3; ++k) other.change[k] = outcomes[i][k].value - chosen[k].value;
      if (i != nominal) add(other, chosen);
    }
    OtherBranch none;
    for (size_t k = 0; k < 3; ++k) none.change[k] = -chosen[k].value;
    if (perhaps_nothing && nominal) add(none, chosen);
  }

  /// Another result that the bound does not hold already.
  void add(const OtherBranch& other, const std::array<Bounded, 3>& chosen) {
    bool differs = false;
    for (size_t k = 0; k < 3; ++k) differs = differs || !(std::fabs(other.change[k]) <= chosen[k].error);
    if (!differs) {
      for (size_t k = 0; k < 3; ++k) lit.color[k].error += std::fabs(other.change[k]);
      return;
    }
    lit.branches.push_back(other);
  }

  void add(const ProgramBounds::BlockSum& sum) {
    added += sum.added;
    lit.lights_low = sum.lights_low, lit.lights_high = sum.lights_high;
    for (size_t k = 0; k < 3; ++k) {
      lit.color[k].value += sum.color[k].value, lit.color[k].error += sum.color[k].error;
      magnitude[k] += sum.magnitude[k];
    }
  }

  LitRange finished(double roundoff) {
    for (size_t k = 0; k < 3 && added > 1; ++k)
      lit.color[k].error += (added - 1) * roundoff * (magnitude[k] + lit.color[k].error);
    return std::move(lit);
  }
};

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

/// The terms of a sum: through sums that the compiler may take apart.
std::vector<ProgramBounds::SumTerm> ProgramBounds::terms_of(NodeId id) const {
  std::vector<SumTerm> out;
  size_t visits = 0;
  gather(id, false, out, 0, visits);
  return out;
}

void ProgramBounds::gather(NodeId id, bool negated, std::vector<SumTerm>& out, size_t depth, size_t& visits) const {
  const ProgramNode& node = program_.nodes[id];
  const bool is_sum = node.op == Op::f_add || node.op == Op::f_sub;
  const bool is_apart = (is_sum || node.op == Op::f_neg) && !node.precise && depth < kMostTerms;
  if (!is_apart || ++visits > 4 * kMostTerms) return out.emplace_back(id, negated), void();
  const size_t before = out.size();
  gather(node.operand[0], node.op == Op::f_neg ? !negated : negated, out, depth + 1, visits);
  if (is_sum) gather(node.operand[1], node.op == Op::f_sub ? !negated : negated, out, depth + 1, visits);
  if (out.size() <= kMostTerms) return;
  out.resize(before);
  out.emplace_back(id, negated);
}

/// The sums that terms_of() takes apart are mixed as they stand.
void ProgramBounds::find_mixes(NodeId id, size_t depth, size_t& visits, std::vector<ProgramMix>& out) const {
  const ProgramNode& node = program_.nodes[id];
  const bool is_sum = node.op == Op::f_add || node.op == Op::f_sub;
  if ((!is_sum && node.op != Op::f_neg) || node.precise || depth >= kMostTerms || ++visits > 4 * kMostTerms) return;
  const auto at = [&](NodeId n) -> const ProgramNode& { return program_.nodes[n]; };
  const auto is_one = [&](NodeId n) { return at(n).op == Op::constant && at(n).bits == std::bit_cast<uint32_t>(1.0f); };
  for (size_t i = 0; i < 2 && node.op == Op::f_add; ++i) {
    const ProgramNode &first = at(node.operand[i]), &second = at(node.operand[1 - i]);
    if (first.op != Op::f_mul || second.op != Op::f_mul) continue;
    for (const size_t j : {0, 1}) {
      const ProgramNode& rest = at(first.operand[j]);
      if (rest.op != Op::f_sub || !is_one(rest.operand[0])) continue;
      for (const size_t k : {0, 1})
        if (second.operand[k] == rest.operand[1])
          out.push_back({place_[first.operand[1 - j]], place_[second.operand[1 - k]], place_[rest.operand[1]]});
    }
  }
  for (const NodeId operand : node.operands()) find_mixes(operand, depth + 1, visits, out);
}

/// normalize() as the front end composes it: a component times (0 < l2 ? inversesqrt(l2) : 0), where l2 is a sum that
/// has the component's square.
bool ProgramBounds::is_unit_component(const ProgramNode& product) const {
  for (const size_t i : {0, 1}) {
    NodeId root = product.operand[i];
    if (program_.nodes[root].op == Op::select) {
      const ProgramNode& otherwise = program_.nodes[program_.nodes[root].operand[2]];
      if (otherwise.op != Op::constant || otherwise.bits != 0) continue;
      root = program_.nodes[root].operand[1];
    }
    const ProgramNode& inverse = program_.nodes[root];
    if (inverse.op != Op::f_inverse_sqrt) continue;
    const std::vector<SumTerm> terms = terms_of(inverse.operand[0]);
    for (const auto& [id, negated] : terms) {
      const ProgramNode& square = program_.nodes[id];
      const NodeId component = product.operand[1 - i];
      if (!negated && square.op == Op::f_mul && square.operand[0] == component && square.operand[1] == component)
        return std::all_of(terms.begin(), terms.end(), [&](const auto& t) {
          const ProgramNode& n = program_.nodes[t.first];
          return !t.second && n.op == Op::f_mul && n.operand[0] == n.operand[1];
        });
    }
  }
  return false;
}

void ProgramBounds::find_patterns(NodeId id, Step& step) {
  const ProgramNode& node = program_.nodes[id];
  const auto at = [&](NodeId n) -> const ProgramNode& { return program_.nodes[n]; };
  const auto is_number = [&](NodeId n, float x) {
    return at(n).op == Op::constant && at(n).bits == std::bit_cast<uint32_t>(x);
  };
  step.squares = node.op == Op::f_mul && node.operand[0] == node.operand[1];
  step.chained = node.op == Op::f_mul && !node.precise && !step.squares &&
                 (at(node.operand[0]).op == Op::f_mul || at(node.operand[1]).op == Op::f_mul);
  step.of_itself = node.op >= Op::f_eq && node.op <= Op::f_le && node.operand[0] == node.operand[1];
  step.of_unit_vector = node.op == Op::f_mul && is_unit_component(node);
  step.normalizes =
      node.op == Op::select && at(node.operand[1]).op == Op::f_inverse_sqrt && is_number(node.operand[2], 0.0f);
  if (step.terms == 0) return;
  std::vector<ProgramMix> mixes;
  size_t visits = 0;
  find_mixes(id, 0, visits, mixes);
  step.first_mix = uint32_t(mixes_.size()), step.mixes = uint32_t(mixes.size());
  mixes_.insert(mixes_.end(), mixes.begin(), mixes.end());
}

/// Places for all nodes, and what is computed of them how often. Sums are computed of their terms, so a partial sum
/// that nothing else reads is not.
void ProgramBounds::make_steps() {
  const size_t count = program_.nodes.size();
  place_.resize(count);
  for (NodeId id = 0; id < count; ++id) {
    const auto rate = size_t(program_.nodes[id].rate);
    place_[id] = {uint8_t(rate), slots_[rate]++};
  }
  std::vector<std::vector<SumTerm>> terms(count);
  // 1: light() needs it; 2: reaches() alone; 3: start() or finish().
  std::vector<uint8_t> needed(count, 0);
  const auto mark = [&](int first, int end, uint8_t by) {
    for (int i = first; i < end; ++i)
      if (needed[program_.output[size_t(i)]] == 0) needed[program_.output[size_t(i)]] = by;
    for (NodeId id = NodeId(count); id-- > 0;) {
      if (needed[id] != by) continue;
      const ProgramNode& node = program_.nodes[id];
      const auto need = [&](NodeId from) {
        if (needed[from] == 0) needed[from] = by;
      };
      if ((node.op == Op::f_add || node.op == Op::f_sub) && !node.precise) {
        terms[id] = terms_of(id);
        for (const auto& [term, negated] : terms[id]) need(term);
        for (const NodeId operand : node.operands())
          if (terms[id].size() <= 1) need(operand);    // a sum of too many terms is taken as it stands
        for (const auto& [term, negated] : terms[id])  // mix() looks at what its products are made of
          if (program_.nodes[term].op == Op::f_mul)
            for (const NodeId factor : program_.nodes[term].operands()) {
              need(factor);
              if (program_.nodes[factor].op == Op::f_sub) need(program_.nodes[factor].operand[1]);
            }
      } else {
        for (const NodeId operand : node.operands()) need(operand);
      }
    }
  };
  mark(programs::kLightOutput, programs::kReachesOutput, 1);
  mark(programs::kReachesOutput, programs::kStartOutput, 2);
  mark(programs::kStartOutput, programs::kOutputCount, 3);
  for (NodeId id = 0; id < count; ++id) {
    const ProgramNode& node = program_.nodes[id];
    if (needed[id] == 0 || node.op == Op::constant) continue;
    if (node.op == Op::input) {
      if (node.rate == Rate::surface)
        surface_inputs_.emplace_back(place_[id].slot, surface_field(program_.inputs[node.bits].name));
      if (node.rate == Rate::sum)
        sum_inputs_.emplace_back(place_[id].slot, component_of(program_.inputs[node.bits].name));
      continue;
    }
    Step step;
    step.node = node, step.slot = place_[id].slot;
    for (size_t i = 0; i < node.operands().size(); ++i) step.from[i] = place_[node.operand[i]];
    if (terms[id].size() > 1) {
      step.first_term = uint32_t(terms_.size()), step.terms = uint32_t(terms[id].size());
      for (const auto& [term, negated] : terms[id]) terms_.push_back({place_[term], negated});
    }
    find_patterns(id, step);
    std::vector<Step>* const lists[] = {&constants_, &of_lights_, &of_surfaces_, &of_pairs_, &of_sums_};
    (node.rate == Rate::pair && needed[id] == 2 ? of_reaches_ : *lists[size_t(node.rate)]).push_back(step);
  }
  find_slots_read();
}

/// What of surfaces and of lights is read by what comes after them.
void ProgramBounds::find_slots_read() {
  std::array<std::vector<uint8_t>, programs::kRateCount> is_read;
  for (size_t rate = 0; rate < is_read.size(); ++rate) is_read[rate].resize(slots_[rate]);
  const auto read = [&](const Place& p) {
    if (p.slot < is_read[p.rate].size()) is_read[p.rate][p.slot] = 1;
  };
  for (const std::vector<Step>* steps : {&of_pairs_, &of_reaches_})
    for (const Step& step : *steps) std::for_each(step.from.begin(), step.from.end(), read);
  for (const ProgramTerm& term : terms_) read(term.from);
  for (const ProgramMix& mix : mixes_) read(mix.x), read(mix.y), read(mix.a);
  for (const NodeId id : program_.output) read(place_[id]);
  for (uint32_t slot = 0; slot < slots_[size_t(Rate::surface)]; ++slot)
    if (is_read[size_t(Rate::surface)][slot] != 0) surface_slots_read_.push_back(slot);
  renumber_light_slots(is_read[size_t(Rate::light)]);
}

/// Puts those that are read before the others, so that a scene of a million lights keeps no more of each.
void ProgramBounds::renumber_light_slots(const std::vector<uint8_t>& is_read) {
  std::vector<uint32_t> number(is_read.size());
  uint32_t next = 0;
  for (const bool reads : {true, false}) {
    for (size_t slot = 0; slot < number.size(); ++slot)
      if ((is_read[slot] != 0) == reads) number[slot] = next++;
    if (reads) light_slots_read_ = next;
  }
  const auto renumber = [&number](Place& p) {
    if (Rate(p.rate) == Rate::light && p.slot < number.size()) p.slot = number[p.slot];
  };
  std::for_each(place_.begin(), place_.end(), renumber);
  for (Step& step : of_lights_) step.slot = number[step.slot];
  for (std::vector<Step>* steps : {&constants_, &of_lights_, &of_surfaces_, &of_pairs_, &of_reaches_, &of_sums_})
    for (Step& step : *steps) std::for_each(step.from.begin(), step.from.end(), renumber);
  for (ProgramTerm& term : terms_) renumber(term.from);
  for (ProgramMix& mix : mixes_) renumber(mix.x), renumber(mix.y), renumber(mix.a);
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

/// follow: decisions are taken, and comparisons that may go either way become open.
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

Interval ProgramBounds::result(const ProgramLanes& lanes, int number, size_t lane) const {
  const Place& p = place_[program_.output[size_t(number)]];
  return lanes.lanes[p.rate] != nullptr ? lanes.lanes[p.rate][p.slot].at(lane) : lanes.one[p.rate][p.slot];
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

/// A light ends at its range where the pipeline gives it an extent.
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

/// One light's part of a sum. The surface has been looked at.
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

ProgramLanes ProgramBounds::lanes_of(std::span<const Step> steps, Rate rate, Block& block, uint32_t light,
                                     uint8_t* left) const {
  ProgramLanes lanes{steps, terms_, mixes_, {}, {}, block.of[size_t(rate)].data(), arithmetic_, left};
  lanes.one[size_t(Rate::constant)] = constant_values_.data();
  lanes.one[size_t(Rate::light)] = values_of_light(light);
  for (const Rate of : {Rate::surface, Rate::pair}) lanes.lanes[size_t(of)] = block.of[size_t(of)].data();
  return lanes;
}

/// Lights in the lanes, and one surface for all of them.
ProgramLanes ProgramBounds::lanes_of_lights(std::span<const Step> steps, Block& block, size_t count,
                                            uint8_t* left) const {
  ProgramLanes lanes{steps, terms_, mixes_, {}, {}, block.of[size_t(Rate::pair)].data(), arithmetic_, left, count};
  lanes.one[size_t(Rate::constant)] = constant_values_.data();
  lanes.one[size_t(Rate::surface)] = block.registers.of[size_t(Rate::surface)].data();
  for (const Rate of : {Rate::light, Rate::pair}) lanes.lanes[size_t(of)] = block.of[size_t(of)].data();
  return lanes;
}

/// At most kIntervalLanes. Lanes behind the last light repeat the first one.
void ProgramBounds::look_at(std::span<const uint32_t> lights, Block& block) const {
  for (const Rate rate : {Rate::light, Rate::pair}) block.of[size_t(rate)].resize(slots_[size_t(rate)] + 1);
  for (size_t i = 0; i < kIntervalLanes; ++i) {
    const Interval* const values = values_of_light(lights[i < lights.size() ? i : 0]);
    for (uint32_t slot = 0; slot < light_slots_read_; ++slot) block.of[size_t(Rate::light)][slot].set(i, values[slot]);
  }
}

bool ProgramBounds::suits_lanes() const {
  return slots_[size_t(Rate::surface)] + slots_[size_t(Rate::light)] + slots_[size_t(Rate::pair)] <= kMostLaneSlots;
}

/// Where some surfaces may be.
struct ProgramBounds::Box {
  std::array<double, 3> low{HUGE_VAL, HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};

  void add(const Bounded3& position) {
    for (size_t k = 0; k < 3; ++k) {
      const double least = position[k].low(), most = position[k].high();
      const bool is_known = std::isfinite(least) && std::isfinite(most);
      low[k] = is_known ? std::min(low[k], least) : -HUGE_VAL;
      high[k] = is_known ? std::max(high[k], most) : HUGE_VAL;
    }
  }
};

/// Whether the pipeline gives the light an extent that has no surface of the box.
bool ProgramBounds::ends_before(const Light& light, const Box& box) const {
  if (drawn_extent(light, volumes_) == LightExtent::unbounded) return false;
  constexpr double kRoom = 1 + 0x1p-8;  // for all that rounding may move a distance
  double square = 0, size = 0;
  for (size_t k = 0; k < 3; ++k) {
    const auto p = double(light.position[int(k)]);
    const double off = std::max({box.low[k] - p, p - box.high[k], 0.0});
    square += off * off, size = std::max({size, std::fabs(box.low[k]), std::fabs(box.high[k]), std::fabs(p)});
  }
  const double reach = double(light.range) * kRoom + size * 0x1p-16;
  return square > reach * reach;
}

void ProgramBounds::take_near(std::span<const ShadedSurface* const> surfaces, Block& block,
                              std::vector<uint32_t>& near) const {
  near.clear();
  if (surfaces.empty()) return;
  if (!suits_lanes()) {
    for (uint32_t i = 0; i < scene_.lights.size(); ++i) near.push_back(i);
    return;
  }
  Box box;
  for (const ShadedSurface* surface : surfaces) box.add(surface->position);
  // All that the surfaces hold, and what is computed of each.
  std::vector<Interval>& held = block.registers.of[size_t(Rate::surface)];
  held.assign(slots_[size_t(Rate::surface)], {0, HUGE_VAL, -HUGE_VAL, false});
  for (size_t first = 0; first < surfaces.size(); first += kIntervalLanes) {
    const auto some = surfaces.subspan(first, std::min(kIntervalLanes, surfaces.size() - first));
    look_at(some, block);
    for (const uint32_t slot : surface_slots_read_)
      held[slot] = hull(held[slot], block.of[size_t(Rate::surface)][slot].hull(some.size()));
  }
  std::array<uint32_t, kIntervalLanes> lights;
  for (uint32_t first = 0; first < scene_.lights.size(); first += kIntervalLanes) {
    const size_t count = std::min(kIntervalLanes, scene_.lights.size() - first);
    for (size_t i = 0; i < count; ++i) lights[i] = first + uint32_t(i);
    look_at(std::span<const uint32_t>(lights.data(), count), block);
    run_program_lanes(lanes_of_lights(of_pairs_, block, count, nullptr));
    run_program_lanes(lanes_of_lights(of_reaches_, block, count, nullptr));
    const ProgramLanes lanes = lanes_of_lights({}, block, count, nullptr);
    for (size_t i = 0; i < count; ++i) {
      bool is_dark = result(lanes, programs::kReachesOutput, i).is_false();
      for (int k = 0; k < 3 && is_dark; ++k) {
        const Interval x = result(lanes, programs::kLightOutput + k, i);
        is_dark = x.low == 0 && x.high == 0 && !x.maybe_nan;
      }
      if (!is_dark && !ends_before(scene_.lights[lights[i]], box)) near.push_back(lights[i]);
    }
  }
}

void ProgramBounds::apart(const ShadedSurface& surface, std::span<const uint32_t> lights, bool ends, Block& block,
                          LitApart& lit) const {
  constexpr size_t kFew = 4;  // lights that are as fast one by one
  lit.color.resize(lights.size()), lit.one_outcome.resize(lights.size());
  const auto by_itself = [&](size_t i) {
    const LitRange one = alone(surface, lights[i], ends, block.registers);
    lit.color[i] = one.color, lit.one_outcome[i] = one.branches.empty() && !one.undefined;
  };
  if (!suits_lanes() || is_unlit(surface) || lights.size() <= kFew) {
    for (size_t i = 0; i < lights.size(); ++i) by_itself(i);
    return;
  }
  look_at(surface, block.registers);
  for (size_t first = 0; first < lights.size(); first += kIntervalLanes) {
    const auto some = lights.subspan(first, std::min(kIntervalLanes, lights.size() - first));
    look_at(some, block);
    block.left.fill(0);
    run_program_lanes(lanes_of_lights(of_pairs_, block, some.size(), block.left.data()));
    const ProgramLanes lanes = lanes_of_lights({}, block, some.size(), nullptr);
    for (size_t i = 0; i < some.size(); ++i) {
      const Reach reach = ends ? reach_of(scene_.lights[some[i]], surface) : Reach::surely;
      bool is_known = block.left[i] == 0 && (reach == Reach::surely || reach == Reach::none);
      for (int k = 0; k < 3 && is_known; ++k) {
        Bounded& c = lit.color[first + i][size_t(k)];
        c = reach == Reach::none ? Bounded{} : bounded_of(result(lanes, programs::kLightOutput + k, i));
        is_known = std::isfinite(c.error);
      }
      lit.one_outcome[first + i] = is_known;
    }
  }
  for (size_t i = 0; i < lights.size(); ++i)
    if (lit.one_outcome[i] == 0) by_itself(i);
}

/// Lanes behind the last surface repeat the first one.
void ProgramBounds::look_at(std::span<const ShadedSurface* const> surfaces, Block& block) const {
  for (const Rate rate : {Rate::surface, Rate::pair}) block.of[size_t(rate)].resize(slots_[size_t(rate)] + 1);
  for (const auto& [slot, field] : surface_inputs_)
    for (size_t i = 0; i < kIntervalLanes; ++i)
      block.of[size_t(Rate::surface)][slot].set(i, field.at(*surfaces[i < surfaces.size() ? i : 0]));
  run_program_lanes(lanes_of(of_surfaces_, Rate::surface, block, 0, block.left.data()));
}

/// Which of the lanes a light surely reaches; true where it is any. Lanes that it may or may not reach are left.
bool ProgramBounds::find_reached(const Light& light, std::span<const ShadedSurface* const> surfaces,
                                 Block& block) const {
  bool any = false;
  for (size_t i = 0; i < surfaces.size(); ++i) {
    const Reach reach = reach_of(light, *surfaces[i]);
    block.reached[i] = reach == Reach::surely;
    any = any || reach == Reach::surely;
    if (reach == Reach::perhaps || reach == Reach::perhaps_not_nominally) block.left[i] = 1;
  }
  return any;
}

/// Of one light at the lanes that it reaches.
void ProgramBounds::add(uint32_t light, size_t count, Block& block, std::span<BlockSum> sums) const {
  std::array<uint8_t, kIntervalLanes> open{};
  run_program_lanes(lanes_of(of_pairs_, Rate::pair, block, light, open.data()));
  if (block.counts) run_program_lanes(lanes_of(of_reaches_, Rate::pair, block, light, nullptr));
  const ProgramLanes lanes = lanes_of({}, Rate::pair, block, light, nullptr);
  for (size_t i = 0; i < count; ++i) {
    if (!block.reached[i] || block.left[i] != 0) continue;
    BlockSum& sum = sums[i];
    bool is_dark = true;
    for (int k = 0; k < 3; ++k) {
      const Interval x = result(lanes, programs::kLightOutput + k, i);
      const Bounded b = bounded_of(x);
      if (!std::isfinite(b.error)) open[i] = 1;
      sum.color[size_t(k)].value += b.value, sum.color[size_t(k)].error += b.error;
      sum.magnitude[size_t(k)] += x.size();
      is_dark = is_dark && x.size() == 0;
    }
    block.left[i] |= open[i];
    sum.added += !is_dark;
    if (!block.counts) continue;
    const Interval counted = result(lanes, programs::kReachesOutput, i);
    sum.lights_low += counted.is_true(), sum.lights_high += !counted.is_false();
  }
}

void ProgramBounds::at(std::span<const ShadedSurface* const> surfaces, std::span<const uint32_t> lights, Block& block,
                       std::span<LitRange> lit) const {
  if (!suits_lanes()) {
    for (size_t i = 0; i < surfaces.size(); ++i) lit[i] = at(*surfaces[i], lights, block.registers);
    return;
  }
  block.left.fill(0);
  look_at(surfaces, block);
  std::array<BlockSum, kIntervalLanes> sums{};
  for (const uint32_t i : lights)
    if (find_reached(scene_.lights[i], surfaces, block)) add(i, surfaces.size(), block, sums);
  const ProgramLanes lanes = lanes_of({}, Rate::surface, block, 0, nullptr);
  for (size_t i = 0; i < surfaces.size(); ++i) {
    if (block.left[i] != 0 || is_unlit(*surfaces[i])) {
      lit[i] = at(*surfaces[i], lights, block.registers);
      continue;
    }
    ProgramTotal total;
    for (int k = 0; k < 3; ++k) total.start(size_t(k), result(lanes, programs::kStartOutput + k, i));
    total.add(sums[i]);
    lit[i] = total.finished(arithmetic_.roundoff);
  }
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
