#include "judge/diagnosis/plane_search.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/threads/parallel_for.h"
#include "judge/diagnosis/plane_case.h"

namespace trueshade::oracle {

namespace {

using Search = PlaneFault::Search;

constexpr double kNamed = 1.0 / 3, kParameterCost = 0.002, kRival = 0.06, kPairGain = 0.6, kLeastChanged = 8;
constexpr double kExplained = 0.03;  ///< of what a G-buffer costs where nothing is wrong
constexpr size_t kFirstOfPairs = 3, kFinalists = 8;
constexpr double kFarOff = 1.5, kNearer = 0.1;  ///< steps, and of what it was off
constexpr uint64_t kMostTriangles = 1000000;    ///< of a scene that is drawn again for every fault

struct Candidate {
  PlaneSupposition supposed;
  Disagreement found;
  std::array<double, kPlanes> costs{};  ///< by plane
  double cost = 0;                      ///< of what it costs where nothing is wrong
};

/// Numbers that a fault's name gives, without those that change nothing.
int given_numbers(const NamedPlaneFault& f) {
  const ParameterForm form = f.fault->form();
  int count = form.count();
  for (int k = 0; k < form.vector; ++k) count -= f.parameter.vector[size_t(k)] == f.fault->start ? 1 : 0;
  return count;
}

class PlaneSearch {
 public:
  explicit PlaneSearch(const PlaneCase& planes) : planes_(planes), evidence_(planes.evidence()) {
    off_few_ = off(planes.right(), planes.few()), off_ = off(planes.right(), planes.sample());
    for (size_t i = 0; i < off_.size(); ++i) {
      const double weight = planes.sample()[i].weight;
      for (size_t k = 0; k < kPlanes; ++k) wrong_[k] += off_[i][k] >= kSameSteps ? weight : 0;
      changed_ += agrees(off_[i]) ? 0 : weight;
    }
    for (size_t i = 0; i < off_.size(); ++i) evidence_.pixels[i].wrong = !agrees(off_[i]);
    for (size_t i = 0; i < off_few_.size(); ++i) cost_few_ += planes.few()[i].weight * cost(off_few_[i]);
    for (size_t i = 0; i < off_.size(); ++i) cost_ += planes.sample()[i].weight * cost(off_[i]);
  }

  double changed() const { return changed_; }
  double wrong(size_t plane) const { return wrong_[plane]; }
  std::vector<Candidate> look() const;
  Candidate judged(PlaneSupposition supposed, bool all) const;
  Finding finding(std::span<const NamedPlaneFault> faults, size_t which) const;
  bool told_apart(const Candidate& a, const Candidate& b) const;

 private:
  using Steps = std::vector<std::array<double, kPlanes>>;
  /// How many pixels are not as they should be, and shares of these and of the others.
  struct Share {
    double changed = 0, explained = 0, contradicted = 0, left = 0;
  };
  static bool agrees(const std::array<double, kPlanes>& off, Plane plane = Plane::all) {
    if (plane != Plane::all) return off[size_t(plane)] < kSameSteps;
    return std::all_of(off.begin(), off.end(), [](double o) { return o < kSameSteps; });
  }
  double cost(const std::array<double, kPlanes>& off) const {
    double sum = 0;
    for (const double o : off) sum += cost_of(o);
    return sum / planes_.planes();
  }
  Steps off(const PlaneSupposition& supposed, const std::vector<SampledPixel>& pixels,
            const Steps* before = nullptr) const;
  double smooth(const PlaneSupposition& base, const PlaneFault& fault) const;
  std::vector<FaultParameter> parameters(const PlaneSupposition& base, const PlaneFault& fault) const;
  std::vector<Candidate> beside(const PlaneSupposition& base, bool redraw) const;
  bool bears_on(const PlaneFault& fault) const;
  PlaneSupposition supposed(std::span<const NamedPlaneFault> faults) const;
  Share share(const PlaneSupposition& supposed, Plane plane) const;
  Proof proof(const PlaneSupposition& supposed, Plane plane, const PlaneSupposition* too_few) const;

