#include "judge/diagnosis/picture_search.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "core/threads/parallel_for.h"
#include "judge/diagnosis/fault_estimate.h"

namespace trueshade::oracle {

namespace {

// Shares of the pixels that are not as they should be.
constexpr double kNamed = 1.0 / 3;        ///< that a finding explains at least
constexpr double kParameterCost = 0.004;  ///< what a parameter must earn
constexpr double kRival = 0.04;           ///< that a lesser finding may cost more than the best
constexpr double kPairGain = 0.55;        ///< of a single fault's cost, that two may cost at most
constexpr double kLeastGain = 0.02;       ///< and that a second fault must earn
constexpr double kLeastChanged = 8;       ///< pixels below which there is nothing to explain
constexpr size_t kFirstOfPairs = 5, kFinalists = 8;

struct Candidate {
  std::vector<NamedFault> faults;
  Disagreement found;
  double cost = 0;  ///< with what parameters and doubts cost, of the changed pixels
};

std::vector<const PictureFault*> all_faults() {
  std::vector<const PictureFault*> faults;
  for (const PictureFault& f : picture_value_faults()) faults.push_back(&f);
  for (const PictureFault& f : light_faults()) faults.push_back(&f);
  return faults;
}

class PictureSearch {
 public:
  explicit PictureSearch(PictureCase& picture) : picture_(picture) {
    off_few_ = off(picture.few()), off_ = off(picture.sample());
    for (size_t i = 0; i < off_.size(); ++i) changed_ += off_[i] >= kSameSteps ? picture.sample()[i].weight : 0;
    for (size_t i = 0; i < off_few_.size(); ++i)
      changed_few_ += off_few_[i] >= kSameSteps ? picture.few()[i].weight : 0;
  }

  double changed() const { return changed_; }
  std::vector<Finding> look() const;
  std::vector<Finding> suppose(std::span<const NamedFault> faults) const;

 private:
  std::vector<double> off(const std::vector<SampledPixel>& pixels) const;
  PictureSupposition supposed(std::span<const NamedFault> faults) const;
  Candidate judged(std::vector<NamedFault> faults, bool all) const { return judged(faults, supposed(faults), all); }
  Candidate judged(std::vector<NamedFault> faults, const PictureSupposition& supposed, bool all) const;
  std::vector<Candidate> beside(std::span<const NamedFault> faults) const;
  void refine(Candidate& candidate) const;
  Finding finding(const Candidate& candidate, size_t which) const;
  Proof proof(const PictureSupposition& supposed) const;

  PictureCase& picture_;
  std::vector<double> off_few_, off_;
  double changed_ = 0, changed_few_ = 0;
};

std::vector<double> PictureSearch::off(const std::vector<SampledPixel>& pixels) const {
  std::vector<double> steps(pixels.size());
  const PictureSupposition right = picture_.right();
  parallel_for(int(pixels.size()), 0, [&](int i) { steps[size_t(i)] = picture_.steps_off(right, pixels[size_t(i)]); });
  return steps;
}

PictureSupposition PictureSearch::supposed(std::span<const NamedFault> faults) const {
  PictureSupposition s = picture_.right();
  for (const NamedFault& f : faults) s.suppose(*f.fault, f.parameter);
  return s;
}

Candidate PictureSearch::judged(std::vector<NamedFault> faults, const PictureSupposition& supposed, bool all) const {
  Candidate c;
  c.found = picture_.disagreement(supposed, all ? picture_.sample() : picture_.few(), all ? off_ : off_few_);
  c.cost = c.found.cost / (all ? changed_ : changed_few_);
  for (const NamedFault& f : faults) {
    c.cost += f.fault->doubt + (f.fault->search != Search::none ? kParameterCost : 0);
    if (f.fault->stale > 0) c.cost += picture_.stale_cost(f.fault->stale);
  }
  c.faults = std::move(faults);
  return c;
}

/// Every fault beside those that are supposed, by a first look, the best first.
std::vector<Candidate> PictureSearch::beside(std::span<const NamedFault> faults) const {
  const std::vector<const PictureFault*> rows = all_faults();
  PictureSupposition base = supposed(faults);
  if (base.known == nullptr) base.known = std::make_shared<KnownPixels>();
  std::vector<std::vector<Candidate>> found(rows.size());
  parallel_for(int(rows.size()), 0, [&](int i) {
    const PictureFault& fault = *rows[size_t(i)];
    if (fault.can != nullptr && !fault.can(base.pass)) return;
    for (const NamedFault& f : faults)
      if (f.fault == &fault) return;
    for (const double parameter : likely_parameters(picture_, base, fault, picture_.few(), off_few_)) {
      std::vector<NamedFault> together(faults.begin(), faults.end());
      together.push_back({&fault, parameter});
      PictureSupposition both = base;
      both.suppose(fault, parameter);
      found[size_t(i)].push_back(judged(std::move(together), both, false));
    }
  });
  std::vector<Candidate> candidates;
  for (std::vector<Candidate>& of_row : found)
    for (Candidate& c : of_row) candidates.push_back(std::move(c));
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; });
  return candidates;
}

