#include "judge/diagnosis/plane_search.h"

#include <algorithm>
#include <cmath>

#include "judge/diagnosis/object_border.h"
#include "judge/diagnosis/plane_parameters.h"

namespace trueshade::oracle {

namespace {

constexpr double kPlaneParameterCost = 0.002, kPlaneRival = 0.06, kPlanePairGain = 0.6;
constexpr double kExplained = 0.03;  ///< of what a G-buffer costs where nothing is wrong
constexpr size_t kFirstOfPlanePairs = 3;
constexpr double kEstimateCost = 0.01;               ///< numbers that are fitted explain more by chance
constexpr double kNearer = 0.1;                      ///< of what it was off
constexpr uint64_t kMostTrianglesRedrawn = 1000000;  ///< of a scene that is drawn again for every fault

struct PlaneCandidate {
  PlaneSupposition supposed;
  Disagreement found;
  std::array<double, kPlanes> costs{};  ///< by plane
  double cost = 0;                      ///< of what it costs where nothing is wrong
  double left = 0;                      ///< of what is equally cheap: PlaneSearch::left_of()
};

/// Looks for the faults that explain a G-buffer. Borrows the planes.
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

  /// How many pixels are wrong in any plane, estimated.
  double changed() const { return changed_; }
  /// How many pixels of a plane are wrong, estimated.
  double wrong(size_t plane) const { return wrong_[plane]; }
  /// The two faults that explain the G-buffer together, as one candidate, if they explain much more than any single
  /// one; else the best single faults, the best first. Empty where none explains kLeastExplained.
  std::vector<PlaneCandidate> look() const;
  /// What the supposed faults explain and cost, by the whole sample (`all`) or by the few pixels.
  PlaneCandidate judged(PlaneSupposition supposed, bool all) const;
  Finding finding(std::span<const NamedPlaneFault> faults, size_t which) const;
  bool told_apart(const PlaneCandidate& a, const PlaneCandidate& b) const;

 private:
  /// How many pixels are wrong without the faults (`changed`), the share of these that the faults explain and that stay
  /// far off or astray, and the share of the right pixels that they contradict.
  struct Share {
    double changed = 0, explained = 0, contradicted = 0, left = 0, astray = 0;
  };
  /// The mean cost of the planes of one pixel.
  double cost(const std::array<double, kPlanes>& off) const {
    double sum = 0;
    for (const double o : off) sum += cost_of(o);
    return sum / planes_.planes();
  }
  PlaneSteps off(const PlaneSupposition& supposed, const std::vector<SampledPixel>& pixels,
                 const PlaneSteps* before = nullptr) const {
    return plane_steps(planes_, supposed, pixels, before);
  }
  std::vector<PlaneCandidate> beside(const PlaneSupposition& base, bool redraw) const;
  bool bears_on(const PlaneFault& fault) const;
  double left_of(const PlaneSupposition& supposed) const;
  bool is_astray(const PlaneSupposition& supposed, const SampledPixel& pixel) const;
  void rank_equals(std::vector<PlaneCandidate>& singles) const;
  PlaneSupposition supposed(std::span<const NamedPlaneFault> faults) const;
  Share share(const PlaneSupposition& supposed, Plane plane) const;
  Proof proof(const PlaneSupposition& supposed, Plane plane, const PlaneSupposition* too_few) const;

