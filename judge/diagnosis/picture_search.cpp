#include "judge/diagnosis/picture_search.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>

#include "core/threads/parallel_for.h"
#include "judge/diagnosis/fault_estimate.h"
#include "judge/diagnosis/plain_program.h"

namespace trueshade::oracle {

namespace {

// Shares of the pixels that are not as they should be.
constexpr double kPictureParameterCost = 0.004;          ///< what a parameter must earn
constexpr double kWholeCost = 0.001;                     ///< and one of some whole numbers
constexpr double kPictureRival = 0.04;                   ///< that a lesser finding may cost more than the best
constexpr double kPicturePairGain = 0.55;                ///< of a single fault's cost, that two may cost at most
constexpr double kLeastGain = 0.02;                      ///< and that a second fault must earn
constexpr double kNearOne = 0.015;                       ///< factors that change values by about a code
constexpr double kLeftByFew = 0.25, kLeftByTwo = 0.175;  ///< of what disagrees, that such a factor may leave
constexpr size_t kFirstOfPicturePairs = 5;
constexpr double kByEstimates = 0.05;  ///< where a light ends by an estimate pixels are far off
constexpr size_t kFarByChance = 3;     ///< pixels so far off that may be by chance

struct PictureCandidate {
  std::vector<NamedFault> faults;
  Disagreement found;
  double cost = 0;  ///< with what parameters and doubts cost, of the changed pixels
};

/// The rows of both tables.
std::vector<const PictureFault*> all_faults() {
  std::vector<const PictureFault*> faults;
  for (const PictureFault& f : picture_value_faults()) faults.push_back(&f);
  for (const PictureFault& f : light_faults()) faults.push_back(&f);
  return faults;
}

/// What a parameter that is found so must earn.
double parameter_cost(Search search) {
  switch (search) {
    case Search::none:
      return 0;
    case Search::smooth:
    case Search::one_light:
    case Search::vector:
      return kPictureParameterCost;
    default:
      return kWholeCost;
  }
}

/// Whether a fault can be supposed where a light program draws: it changes no term of the light model. Where the
/// program defines finish(), a fault of single lights cannot, since sums before finish() are not followed light by
/// light.
bool holds_for_programs(const PictureFault& fault, const LightPass& pass) {
  constexpr Search kByLight[] = {Search::missing_light, Search::doubled_light, Search::count, Search::count_at_pixel,
                                 Search::one_light};
  if (pass.program->defines_finish() &&
      std::find(std::begin(kByLight), std::end(kByLight), fault.search) != std::end(kByLight))
    return false;
  LightPass changed = pass;
  if (fault.light != nullptr) fault.light(changed, fault.starts.empty() ? 2.0 : fault.starts.front());
  const LightFault &now = changed.fault, &right = pass.fault;
  return changed.pipeline.light_model == pass.pipeline.light_model && now.distance == right.distance &&
         now.half == right.half && now.root == right.root && now.cosine == right.cosine &&
         now.specular == right.specular && now.shininess == right.shininess && now.diffuse == right.diffuse &&
         now.cone_dropped == right.cone_dropped;
}

class PictureSearch {
 public:
  explicit PictureSearch(PictureCase& picture) : picture_(picture) {
    off_few_ = off(picture.few()), off_ = off(picture.sample());
    for (size_t i = 0; i < off_.size(); ++i) {
      const double weight = picture.sample()[i].weight;
      (off_[i] >= kSameSteps ? changed_ : same_) += weight, cost_ += weight * cost_of(off_[i]);
    }
    for (size_t i = 0; i < off_few_.size(); ++i)
      changed_few_ += off_few_[i] >= kSameSteps ? picture.few()[i].weight : 0;
  }

  /// How many pixels are wrong, estimated.
  double changed() const { return changed_; }
  /// The one fault, or the two together, that explain the picture best, and rivals of a single one. Leaves out findings
  /// that no sampled pixel proves.
  std::vector<Finding> look() const;
  /// One finding about each of the faults, together with those before it.
  std::vector<Finding> findings(std::span<const NamedFault> faults) const;

 private:
  std::vector<double> off(const std::vector<SampledPixel>& pixels) const;
  PictureSupposition supposed(std::span<const NamedFault> faults) const;
  PictureCandidate judged(std::vector<NamedFault> faults, bool all) const {
    return judged(faults, supposed(faults), all);
  }
  PictureCandidate judged(std::vector<NamedFault> faults, const PictureSupposition& supposed, bool all) const;
  std::vector<PictureCandidate> beside(std::span<const NamedFault> faults) const;
  void refine(PictureCandidate& candidate) const;
  Finding finding(std::span<const NamedFault> faults, size_t which) const;
  std::vector<PictureCandidate> named(std::vector<PictureCandidate> singles) const;
  bool told_apart(const PictureCandidate& a, const PictureCandidate& b) const;
  std::vector<Finding> ranked(std::vector<PictureCandidate> singles) const;
  Proof proof(std::span<const NamedFault> faults, std::span<const NamedFault> too_few) const;
  double left(std::span<const NamedFault> faults) const;
  bool explains(const PictureCandidate& c) const {
    return c.found.explained + c.found.located - c.found.contradicted >= kLeastExplained * changed_ &&
           c.found.cost < cost_;
  }