/// The parameters of two faults again, each beside the other.
void PictureSearch::refine(Candidate& candidate) const {
  for (size_t turn = 0; turn < candidate.faults.size(); ++turn) {
    NamedFault& fault = candidate.faults[turn];
    if (fault.fault->search != Search::smooth) continue;
    // What is supposed is predicted in order: a fault that is put last is one that the others do not change.
    PictureSupposition base = picture_.right();
    for (size_t i = 0; i < candidate.faults.size(); ++i)
      if (i != turn) base.suppose(*candidate.faults[i].fault, candidate.faults[i].parameter);
    for (const double parameter : likely_parameters(picture_, base, *fault.fault, picture_.few(), off_few_)) {
      std::vector<NamedFault> faults = candidate.faults;
      faults[turn].parameter = parameter;
      Candidate better = judged(std::move(faults), false);
      if (better.cost < candidate.cost) candidate = std::move(better);
    }
  }
}

/// The pixel that is farthest off where nothing is wrong, of those that the faults explain.
Proof PictureSearch::proof(const PictureSupposition& supposed) const {
  Proof proof;
  double farthest = 0;
  const PictureSupposition right = picture_.right();
  for (size_t i = 0; i < off_.size(); ++i) {
    const SampledPixel& pixel = picture_.sample()[i];
    if (off_[i] <= farthest || picture_.steps_off(supposed, pixel) >= kSameSteps) continue;
    farthest = off_[i];
    const PictureCase::Prediction should = picture_.predicted(right, pixel.x, pixel.y),
                                  does = picture_.predicted(supposed, pixel.x, pixel.y);
    double most = -1;
    for (int k = 0; k < picture_.channels(); ++k) {
      const double steps = picture_.steps_off(right, should, pixel.x, pixel.y, k);
      if (steps <= most) continue;
      most = steps;
      proof = {pixel.x,
               pixel.y,
               channel_of("color", k),
               picture_.given(pixel.x, pixel.y, k),
               should.stored[size_t(k)],
               does.stored[size_t(k)]};
    }
  }
  return proof;
}

Finding PictureSearch::finding(const Candidate& candidate, size_t which) const {
  const NamedFault& fault = candidate.faults[which];
  Finding f;
  f.name = name_of(*fault.fault, fault.parameter), f.plane = "picture", f.text = text_of(*fault.fault, fault.parameter);
  f.changed = uint64_t(std::llround(changed_));
  f.explained = candidate.found.explained / changed_;
  double same = 0;
  for (size_t i = 0; i < off_.size(); ++i) same += off_[i] < kSameSteps ? picture_.sample()[i].weight : 0;
  f.contradicted = same > 0 ? candidate.found.contradicted / same : 0;
  f.together = which > 0;
  f.proof = proof(supposed(candidate.faults));
  return f;
}

std::vector<Finding> PictureSearch::suppose(std::span<const NamedFault> faults) const {
  const Candidate candidate = judged({faults.begin(), faults.end()}, true);
  std::vector<Finding> findings;
  for (size_t i = 0; i < faults.size(); ++i) findings.push_back(finding(candidate, i));
  return findings;
}

std::vector<Finding> PictureSearch::look() const {
  const auto by_cost = [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; };
  std::vector<Candidate> singles = beside({});
  if (singles.empty()) return {};
  // Two faults: each of the likeliest with any other beside it.
  std::vector<Candidate> pairs;
  if (singles.front().cost > 0.02)
    for (size_t i = 0; i < std::min(kFirstOfPairs, singles.size()); ++i) {
      std::vector<Candidate> both = beside(singles[i].faults);
      both.resize(std::min<size_t>(both.size(), 2));
      for (Candidate& c : both) refine(c), pairs.push_back(std::move(c));
    }
  singles.resize(std::min(kFinalists, singles.size()));
  for (Candidate& c : singles) c = judged(c.faults, true);
  std::stable_sort(singles.begin(), singles.end(), by_cost);
  for (Candidate& c : pairs) c = judged(c.faults, true);
  std::stable_sort(pairs.begin(), pairs.end(), by_cost);
  const auto explains = [&](const Candidate& c) {
    return c.found.explained - c.found.contradicted >= kNamed * changed_;
  };
  std::vector<Finding> findings;
  const Candidate& best = singles.front();
  if (!pairs.empty() && pairs.front().cost < std::min(kPairGain * best.cost, best.cost - kLeastGain) &&
      explains(pairs.front())) {
    for (size_t i = 0; i < 2; ++i) findings.push_back(finding(pairs.front(), i));
    return findings;
  }
  for (const Candidate& c : singles)
    if (explains(c) && c.cost <= best.cost + kRival) findings.push_back(finding(c, 0));
  return findings;
}

}  // namespace

std::string name_of(const PictureFault& fault, double parameter) {
  return std::string(fault.name) + (fault.search == Search::none ? "" : "=" + parameter_word(fault, parameter));
}

std::string text_of(const PictureFault& fault, double parameter) {
  std::string text(fault.text);
  const size_t at = text.find("%s");
  if (at != std::string::npos)
    text.replace(at, 2, fault.says != nullptr ? fault.says(parameter) : parameter_text(parameter));
  return text;
}

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
  return only.empty() ? search.look() : search.suppose(only);
}

}  // namespace trueshade::oracle