  const PlaneCase& planes_;
  PlaneEvidence evidence_;
  PlaneSteps off_few_, off_;
  std::array<double, kPlanes> wrong_{};
  double changed_ = 0, cost_few_ = 0, cost_ = 0;
};

PlaneCandidate PlaneSearch::judged(PlaneSupposition supposed, bool all) const {
  const std::vector<SampledPixel>& pixels = all ? planes_.sample() : planes_.few();
  const PlaneSteps &before = all ? off_ : off_few_, now = off(supposed, pixels, &before);
  PlaneCandidate c;
  for (size_t i = 0; i < pixels.size(); ++i) {
    c.found.cost += pixels[i].weight * cost(now[i]);
    if (!agrees(before[i]) && agrees(now[i])) c.found.explained += pixels[i].weight;
    if (agrees(before[i]) && !agrees(now[i])) c.found.contradicted += pixels[i].weight;
  }
  c.cost = c.found.cost / (all ? cost_ : cost_few_);
  for (const NamedPlaneFault& f : supposed.faults)
    c.cost += f.fault->doubt + kPlaneParameterCost * f.numbers() + (f.fault->is_estimate() ? kEstimateCost : 0);
  c.supposed = std::move(supposed);
  return c;
}

/// Whether the fault can be what is wrong. A fault of one plane needs this plane to be wrong; drawing otherwise changes
/// most planes, so one wrong plane will do; averaging samples needs two of depth, position and normal, if captured.
bool PlaneSearch::bears_on(const PlaneFault& fault) const {
  if (fault.averages) {
    int captured = 0, off = 0;
    for (const Plane plane : {Plane::depth, Plane::position, Plane::normal})
      captured += planes_.view(plane) ? 1 : 0, off += wrong_[size_t(plane)] >= kLeastChanged ? 1 : 0;
    if (off < std::min(2, captured)) return false;
  }
  if (fault.plane != Plane::all) return wrong_[size_t(fault.plane)] >= kLeastChanged;
  return changed_ >= kLeastChanged;
}

/// Each fault that bears on what is wrong, supposed beside those of `base` with its best parameter; the cheapest first,
/// by the few pixels. Faults that draw otherwise are tried only if `redraw` and no encoding explains all.
std::vector<PlaneCandidate> PlaneSearch::beside(const PlaneSupposition& base, bool redraw) const {
  std::vector<PlaneCandidate> candidates;
  // Of an object more names than one may explain as much, and it is said that they do.
  const auto leaves_nothing = [&](const PlaneCandidate& c) {
    return c.found.cost < 1e-3 * cost_few_ && c.supposed.faults.back().fault->fit != Fit::object;
  };
  const auto tries = [&](std::span<const PlaneFault> table) {
    for (const PlaneFault& fault : table) {
      const auto same = [&](const NamedPlaneFault& f) { return f.fault == &fault; };
      if (!bears_on(fault) || std::any_of(base.faults.begin(), base.faults.end(), same)) continue;
      // Where nothing is left to explain no fit can do better.
      if (fault.fit != Fit::none && std::any_of(candidates.begin(), candidates.end(), leaves_nothing)) continue;
      std::optional<PlaneCandidate> best;
      for (const FaultParameter& parameter : likely_parameters(planes_, evidence_, base, fault, off_few_)) {
        std::optional<PlaneSupposition> s = planes_.with(base, {&fault, parameter});
        if (!s) continue;
        PlaneCandidate c = judged(std::move(*s), false);
        if (!best || c.cost < best->cost) best = std::move(c);
      }
      if (best) candidates.push_back(std::move(*best));
    }
  };
  tries(plane_faults()), tries(gloss_faults());
  // A redraw costs far more than another encoding, so planes that an encoding explains are not drawn again.
  const auto explained = [](const PlaneCandidate& c) { return c.cost < kExplained; };
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
                   [](const PlaneCandidate& a, const PlaneCandidate& b) { return a.cost < b.cost; });
  return candidates;
}

std::vector<PlaneCandidate> PlaneSearch::look() const {
  const auto by_cost = [](const PlaneCandidate& a, const PlaneCandidate& b) { return a.cost < b.cost; };
  const bool redraw = planes_.scene().triangle_count() <= kMostTrianglesRedrawn;
  std::vector<PlaneCandidate> singles = beside(planes_.right(), redraw);
  if (singles.empty()) return {};
  std::vector<PlaneCandidate> pairs;
  if (singles.front().cost > kExplained)
    for (size_t i = 0; i < std::min(kFirstOfPlanePairs, singles.size()); ++i) {
      std::vector<PlaneCandidate> both = beside(singles[i].supposed, redraw && i == 0);
      both.resize(std::min<size_t>(both.size(), 2));
      for (PlaneCandidate& c : both) pairs.push_back(judged(std::move(c.supposed), true));
    }
  singles.resize(std::min(kFinalists, singles.size()));
  for (PlaneCandidate& c : singles) c = judged(std::move(c.supposed), true);
  std::stable_sort(singles.begin(), singles.end(), by_cost);
  std::stable_sort(pairs.begin(), pairs.end(), by_cost);
  const auto explains = [&](const PlaneCandidate& c) {
    return c.found.explained - c.found.contradicted >= kLeastExplained * changed_ && c.found.cost < cost_;
  };
  if (!pairs.empty() && pairs.front().cost < kPlanePairGain * singles.front().cost && explains(pairs.front())) {
    // What explains more by itself comes first.
    std::vector<NamedPlaneFault>& faults = pairs.front().supposed.faults;
    const auto alone = [&](const NamedPlaneFault& f) { return share(supposed({&f, 1}), Plane::all).explained; };
    if (faults.size() == 2 && alone(faults[1]) > alone(faults[0])) std::swap(faults[0], faults[1]);
    return {std::move(pairs.front())};
  }
  rank_equals(singles);
  const double most = singles.front().cost + kPlaneRival;
  singles.erase(std::remove_if(singles.begin(), singles.end(),
                               [&](const PlaneCandidate& c) { return !explains(c) || c.cost > most; }),
                singles.end());
  return singles;
}