  const PlaneCase& planes_;
  PlaneEvidence evidence_;
  Steps off_few_, off_;
  std::array<double, kPlanes> wrong_{};
  double changed_ = 0, cost_few_ = 0, cost_ = 0;
};

/// Numbers that are fitted are as good as their pixels: what is left of a difference by less than its hundredth is.
PlaneSearch::Steps PlaneSearch::off(const PlaneSupposition& supposed, const std::vector<SampledPixel>& pixels,
                                    const Steps* before) const {
  constexpr double kOfDifference = 0.01;
  const bool fits = std::any_of(supposed.faults.begin(), supposed.faults.end(),
                                [](const NamedPlaneFault& f) { return f.fault->is_estimate(); });
  Steps steps(pixels.size());
  parallel_for(int(pixels.size()), 0, [&](int i) {
    steps[size_t(i)] = planes_.steps_off(supposed, pixels[size_t(i)].x, pixels[size_t(i)].y);
    for (size_t k = 0; fits && before != nullptr && k < kPlanes; ++k)
      if (steps[size_t(i)][k] < kOfDifference * (*before)[size_t(i)][k]) steps[size_t(i)][k] = 0;
  });
  return steps;
}

Candidate PlaneSearch::judged(PlaneSupposition supposed, bool all) const {
  const std::vector<SampledPixel>& pixels = all ? planes_.sample() : planes_.few();
  const Steps &before = all ? off_ : off_few_, now = off(supposed, pixels, &before);
  Candidate c;
  for (size_t i = 0; i < pixels.size(); ++i) {
    c.found.cost += pixels[i].weight * cost(now[i]);
    if (!agrees(before[i]) && agrees(now[i])) c.found.explained += pixels[i].weight;
    if (agrees(before[i]) && !agrees(now[i])) c.found.contradicted += pixels[i].weight;
  }
  c.cost = c.found.cost / (all ? cost_ : cost_few_);
  for (const NamedPlaneFault& f : supposed.faults) c.cost += f.fault->doubt + kParameterCost * given_numbers(f);
  c.supposed = std::move(supposed);
  return c;
}

/// Only planes that are wrong can have a fault of their own; drawing otherwise changes most of them.
bool PlaneSearch::bears_on(const PlaneFault& fault) const {
  if (fault.plane != Plane::all) return wrong_[size_t(fault.plane)] >= kLeastChanged;
  return changed_ >= kLeastChanged;
}

/// The best factor: that of the starts, and then golden sections about it.
double PlaneSearch::smooth(const PlaneSupposition& base, const PlaneFault& fault) const {
  constexpr double kRatio = 0.6180339887498949;
  const auto cost_at = [&](double parameter) {  // what is far off counts more than what is less far off
    const std::optional<PlaneSupposition> s = planes_.with(base, {&fault, parameter});
    double sum = 0;
    const Steps now = s ? off(*s, planes_.few()) : Steps{};
    for (size_t i = 0; i < now.size(); ++i)
      sum += planes_.few()[i].weight * std::log2(1 + std::min(1e9, now[i][size_t(fault.plane)]));
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

/// The parameters that are tried for a fault: its table's, or one that is estimated from the pixels.
std::vector<FaultParameter> PlaneSearch::parameters(const PlaneSupposition& base, const PlaneFault& fault) const {
  if (fault.search == Search::none) return {0};
  if (fault.search == Search::one_of) return {fault.starts.begin(), fault.starts.end()};
  if (fault.search == Search::smooth) return {smooth(base, fault)};
  if (fault.search == Search::suspected) return suspected_parameters(evidence_, fault);
  std::vector<double> differences;
  std::map<uint32_t, double> votes;
  for (size_t i = 0; i < off_few_.size(); ++i) {
    const SampledPixel& p = planes_.few()[i];
    if (agrees(off_few_[i])) continue;
    const ExpectedPixel expected = planes_.expected(p.x, p.y);
    if (!expected.value.covered) continue;
    votes[uint32_t(expected.value.object) - 1] += p.weight;
    if (const PlaneView& depth = planes_.view(Plane::depth))
      differences.push_back(depth.stored(p.x, p.y, 0) - planes_.predicted(base, Plane::depth, p.x, p.y, 0));
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

std::vector<Candidate> PlaneSearch::beside(const PlaneSupposition& base, bool redraw) const {
  std::vector<Candidate> candidates;
  // Of an object more names than one may explain as much, and it is said that they do.
  const auto leaves_nothing = [&](const Candidate& c) {
    return c.found.cost < 1e-3 * cost_few_ && c.supposed.faults.back().fault->fit != Fit::object;
  };
  const auto tries = [&](std::span<const PlaneFault> table) {
    for (const PlaneFault& fault : table) {
      const auto same = [&](const NamedPlaneFault& f) { return f.fault == &fault; };
      if (!bears_on(fault) || std::any_of(base.faults.begin(), base.faults.end(), same)) continue;
      // Where nothing is left to explain no fit can do better.
      if (fault.fit != Fit::none && std::any_of(candidates.begin(), candidates.end(), leaves_nothing)) continue;
      std::optional<Candidate> best;
      for (const FaultParameter& parameter : parameters(base, fault)) {
        std::optional<PlaneSupposition> s = planes_.with(base, {&fault, parameter});
        if (!s) continue;
        Candidate c = judged(std::move(*s), false);
        if (!best || c.cost < best->cost) best = std::move(c);
      }
      if (best) candidates.push_back(std::move(*best));
    }
  };
  tries(plane_faults());
  // A redraw costs far more than another encoding, so planes that an encoding explains are not drawn again.
  const auto explained = [](const Candidate& c) { return c.cost < kExplained; };
  const auto needs_more = [&] { return redraw && std::none_of(candidates.begin(), candidates.end(), explained); };
  // What is estimated is estimated of captures with no other fault. Alpha tests make a redraw cost most, so theirs is
  // looked at first.
  const std::vector<Material>& materials = planes_.scene().materials;
  const bool masked = std::any_of(materials.begin(), materials.end(), [](const Material& m) { return m.masked(); });
  const bool alone = base.faults.empty();
  if (masked && alone && needs_more()) tries(material_faults());
  if (needs_more()) tries(redraw_faults());
  if (alone && needs_more()) tries(object_faults());
  if (alone && needs_more()) tries(camera_faults());
  if (!masked && alone && needs_more()) tries(material_faults());
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; });
  return candidates;
}

std::vector<Candidate> PlaneSearch::look() const {
  const auto by_cost = [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; };
  const bool redraw = planes_.scene().triangle_count() <= kMostTriangles;
  std::vector<Candidate> singles = beside(planes_.right(), redraw);
  if (singles.empty()) return {};
  std::vector<Candidate> pairs;
  if (singles.front().cost > kExplained)
    for (size_t i = 0; i < std::min(kFirstOfPairs, singles.size()); ++i) {
      std::vector<Candidate> both = beside(singles[i].supposed, redraw && i == 0);
      both.resize(std::min<size_t>(both.size(), 2));
      for (Candidate& c : both) pairs.push_back(judged(std::move(c.supposed), true));
    }
  singles.resize(std::min(kFinalists, singles.size()));
  for (Candidate& c : singles) c = judged(std::move(c.supposed), true);
  std::stable_sort(singles.begin(), singles.end(), by_cost);
  std::stable_sort(pairs.begin(), pairs.end(), by_cost);
  const auto explains = [&](const Candidate& c) {
    return c.found.explained - c.found.contradicted >= kNamed * changed_ && c.found.cost < cost_;
  };
  if (!pairs.empty() && pairs.front().cost < kPairGain * singles.front().cost && explains(pairs.front())) {
    // What explains more by itself comes first.
    std::vector<NamedPlaneFault>& faults = pairs.front().supposed.faults;
    const auto alone = [&](const NamedPlaneFault& f) { return share(supposed({&f, 1}), Plane::all).explained; };
    if (faults.size() == 2 && alone(faults[1]) > alone(faults[0])) std::swap(faults[0], faults[1]);
    return {std::move(pairs.front())};
  }
  const double most = singles.front().cost + kRival;
  singles.erase(
      std::remove_if(singles.begin(), singles.end(), [&](const Candidate& c) { return !explains(c) || c.cost > most; }),
      singles.end());
  return singles;
}

PlaneSupposition PlaneSearch::supposed(std::span<const NamedPlaneFault> faults) const {
  PlaneSupposition s = planes_.right();
  for (const NamedPlaneFault& f : faults)
    if (std::optional<PlaneSupposition> more = planes_.with(s, f)) s = std::move(*more);
  return s;
}

/// Whether more is left of a difference than rounding and what is legal of a plane make.
bool is_far_off(const std::array<double, kPlanes>& now, const std::array<double, kPlanes>& before, Plane plane) {
  for (size_t k = 0; k < kPlanes; ++k)
    if ((plane == Plane::all || plane == Plane(k)) && now[k] > kFarOff && now[k] > kNearer * before[k]) return true;
  return false;
}

/// Whether any pixel is as one has it and not as the other has it. Of names with as many numbers.
bool PlaneSearch::told_apart(const Candidate& a, const Candidate& b) const {
  const auto numbers = [](const Candidate& c) {
    int sum = 0;
    for (const NamedPlaneFault& f : c.supposed.faults) sum += given_numbers(f);
    return sum;
  };
  if (numbers(a) != numbers(b)) return true;
  const Steps one = off(a.supposed, planes_.sample(), &off_), other = off(b.supposed, planes_.sample(), &off_);
  for (size_t i = 0; i < one.size(); ++i)
    if (agrees(one[i]) != agrees(other[i])) return true;
  return false;
}

/// Of the pixels of one plane, or of all.
PlaneSearch::Share PlaneSearch::share(const PlaneSupposition& supposed, Plane plane) const {
  const Steps now = off(supposed, planes_.sample(), &off_);
  const bool edges = std::any_of(supposed.faults.begin(), supposed.faults.end(), [](const NamedPlaneFault& f) {
    return f.fault->redraws() || f.fault->move != nullptr || f.fault->averages;
  });
  Share out;
  double same = 0;
  for (size_t i = 0; i < off_.size(); ++i) {
    const double weight = planes_.sample()[i].weight;
    const bool was = agrees(off_[i], plane), is = agrees(now[i], plane);
    (was ? same : out.changed) += weight;
    if (!was && is) out.explained += weight;
    if (was && !is) out.contradicted += weight;
    if (!is && !edges && is_far_off(now[i], off_[i], plane)) out.left += weight;
  }
  if (out.changed > 0) out.explained /= out.changed, out.left /= out.changed;
  if (same > 0) out.contradicted /= same;
  return out;
}

/// The pixel of the plane that is farthest off where nothing is wrong, of those that are explained.
///   too_few: what does not explain the pixel; null: any will do
Proof PlaneSearch::proof(const PlaneSupposition& supposed, Plane plane, const PlaneSupposition* too_few) const {
  Proof proof;
  double farthest = 0;
  const Steps now = off(supposed, planes_.sample(), &off_);
  for (size_t i = 0; i < off_.size(); ++i) {
    const auto [x, y, weight] = planes_.sample()[i];
    const size_t worst = plane != Plane::all
                             ? size_t(plane)
                             : size_t(std::max_element(off_[i].begin(), off_[i].end()) - off_[i].begin());
    if (off_[i][worst] < kSameSteps || off_[i][worst] <= farthest) continue;
    if (!agrees(now[i], plane)) continue;
    if (too_few != nullptr && agrees(planes_.steps_off(*too_few, x, y), plane)) continue;
    double most = 0;
    for (int k = 0; k < planes_.view(Plane(worst)).channels; ++k) {
      const double given = planes_.view(Plane(worst)).stored(x, y, k),
                   right = planes_.predicted(planes_.right(), Plane(worst), x, y, k),
                   predicted = planes_.predicted(supposed, Plane(worst), x, y, k);
      if (!(std::fabs(given - right) > most) || !(std::fabs(given - predicted) < std::fabs(given - right))) continue;
      most = std::fabs(given - right), farthest = off_[i][worst];
      proof = {x, y, channel_of(kPlaneNames[worst], k), given, right, predicted};
    }
  }
  proof.by_both = supposed.faults.size() > 1;
  return proof;
}

/// The fault with those that come before it. Alone, it answers for its own plane.
Finding PlaneSearch::finding(std::span<const NamedPlaneFault> faults, size_t which) const {
  const NamedPlaneFault& fault = faults[which];
  const Plane own = fault.fault->plane;
  const PlaneSupposition up_to_it = supposed(faults.first(which + 1)), before = supposed(faults.first(which));
  const Share found = share(up_to_it, which > 0 ? Plane::all : own);
  Finding f;
  f.name = name_of(*fault.fault, fault.parameter), f.text = text_of(*fault.fault, fault.parameter);
  f.plane = kPlaneNames[size_t(own)];
  f.changed = uint64_t(std::llround(found.changed));
  f.explained = found.explained, f.contradicted = found.contradicted, f.left = found.left;
  f.together = which > 0, f.fitted = fault.fault->is_estimate() || fault.fault->averages;
  f.alone = f.together ? share(supposed({&fault, 1}), own).explained : f.explained;
  f.proof = proof(up_to_it, own, which > 0 ? &before : nullptr);
  if (f.proof.plane.empty() && which == 0 && faults.size() > 1) {
    const PlaneSupposition others = supposed(faults.subspan(1));
    f.proof = proof(supposed(faults), own, &others);
  }
  return f;
}

}  // namespace

std::string name_of(const PlaneFault& fault, const FaultParameter& parameter) { return fault_name(fault, parameter); }
std::string text_of(const PlaneFault& fault, const FaultParameter& parameter) { return fault_text(fault, parameter); }

PlaneFindings plane_findings(const Scene& scene, const Pipeline& pipeline, const Profile& profile,
                             const Capture& capture, const StageVerdict& stage, std::span<const NamedPlaneFault> only) {
  const PlaneCase planes(scene, pipeline, profile, capture, stage);
  const PlaneSearch search(planes);
  PlaneFindings out;
  for (size_t k = 0; k < kPlanes; ++k) out.wrong[k] = search.wrong(k) >= kLeastChanged;
  if (search.changed() < kLeastChanged) return out;
  out.expected = planes.expected();
  std::vector<Candidate> found;
  if (only.empty()) {
    found = search.look();
  } else {
    PlaneSupposition supposed = planes.right();
    for (const NamedPlaneFault& f : only)
      if (std::optional<PlaneSupposition> s = planes.with(supposed, f)) supposed = std::move(*s);
    if (!supposed.faults.empty()) found.push_back(search.judged(std::move(supposed), true));
  }
  for (const Candidate& c : found) {
    std::vector<Finding> named;
    for (size_t i = 0; i < c.supposed.faults.size(); ++i) named.push_back(search.finding(c.supposed.faults, i));
    const auto unproved = [](const Finding& f) { return f.proof.plane.empty(); };
    if (only.empty() && std::any_of(named.begin(), named.end(), unproved)) continue;
    if (out.findings.empty()) out.drawn = c.supposed.scene;
    if (!out.findings.empty() && !search.told_apart(found.front(), c)) named.front().tied = true;
    for (Finding& f : named) out.findings.push_back(std::move(f));
  }
  return out;
}

}  // namespace trueshade::oracle
