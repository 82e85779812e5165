#include "judge/diagnosis/fault_estimate.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>

#include "judge/diagnosis/changed_light.h"
#include "judge/diagnosis/least_squares.h"

namespace trueshade::oracle {

namespace {

constexpr size_t kMostVoters = 120;
constexpr double kRight = 1;  ///< a factor that changes nothing

/// Estimates the parameter of one fault. Borrows all that it is made from.
class Estimate {
 public:
  Estimate(const PictureCase& picture, const PictureSupposition& supposed, const PictureFault& fault,
           const std::vector<SampledPixel>& pixels, const std::vector<double>& off_if_right)
      : picture_(picture), supposed_(supposed), fault_(fault), pixels_(pixels), off_(off_if_right) {}

  /// What the pixels cost with the fault supposed beside the others.
  double cost(double parameter) const { return picture_.disagreement(with(parameter), pixels_, off_).cost; }
  std::vector<double> best_of(std::span<const double> starts, size_t most) const;
  double smooth() const;
  std::vector<double> lights(double sign) const;
  std::vector<double> counts(bool at_pixel) const;
  std::vector<FaultParameter> vectors() const;

 private:
  /// What is supposed, and this fault.
  PictureSupposition with(double parameter) const {
    PictureSupposition s = supposed_;
    s.suppose(fault_, parameter);
    return s;
  }
  struct Best {
    double parameter, cost;
  };
  /// Sets `best` to the parameter if that costs less.
  void better(double parameter, Best& best) const {
    const double c = cost(parameter);
    if (c < best.cost) best = {parameter, c};
  }
  void descend(double from, Best& best) const;
  double stepped(double parameter) const;
  double climbed(double count) const;
  double narrowed(double parameter) const;
  double short_number(double parameter) const;
  bool fits(const Color& value, const SampledPixel& pixel, double steps) const;
  template <class See>
  void each_voter(const See& see) const;