  PictureCase& picture_;
  std::vector<double> off_few_, off_;
  double changed_ = 0, changed_few_ = 0, same_ = 0;
  double cost_ = 0;  ///< of the prediction without a fault
};

/// What each pixel is off without a fault.
std::vector<double> PictureSearch::off(const std::vector<SampledPixel>& pixels) const {
  std::vector<double> steps(pixels.size());
  const PictureSupposition right = picture_.right();
  parallel_for(int(pixels.size()), 0, [&](int i) { steps[size_t(i)] = picture_.steps_off(right, pixels[size_t(i)]); });
  return steps;
}

/// The faults supposed all at once, in this order.
PictureSupposition PictureSearch::supposed(std::span<const NamedFault> faults) const {
  PictureSupposition s = picture_.right();
  for (const NamedFault& f : faults) s.suppose(*f.fault, f.parameter);
  return s;
}

/// What the faults explain and cost, by the whole sample (`all`) or by the few pixels.
PictureCandidate PictureSearch::judged(std::vector<NamedFault> faults, const PictureSupposition& supposed,
                                       bool all) const {
  PictureCandidate c;
  c.found = picture_.disagreement(supposed, all ? picture_.sample() : picture_.few(), all ? off_ : off_few_);
  c.cost = c.found.cost / (all ? changed_ : changed_few_);
  for (const NamedFault& f : faults) {
    c.cost += f.fault->doubt + parameter_cost(f.fault->search);
    if (f.fault->stale > 0) c.cost += picture_.stale_cost(f.fault->stale);
  }
  c.faults = std::move(faults);
  return c;
}

/// Each fault that is not among `faults`, supposed together with them, with the parameters that are likely; judged by
/// the few pixels, the cheapest first.
std::vector<PictureCandidate> PictureSearch::beside(std::span<const NamedFault> faults) const {
  const std::vector<const PictureFault*> rows = all_faults();
  PictureSupposition base = supposed(faults);
  if (base.known == nullptr) base.known = std::make_shared<KnownPixels>();
  std::vector<std::vector<PictureCandidate>> found(rows.size());
  parallel_for(int(rows.size()), 0, [&](int i) {
    const PictureFault& fault = *rows[size_t(i)];
    if (fault.can != nullptr && !fault.can(base.pass)) return;
    if (base.pass.program != nullptr && !holds_for_programs(fault, base.pass)) return;
    for (const NamedFault& f : faults)
      if (f.fault == &fault) return;
    for (const FaultParameter& parameter : likely_parameters(picture_, base, fault, picture_.few(), off_few_)) {
      std::vector<NamedFault> together(faults.begin(), faults.end());
      together.push_back({&fault, parameter});
      PictureSupposition both = base;
      both.suppose(fault, parameter);
      if (fault.reach > 0 && !picture_.looks_dithered(both)) continue;
      found[size_t(i)].push_back(judged(std::move(together), both, false));
    }
  });
  std::vector<PictureCandidate> candidates;
  for (std::vector<PictureCandidate>& of_row : found)
    for (PictureCandidate& c : of_row) candidates.push_back(std::move(c));
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const PictureCandidate& a, const PictureCandidate& b) { return a.cost < b.cost; });
  return candidates;
}

/// Estimates each fault's parameter again, with the candidate's other faults supposed, and keeps what costs less.
void PictureSearch::refine(PictureCandidate& candidate) const {
  for (size_t turn = 0; turn < candidate.faults.size(); ++turn) {
    NamedFault& fault = candidate.faults[turn];
    if (fault.fault->search != Search::smooth) continue;
    // What is supposed is predicted in order: a fault that is put last is one that the others do not change.
    PictureSupposition base = picture_.right();
    for (size_t i = 0; i < candidate.faults.size(); ++i)
      if (i != turn) base.suppose(*candidate.faults[i].fault, candidate.faults[i].parameter);
    for (const FaultParameter& parameter : likely_parameters(picture_, base, *fault.fault, picture_.few(), off_few_)) {
      std::vector<NamedFault> faults = candidate.faults;
      faults[turn].parameter = parameter;
      PictureCandidate better = judged(std::move(faults), false);
      if (better.cost < candidate.cost) candidate = std::move(better);
    }
  }
}

