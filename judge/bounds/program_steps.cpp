// How the nodes of a light program are computed within bounds: which of them, in which order, and how often.
#include <algorithm>

#include "judge/bounds/program_bounds.h"

namespace trueshade::oracle {

namespace {

using programs::NodeId;
using programs::Op;
using programs::ProgramNode;
using programs::Rate;

constexpr size_t kMostTerms = 64;  // of a sum whose order is taken to be any, and how deep they may lie

}  // namespace

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

}  // namespace trueshade::oracle