/// The faults supposed all at once, without those that change nothing.
PlaneSupposition PlaneSearch::supposed(std::span<const NamedPlaneFault> faults) const {
  PlaneSupposition s = planes_.right();
  for (const NamedPlaneFault& f : faults)
    if (std::optional<PlaneSupposition> more = planes_.with(s, f)) s = std::move(*more);
  return s;
}

/// Whether a plane (`all`: any plane) is off by more steps than rounding and legal differences make, and by more than a
/// tenth of what it was off without the faults.
bool is_far_off(const std::array<double, kPlanes>& now, const std::array<double, kPlanes>& before, Plane plane) {
  for (size_t k = 0; k < kPlanes; ++k)
    if ((plane == Plane::all || plane == Plane(k)) && now[k] > kFarOff && now[k] > kNearer * before[k]) return true;
  return false;
}

/// Whether the captured normal differs from the predicted one by more than a rounding or a wrong length can make.
bool PlaneSearch::is_astray(const PlaneSupposition& supposed, const SampledPixel& pixel) const {
  constexpr double kOtherDirection = 0.125;  // of unit length
  const PlaneView& normals = planes_.view(Plane::normal);
  if (!normals) return false;
  const double unit = normals.unorm() ? normals.layout.largest_code(0) / 2.0 : 1;
  for (int k = 0; k < std::min(3, normals.channels); ++k)
    if (std::fabs(normals.stored(pixel.x, pixel.y, k) -
                  planes_.predicted(supposed, Plane::normal, pixel.x, pixel.y, k)) > kOtherDirection * unit)
      return true;
  return false;
}

/// How much of the difference to the nominal values is left at the wrong pixels, in thousandths, and how many outline
/// pixels of a fitted object disagree. Where much is legal, two faults may both explain a pixel, one of them nearer.
double PlaneSearch::left_of(const PlaneSupposition& supposed) const {
  double sum = 0;
  for (size_t i = 0; i < off_.size(); ++i) {
    const auto [x, y, weight] = planes_.sample()[i];
    double most = 0;
    for (size_t plane = 0; plane < kPlanes; ++plane)
      for (int k = 0; off_[i][plane] >= kSameSteps && k < planes_.view(Plane(plane)).channels; ++k) {
        const double given = planes_.view(Plane(plane)).stored(x, y, k),
                     was = std::fabs(given - planes_.predicted(planes_.right(), Plane(plane), x, y, k)),
                     is = std::fabs(given - planes_.predicted(supposed, Plane(plane), x, y, k));
        if (was > 0) most = std::max(most, std::min(1.0, is / was));
      }
    sum += weight * most;
  }
  // Of an object, all of its outline: a sample may miss the few pixels that tell how it is changed.
  int missed = 0;
  for (const NamedPlaneFault& f : supposed.faults)
    for (const SampledPixel& p : f.fault->fit == Fit::object ? outline_of(evidence_, uint32_t(f.parameter.number))
                                                             : std::vector<SampledPixel>{})
      missed += agrees(planes_.steps_off(supposed, p.x, p.y)) ? 0 : 1;
  return missed + std::nearbyint(1000 * sum / changed_);
}