/// The pixel that shows the faults best: of those that they explain, the one farthest off without a fault. Its plane is
/// empty where there is no such pixel.
///   too_few: pixels that these faults explain do not count; empty: all count
Proof PictureSearch::proof(std::span<const NamedFault> faults, std::span<const NamedFault> too_few) const {
  const PictureSupposition right = picture_.right(), all = supposed(faults), few = supposed(too_few);
  Proof proof;
  double farthest = 0;
  for (size_t i = 0; i < off_.size(); ++i) {
    const SampledPixel& pixel = picture_.sample()[i];
    const auto [x, y, weight] = pixel;
    if (off_[i] < kSameSteps || off_[i] <= farthest || picture_.steps_off(all, pixel) >= kSameSteps) continue;
    if (!too_few.empty() && picture_.steps_off(few, pixel) < kSameSteps) continue;
    const PictureCase::Prediction should = picture_.predicted(right, x, y), does = picture_.predicted(all, x, y);
    double most = -1;
    for (int k = 0; k < picture_.channels(); ++k) {
      const double steps = picture_.steps_off(right, should, x, y, k), predicted = picture_.shown(all, does, x, y, k);
      if (steps <= most || predicted == should.stored[size_t(k)]) continue;
      most = steps, farthest = off_[i];
      proof = {x, y, channel_of("color", k), picture_.given(x, y, k), should.stored[size_t(k)], predicted};
      proof.anything = picture_.in_stale_tile(all, x, y);
    }
  }
  proof.by_both = faults.size() > 1;
  return proof;
}

/// How many pixels are far off under the faults, also ones that were right without, as a share of the pixels that are
/// wrong without. 0 where they are so few that it may be by chance.
double PictureSearch::left(std::span<const NamedFault> faults) const {
  const std::vector<double> now = picture_.steps_off(supposed(faults), picture_.sample());
  double weight = 0;
  size_t pixels = 0;
  for (size_t i = 0; i < now.size(); ++i)
    if (now[i] > kFarOff) weight += picture_.sample()[i].weight, ++pixels;
  const auto estimated = [](const NamedFault& f) {
    const Search s = f.fault->search;
    return s == Search::smooth || s == Search::vector || s == Search::one_light;
  };
  const bool by_chance = pixels < kFarByChance ||
                         (weight < kByEstimates * changed_ && std::any_of(faults.begin(), faults.end(), estimated));
  return by_chance ? 0 : weight / changed_;
}

/// The finding about faults[which], judged together with the faults before it.
Finding PictureSearch::finding(std::span<const NamedFault> faults, size_t which) const {
  const NamedFault& fault = faults[which];
  const auto up_to_it = faults.first(which + 1), before = faults.first(which);
  const PictureCandidate together = judged({up_to_it.begin(), up_to_it.end()}, true);
  Finding f;
  f.name = name_of(*fault.fault, fault.parameter), f.plane = "picture", f.text = text_of(*fault.fault, fault.parameter);
  f.changed = uint64_t(std::llround(changed_));
  f.explained = together.found.explained / changed_, f.located = together.found.located / changed_;
  f.contradicted = same_ > 0 ? together.found.contradicted / same_ : 0;
  f.together = which > 0, f.left = left(up_to_it);
  f.fitted = fault.fault->search != Search::none && fault.fault->search != Search::one_of;
  f.alone = f.together ? judged({fault}, true).found.explained / changed_ : f.explained;
  f.proof = proof(up_to_it, before);
  if (f.proof.plane.empty() && which == 0 && faults.size() > 1) f.proof = proof(faults, faults.subspan(1));
  return f;
}

std::vector<Finding> PictureSearch::findings(std::span<const NamedFault> faults) const {
  std::vector<Finding> findings;
  for (size_t i = 0; i < faults.size(); ++i) findings.push_back(finding(faults, i));
  return findings;
}

/// Whether half of what a candidate explains may be chance: where values are off by a code, any factor near 1 is right
/// for many of them. Two faults explain more by chance than one.
///   cost_of_right: what the prediction without a fault costs
bool explains_by_chance(const PictureCandidate& c, double cost_of_right) {
  const auto near_one = [](const NamedFault& f) {
    return f.fault->search == Search::smooth && std::fabs(f.parameter.number - 1) < kNearOne;
  };
  return std::any_of(c.faults.begin(), c.faults.end(), near_one) &&
         c.found.cost > (c.faults.size() == 1 ? kLeftByFew : kLeftByTwo) * cost_of_right;
}

