#include "judge/diagnosis/plane_parameters.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/threads/parallel_for.h"

namespace trueshade::oracle {

/// Numbers that are fitted are only as good as their pixels: what they leave of a difference counts as 0 below a
/// hundredth of it.
PlaneSteps plane_steps(const PlaneCase& planes, const PlaneSupposition& supposed,
                       const std::vector<SampledPixel>& pixels, const PlaneSteps* before) {
  constexpr double kOfDifference = 0.01;
  const bool fits = std::any_of(supposed.faults.begin(), supposed.faults.end(),
                                [](const NamedPlaneFault& f) { return f.fault->is_estimate(); });
  PlaneSteps steps(pixels.size());
  parallel_for(int(pixels.size()), 0, [&](int i) {
    steps[size_t(i)] = planes.steps_off(supposed, pixels[size_t(i)].x, pixels[size_t(i)].y);
    for (size_t k = 0; fits && before != nullptr && k < kPlanes; ++k)
      if (steps[size_t(i)][k] < kOfDifference * (*before)[size_t(i)][k]) steps[size_t(i)][k] = 0;
  });
  return steps;
}

namespace {

/// The factor that costs least at the few pixels: the best of the fault's starts, then golden sections about it,
/// rounded where that costs hardly more.
double best_factor(const PlaneCase& planes, const PlaneSupposition& base, const PlaneFault& fault) {
  constexpr double kRatio = 0.6180339887498949;
  const auto cost_at = [&](double parameter) {  // what is far off counts more than what is less far off
    const std::optional<PlaneSupposition> s = planes.with(base, {&fault, parameter});
    double sum = 0;
    const PlaneSteps now = s ? plane_steps(planes, *s, planes.few()) : PlaneSteps{};
    for (size_t i = 0; i < now.size(); ++i)
      sum += planes.few()[i].weight * std::log2(1 + std::min(1e9, now[i][size_t(fault.plane)]));
    return s ? sum : HUGE_VAL;
  };
  double best = 0, least = HUGE_VAL;
  const auto better = [&](double parameter) {
    const double c = cost_at(parameter);
    if (c < least) least = c, best = parameter;
    return c;
  };
  for (const double start : fault.starts) better(start);
  double low = best / 2, high = best * 2, a = high - kRatio * (high - low), b = low + kRatio * (high - low);
  double cost_a = better(a), cost_b = better(b);
  for (int i = 0; i < 34; ++i) {
    const bool left = cost_a <= cost_b;
    (left ? high : low) = left ? b : a, (left ? b : a) = left ? a : b,
                   (left ? cost_b : cost_a) = left ? cost_a : cost_b;
    (left ? a : b) = left ? high - kRatio * (high - low) : low + kRatio * (high - low);
    (left ? cost_a : cost_b) = better(left ? a : b);
  }
  for (const double unit : {0.1, 0.05, 0.01, 1e-3, 1e-4}) {
    const double rounded = std::nearbyint(best / unit) * unit;
    if (rounded > 0 && rounded != 1 && cost_at(rounded) <= least * 1.001) return rounded;
  }
  return best;
}

}  // namespace

std::vector<FaultParameter> likely_parameters(const PlaneCase& planes, const PlaneEvidence& evidence,
                                              const PlaneSupposition& base, const PlaneFault& fault,
                                              const PlaneSteps& off_few) {
  using Search = PlaneFault::Search;

  if (fault.search == Search::none) return {0};
  if (fault.search == Search::one_of) return {fault.starts.begin(), fault.starts.end()};
  if (fault.search == Search::smooth) return {best_factor(planes, base, fault)};
  if (fault.search == Search::suspected) return suspected_parameters(evidence, fault);
  std::vector<double> differences;
  std::map<uint32_t, double> votes;
  for (size_t i = 0; i < off_few.size(); ++i) {
    const SampledPixel& p = planes.few()[i];
    if (agrees(off_few[i])) continue;
    const ExpectedPixel expected = planes.expected(p.x, p.y);
    if (!expected.value.covered) continue;
    votes[uint32_t(expected.value.object) - 1] += p.weight;
    if (const PlaneView& depth = planes.view(Plane::depth))
      differences.push_back(depth.stored(p.x, p.y, 0) - planes.predicted(base, Plane::depth, p.x, p.y, 0));
  }
  if (fault.search == Search::object) {
    std::vector<std::pair<double, double>> ranked;
    for (const auto& [object, weight] : votes) ranked.emplace_back(-weight, double(object));
    std::sort(ranked.begin(), ranked.end());
    if (ranked.size() > 2) ranked.resize(2);
    std::vector<FaultParameter> objects;
    for (const auto& [weight, object] : ranked) objects.emplace_back(object);
    return objects;
  }
  if (differences.empty()) return {};
  std::nth_element(differences.begin(), differences.begin() + int64_t(differences.size() / 2), differences.end());
  return {differences[differences.size() / 2]};
}

}  // namespace trueshade::oracle