  const PictureCase& picture_;
  const PictureSupposition& supposed_;
  const PictureFault& fault_;
  const std::vector<SampledPixel>& pixels_;
  const std::vector<double>& off_;
};

/// The values of `starts` that cost least, at most `most`, the cheapest first.
std::vector<double> Estimate::best_of(std::span<const double> starts, size_t most) const {
  std::vector<std::pair<double, double>> tried;
  for (const double start : starts) tried.emplace_back(cost(start), start);
  std::stable_sort(tried.begin(), tried.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<double> best;
  for (size_t i = 0; i < std::min(most, tried.size()); ++i) best.push_back(tried[i].second);
  return best;
}

/// One step of least squares in the parameter's logarithm, each residual weighed by Cauchy's rule, so that pixels that
/// have another fault count for little.
double Estimate::stepped(double parameter) const {
  constexpr double kMove = 0.004;
  const bool codes = info(supposed_.pass.pipeline.target).number_class == NumberClass::unorm;
  const auto kept = [codes](double v) { return codes ? std::clamp(v, 0.0, 1.0) : v; };
  const PictureSupposition here = with(parameter), there = with(parameter * (1 + kMove));
  double numerator = 0, denominator = 0;
  for (size_t i = 0; i < pixels_.size(); ++i) {
    if (off_[i] < kSameSteps && i % 4 != 0) continue;
    const SampledPixel& p = pixels_[i];
    const PictureCase::Prediction a = picture_.predicted(here, p.x, p.y), b = picture_.predicted(there, p.x, p.y);
    const Color given = picture_.given_value(p.x, p.y);
    for (int k = 0; k < std::min(3, picture_.channels()); ++k) {
      const auto c = size_t(k);
      const double step = picture_.step_at(given[c], k), from = kept(a.value[c]);
      const double slope = (kept(b.value[c]) - from) / kMove / step, off = (given[c] - from) / step;
      if (!std::isfinite(off) || !std::isfinite(slope) || std::fabs(slope) < 1e-3) continue;
      const double scale = std::max(2.0, 0.1 * std::fabs(slope)), weight = p.weight / (1 + off * off / (scale * scale));
      numerator += weight * slope * off, denominator += weight * slope * slope;
    }
  }
  if (!(denominator > 0)) return parameter;
  return parameter * std::exp(std::clamp(numerator / denominator, -0.7, 0.7));
}

/// The best parameter within one percent of this one, by golden sections.
double Estimate::narrowed(double parameter) const {
  constexpr double kRatio = 0.6180339887498949;
  double low = parameter / 1.01, high = parameter * 1.01;
  double a = high - kRatio * (high - low), b = low + kRatio * (high - low), cost_a = cost(a), cost_b = cost(b);
  for (int i = 0; i < 8; ++i) {
    if (cost_a <= cost_b) {
      high = b, b = a, cost_b = cost_a;
      a = high - kRatio * (high - low), cost_a = cost(a);
    } else {
      low = a, a = b, cost_a = cost_b;
      b = low + kRatio * (high - low), cost_b = cost(b);
    }
  }
  const double best = cost_a <= cost_b ? a : b;
  return std::min(cost_a, cost_b) < cost(parameter) ? best : parameter;
}

/// The parameter rounded to as few digits as cost no more; as it is, where four digits cost more.
double Estimate::short_number(double parameter) const {
  const double least = cost(parameter);
  for (const int digits : {1, 2, 3, 4}) {
    const double unit = std::pow(10.0, std::floor(std::log10(std::fabs(parameter))) + 1 - digits);
    const double rounded = std::nearbyint(parameter / unit) * unit;
    if (rounded != 0 && rounded != 1 && cost(rounded) <= least) return rounded;
  }
  return parameter;
}

/// Goes by steps of least squares from a parameter, for as long as they lead elsewhere, and sets `best` to the cheapest
/// place on the way.
void Estimate::descend(double from, Best& best) const {
  for (int i = 0; i < 6; ++i) {
    const double next = stepped(from), moved = std::fabs(next / from - 1);
    from = next;
    if (next != kRight) better(next, best);
    if (moved < 1e-5) break;
  }
}

/// The factor that costs least, by least squares from the best of the fault's starts or from 1, then narrowed and
/// rounded. It may be one that comes no nearer than no fault.
double Estimate::smooth() const {
  const double if_right = picture_.disagreement(supposed_, pixels_, off_).cost;
  const double start = best_of(fault_.starts, 1).front();
  Best best{start, cost(start)};
  // What is nearly right is nearer to being right than to any of the starts.
  if (best.cost < if_right)
    descend(start, best);
  else
    descend(kRight, best);
  if (best.cost >= if_right) return best.parameter;  // it comes no nearer
  // Codes make steps of what should be smooth: a look about, before the best place is narrowed down.
  const double middle = best.parameter;
  for (const double percent : {0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 3.0, 5.0})
    for (const double sign : {-1.0, 1.0}) better(middle * (1 + sign * percent / 100), best);
  return short_number(narrowed(best.parameter));
}

/// Calls `see` with each pixel that is wrong and the surface that it shows, for at most kMostVoters pixels.
template <class See>
void Estimate::each_voter(const See& see) const {
  size_t voters = 0;
  for (size_t i = 0; i < pixels_.size() && voters < kMostVoters; ++i) {
    if (off_[i] < kSameSteps) continue;
    const SampledPixel& p = pixels_[i];
    const auto [x, y] = picture_.source(supposed_.move, p.x, p.y);
    const PlainSurface surface = picture_.surface(x, y);
    if (!surface.covered) continue;
    ++voters;
    see(p, surface);
  }
}

/// Whether a value, under the faults that change a finished color, is within `steps` of what was captured.
bool Estimate::fits(const Color& value, const SampledPixel& pixel, double steps) const {
  Color v = value;
  for (const PictureSupposition::Step& step : supposed_.steps) step.change(v, step.parameter, pixel.x, pixel.y);
  const Color given = picture_.given_value(pixel.x, pixel.y);
  for (int k = 0; k < std::min(3, picture_.channels()); ++k) {
    double at = v[size_t(k)];
    if (info(supposed_.pass.pipeline.target).number_class == NumberClass::unorm) at = std::clamp(at, 0.0, 1.0);
    if (std::fabs(at - given[size_t(k)]) > steps * picture_.step_at(given[size_t(k)], k)) return false;
  }
  return true;
}

/// The lights whose term times `sign`, added to what is predicted, makes wrong pixels as given: at most three, that of
/// the most pixels first, by their weights and among each_voter()'s alone. Empty where no light fits any pixel.
std::vector<double> Estimate::lights(double sign) const {
  const LightPass& pass = supposed_.pass;
  const bool blends = blends_lights(pass.pipeline.strategy);
  std::map<uint32_t, double> votes;
  each_voter([&](const SampledPixel& pixel, const PlainSurface& surface) {
    const PredictedPixel right = predicted_pixel(pass, surface);
    for (const LightAdded& added : lights_added(pass, surface)) {
      Color without = right.value;
      for (size_t k = 0; k < 3; ++k) without[k] += sign * added.term[k];
      if (fits(without, pixel, blends ? 1.6 : 0.8)) votes[added.light] += pixel.weight;
    }
  });
  std::vector<std::pair<double, double>> ranked;
  for (const auto& [light, weight] : votes) ranked.emplace_back(-weight, double(light));
  std::sort(ranked.begin(), ranked.end());
  std::vector<double> best;
  for (size_t i = 0; i < std::min<size_t>(3, ranked.size()); ++i) best.push_back(ranked[i].second);
  return best;
}

/// The vector that fits all pixels best, by least squares of their differences in steps of the format. Empty where the
/// best vector changes nothing.
std::vector<FaultParameter> Estimate::vectors() const {
  constexpr double kScales[] = {64, 8, 2, 0.5};
  const Residuals residuals = [&](const Triple3& vector) {
    PictureSupposition s = supposed_;
    s.suppose(fault_, FaultParameter(0, vector));
    std::vector<double> left;
    for (size_t i = 0; i < pixels_.size(); ++i) {
      const SampledPixel& p = pixels_[i];
      const PictureCase::Prediction now = picture_.predicted(s, p.x, p.y);
      const Color given = picture_.given_value(p.x, p.y);
      for (int k = 0; k < std::min(3, picture_.channels()); ++k)
        left.push_back((now.value[size_t(k)] - given[size_t(k)]) / picture_.step_at(given[size_t(k)], k));
    }
    return left;
  };
  const Triple3 start = {fault_.start, fault_.start, fault_.start};
  const Triple3 vector = fitted({residuals, fault_.numbers, 1e-3, kScales, fault_.start}, start);
  const auto is = [](double v) { return std::isfinite(v) && std::fabs(v) < 1e6; };
  if (vector == start || !std::all_of(vector.begin(), vector.end(), is)) return {};
  return {FaultParameter(0, vector)};
}

/// The number that people would write, of those from `low` to `high`.
double round_number(uint32_t low, uint32_t high) {
  for (uint32_t unit = 1u << 16; unit > 1; unit /= 2)
    if (const uint32_t n = (low + unit - 1) / unit * unit; n > 0 && n <= high) return double(n);
  return double(low);
}

/// How many lights are drawn, of the scene's or of those in range of a pixel: the counts by which the most wrong pixels
/// are as given. Empty where no count makes any of them so.
std::vector<double> Estimate::counts(bool at_pixel) const {
  const LightPass& pass = supposed_.pass;
  const auto all = uint32_t(pass.lights.size());
  LightPass dark = pass;
  dark.lights.clear();
  std::vector<double> change(all + 2);  // of votes, from one count to the next
  std::vector<TracedLight> trace;
  each_voter([&](const SampledPixel& pixel, const PlainSurface& surface) {
    Color sum = predicted_pixel(dark, surface).value;
    uint32_t from = 0, ordinal = 0;
    const auto vote = [&](uint32_t low, uint32_t high) {  // these counts leave `sum`
      if (low < high && fits(sum, pixel, 0.8)) change[low] += pixel.weight, change[high] -= pixel.weight;
    };
    trace.clear();
    predicted_pixel(pass, surface, nullptr, &trace);
    for (const TracedLight& traced : trace) {
      const uint32_t place = at_pixel ? ordinal : traced.light;  // the count above which the light is drawn
      if (traced.adds) {
        vote(from, place + 1);
        sum = traced.value, from = place + 1;
      }
      ordinal += traced.in_range ? 1 : 0;
    }
    vote(from, all + 1);
  });
  double votes = 0, most = 0;
  uint32_t low = 0, high = 0;
  for (uint32_t n = 0; n <= all; ++n) {
    votes += change[n];
    if (votes > most * (1 + 1e-9)) most = votes, low = high = n;
    if (votes >= most * (1 - 1e-9) && most > 0 && n == high + 1) high = n;
  }
  if (!(most > 0)) return {};
  return {climbed(round_number(low, high))};
}

/// The count that costs least near `count`, found by steps of 8, 4, 2 and 1.
double Estimate::climbed(double count) const {
  double least = cost(count);
  for (double step = 8; step >= 1; step /= 2)
    for (const double next : {count - step, count + step}) {
      if (next < 0 || next > double(supposed_.pass.lights.size())) continue;
      const double c = cost(next);
      if (c < least) least = c, count = next;
    }
  return count;
}

}  // namespace

std::vector<FaultParameter> likely_parameters(const PictureCase& picture, const PictureSupposition& supposed,
                                              const PictureFault& fault, const std::vector<SampledPixel>& pixels,
                                              const std::vector<double>& off_if_right) {
  const Estimate estimate(picture, supposed, fault, pixels, off_if_right);
  const auto numbers = [](const std::vector<double>& list) {
    return std::vector<FaultParameter>(list.begin(), list.end());
  };
  switch (fault.search) {
    case Search::none:
      return {0};
    case Search::one_of:
      return numbers(estimate.best_of(fault.starts, 2));
    case Search::smooth:
      return {estimate.smooth()};
    case Search::missing_light:
      return numbers(estimate.lights(-1));
    case Search::doubled_light:
      return numbers(estimate.lights(1));
    case Search::count:
      return numbers(estimate.counts(false));
    case Search::count_at_pixel:
      return numbers(estimate.counts(true));
    case Search::vector:
      return estimate.vectors();
    case Search::one_light:
      return changed_lights(picture, supposed, fault, pixels, off_if_right);
  }
  return {};  // unreachable: every enumerator returns above
}

}  // namespace trueshade::oracle