/// Those single faults that explain enough and cost about as little as the best, the best first. A dither explains
/// whatever is off by a code, so it comes after every fault that predicts values.
std::vector<PictureCandidate> PictureSearch::named(std::vector<PictureCandidate> singles) const {
  std::erase_if(singles, [&](const PictureCandidate& c) { return !explains(c) || explains_by_chance(c, cost_); });
  std::stable_sort(singles.begin(), singles.end(), [](const PictureCandidate& a, const PictureCandidate& b) {
    const bool dither_a = a.faults[0].fault->reach > 0, dither_b = b.faults[0].fault->reach > 0;
    return dither_a != dither_b ? dither_b : a.cost < b.cost;
  });
  if (singles.empty()) return singles;
  const double most = singles.front().cost + kPictureRival;
  std::erase_if(singles, [&](const PictureCandidate& c) { return c.cost > most; });
  return singles;
}

/// Whether two candidates predict different pixels anywhere in the sample; true where one supposes stale tiles, of
/// which it predicts nothing.
bool PictureSearch::told_apart(const PictureCandidate& a, const PictureCandidate& b) const {
  const PictureSupposition one = supposed(a.faults), other = supposed(b.faults);
  if (one.stale > 0 || other.stale > 0) return true;
  std::atomic<bool> differs = false;
  parallel_for(int(off_.size()), 0, [&](int i) {
    const auto [x, y, weight] = picture_.sample()[size_t(i)];
    if (!differs && picture_.predicted(one, x, y).stored != picture_.predicted(other, x, y).stored) differs = true;
  });
  return differs;
}

/// Findings about candidates that are ranked already: the first; those that no pixel tells from the first, marked as
/// tied, one for each fault; and then the others.
std::vector<Finding> PictureSearch::ranked(std::vector<PictureCandidate> singles) const {
  std::vector<Finding> first, others;
  std::vector<const PictureFault*> said;
  for (const PictureCandidate& c : singles) {
    const bool is_tied = !first.empty() && !told_apart(singles.front(), c);
    if (is_tied && std::find(said.begin(), said.end(), c.faults[0].fault) != said.end()) continue;
    std::vector<Finding>& list = first.empty() || is_tied ? first : others;
    list.push_back(finding(c.faults, 0)), list.back().tied = is_tied;
    said.push_back(c.faults[0].fault);
  }
  first.insert(first.end(), others.begin(), others.end());
  return first;
}

std::vector<Finding> PictureSearch::look() const {
  const auto by_cost = [](const PictureCandidate& a, const PictureCandidate& b) { return a.cost < b.cost; };
  const auto unproved = [](const Finding& f) { return f.proof.plane.empty(); };
  std::vector<PictureCandidate> singles = beside({});
  if (singles.empty()) return {};
  // Two faults: each of the likeliest with any other beside it.
  std::vector<PictureCandidate> pairs;
  if (singles.front().cost > 0.02)
    for (size_t i = 0; i < std::min(kFirstOfPicturePairs, singles.size()); ++i) {
      std::vector<PictureCandidate> both = beside(singles[i].faults);
      both.resize(std::min<size_t>(both.size(), 2));
      for (PictureCandidate& c : both) refine(c), pairs.push_back(std::move(c));
    }
  singles.resize(std::min(kFinalists, singles.size()));
  for (PictureCandidate& c : singles) c = judged(c.faults, true);
  for (PictureCandidate& c : pairs) c = judged(c.faults, true);
  std::stable_sort(pairs.begin(), pairs.end(), by_cost);
  const double best = std::min_element(singles.begin(), singles.end(), by_cost)->cost;
  if (!pairs.empty() && pairs.front().cost < std::min(kPicturePairGain * best, best - kLeastGain) &&
      explains(pairs.front()) && !explains_by_chance(pairs.front(), cost_)) {
    std::vector<Finding> both = findings(pairs.front().faults);
    if (std::none_of(both.begin(), both.end(), unproved)) return both;
  }
  std::vector<Finding> found = ranked(named(std::move(singles)));
  std::erase_if(found, unproved);
  return found;
}

}  // namespace

std::string name_of(const PictureFault& fault, const FaultParameter& parameter) { return fault_name(fault, parameter); }
std::string text_of(const PictureFault& fault, const FaultParameter& parameter) { return fault_text(fault, parameter); }

double changed_pixels(const PictureCase& picture) {
  double changed = 0;
  for (const SampledPixel& p : picture.sample())
    changed += picture.steps_off(picture.right(), p) >= kSameSteps ? p.weight : 0;
  return changed;
}

std::vector<Finding> picture_findings(PictureCase& picture, std::span<const NamedFault> only) {
  const PictureSearch search(picture);
  if (search.changed() < kLeastChanged) return {};
  picture.make_tiles();
  return only.empty() ? search.look() : search.findings(only);
}

}  // namespace trueshade::oracle