/// Orders the candidates that cost as little as the first, within 1e-4, by left_of().
void PlaneSearch::rank_equals(std::vector<PlaneCandidate>& singles) const {
  constexpr double kSameCost = 1e-4;
  size_t equals = 1;
  while (equals < singles.size() && singles[equals].cost < singles[0].cost + kSameCost) ++equals;
  for (size_t i = 0; equals > 1 && i < equals; ++i) singles[i].left = left_of(singles[i].supposed);
  std::stable_sort(singles.begin(), singles.begin() + ptrdiff_t(equals),
                   [](const PlaneCandidate& a, const PlaneCandidate& b) { return a.left < b.left; });
}

/// Whether two candidates differ in how many numbers they have, in what they leave, or in which sampled pixels agree.
bool PlaneSearch::told_apart(const PlaneCandidate& a, const PlaneCandidate& b) const {
  const auto numbers = [](const PlaneCandidate& c) {
    int sum = 0;
    for (const NamedPlaneFault& f : c.supposed.faults) sum += f.numbers();
    return sum;
  };
  if (numbers(a) != numbers(b) || a.left != b.left) return true;
  const PlaneSteps one = off(a.supposed, planes_.sample(), &off_), other = off(b.supposed, planes_.sample(), &off_);
  for (size_t i = 0; i < one.size(); ++i)
    if (agrees(one[i]) != agrees(other[i])) return true;
  return false;
}

/// Measures the supposed faults by one plane, or by all planes together.
PlaneSearch::Share PlaneSearch::share(const PlaneSupposition& supposed, Plane plane) const {
  const PlaneSteps now = off(supposed, planes_.sample(), &off_);
  const bool edges = std::any_of(supposed.faults.begin(), supposed.faults.end(), [](const NamedPlaneFault& f) {
    const bool moves_edges = f.fault->redraws() && f.fault->plane == Plane::all;
    return moves_edges || f.fault->move != nullptr || f.fault->averages;
  });
  Share out;
  double same = 0;
  for (size_t i = 0; i < off_.size(); ++i) {
    const double weight = planes_.sample()[i].weight;
    const bool was = agrees(off_[i], plane), is = agrees(now[i], plane);
    (was ? same : out.changed) += weight;
    if (!was && is) out.explained += weight;
    if (was && !is) out.contradicted += weight;
    const SampledPixel& p = planes_.sample()[i];  // what an encoding makes of where nothing is drawn is left open
    if (!is && !edges && is_far_off(now[i], off_[i], plane) && planes_.expected(p.x, p.y).value.covered)
      out.left += weight, out.astray += is_astray(supposed, p) ? weight : 0;
  }
  if (out.changed > 0) out.explained /= out.changed, out.left /= out.changed, out.astray /= out.changed;
  if (same > 0) out.contradicted /= same;
  return out;
}

/// The pixel of the plane that shows the faults best: of those that they explain, the one farthest off without a fault.
/// Its plane is empty where there is no such pixel.
///   too_few: pixels that these faults explain do not count; null: all count
Proof PlaneSearch::proof(const PlaneSupposition& supposed, Plane plane, const PlaneSupposition* too_few) const {
  Proof proof;
  double farthest = 0;
  const PlaneSteps now = off(supposed, planes_.sample(), &off_);
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

/// The finding about faults[which], together with the faults before it measured by all planes; the first fault is
/// measured by its own plane.
Finding PlaneSearch::finding(std::span<const NamedPlaneFault> faults, size_t which) const {
  const NamedPlaneFault& fault = faults[which];
  const Plane own = fault.fault->plane;
  const PlaneSupposition up_to_it = supposed(faults.first(which + 1)), before = supposed(faults.first(which));
  const Share found = share(up_to_it, which > 0 ? Plane::all : own);
  Finding f;
  f.name = name_of(*fault.fault, fault.parameter), f.text = text_of(*fault.fault, fault.parameter);
  f.plane = kPlaneNames[size_t(own)];
  f.changed = uint64_t(std::llround(found.changed));
  f.explained = found.explained, f.contradicted = found.contradicted, f.left = found.left, f.astray = found.astray;
  f.drawn_again = fault.fault->redraws();
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
  std::vector<PlaneCandidate> found;
  if (only.empty()) {
    found = search.look();
  } else {
    PlaneSupposition supposed = planes.right();
    for (const NamedPlaneFault& f : only)
      if (std::optional<PlaneSupposition> s = planes.with(supposed, f)) supposed = std::move(*s);
    if (!supposed.faults.empty()) found.push_back(search.judged(std::move(supposed), true));
  }
  for (const PlaneCandidate& c : found) {
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
