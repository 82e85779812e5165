// Bounds of what lights add, many at a time: a surface a lane, or a light a lane (program_lanes.h).
#include <algorithm>
#include <cmath>

#include "judge/bounds/program_bounds.h"
#include "judge/bounds/program_total.h"
#include "scenes/pipeline/light_mesh.h"

namespace trueshade::oracle {

namespace {

using programs::Rate;

constexpr size_t kMostLaneSlots = 16384;  // values of a surface or a pair, which are 1.5 KiB each in lanes

}  // namespace

Interval ProgramBounds::result(const ProgramLanes& lanes, int number, size_t lane) const {
  const Place& p = place_[program_.output[size_t(number)]];
  return lanes.lanes[p.rate] != nullptr ? lanes.lanes[p.rate][p.slot].at(lane) : lanes.one[p.rate][p.slot];
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

/// Puts the values of at most kIntervalLanes lights into the lanes. Lanes behind the last light repeat the first one.
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

/// A box about the places where some surfaces may be.
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
  lit.surely_counts.resize(lights.size()), lit.may_count.resize(lights.size());
  const auto by_itself = [&](size_t i) {
    const LitRange one = alone(surface, lights[i], ends, block.registers);
    lit.color[i] = one.color, lit.one_outcome[i] = one.branches.empty() && !one.undefined;
    lit.surely_counts[i] = one.lights_low > 0, lit.may_count[i] = one.lights_high > 0;
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
    if (block.counts) run_program_lanes(lanes_of_lights(of_reaches_, block, some.size(), nullptr));
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
      if (!block.counts) continue;
      const Interval counted = result(lanes, programs::kReachesOutput, i);
      lit.surely_counts[first + i] = reach == Reach::surely && counted.is_true();
      lit.may_count[first + i] = reach != Reach::none && !counted.is_false();
    }
  }
  for (size_t i = 0; i < lights.size(); ++i)
    if (lit.one_outcome[i] == 0) by_itself(i);
}

/// Computes what depends on the surfaces alone, a surface a lane. Lanes behind the last surface repeat the first one.
void ProgramBounds::look_at(std::span<const ShadedSurface* const> surfaces, Block& block) const {
  for (const Rate rate : {Rate::surface, Rate::pair}) block.of[size_t(rate)].resize(slots_[size_t(rate)] + 1);
  for (const auto& [slot, field] : surface_inputs_)
    for (size_t i = 0; i < kIntervalLanes; ++i)
      block.of[size_t(Rate::surface)][slot].set(i, field.at(*surfaces[i < surfaces.size() ? i : 0]));
  run_program_lanes(lanes_of(of_surfaces_, Rate::surface, block, 0, block.left.data()));
}

/// Sets block.reached to the surfaces that a light surely reaches, and returns whether there are any. Sets block.left
/// for those that it may or may not reach: they are judged one by one.
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

/// Adds one light's terms to the sums of the lanes that it reaches. Sets block.left for lanes where a comparison may go
/// either way or a term is not finite.
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

}  // namespace trueshade::oracle
