#include "judge/stages/cause_fit.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace trueshade::oracle {

namespace {

using Vector = std::vector<double>;

struct Matrix {
  explicit Matrix(size_t n) : size(n), at(n * n, 0) {}
  size_t size;
  Vector at;
  double& operator()(size_t i, size_t j) { return at[i * size + j]; }
  double operator()(size_t i, size_t j) const { return at[i * size + j]; }
};

/// The normal equations, each cause scaled to unit length.
struct Equations {
  Matrix products;
  Vector right, length;
};

/// Deviations by cluster, and where each cluster begins; behind the last one their number.
struct Clusters {
  std::vector<const Deviation*> deviations;
  std::vector<size_t> first;
  size_t count() const { return first.size() - 1; }
  double weight(size_t c) const { return 1 / double(first[c + 1] - first[c]); }
};

Clusters clusters_of(std::span<const Deviation> deviations) {
  Clusters out;
  for (const Deviation& d : deviations) out.deviations.push_back(&d);
  std::stable_sort(out.deviations.begin(), out.deviations.end(),
                   [](const Deviation* a, const Deviation* b) { return a->cluster < b->cluster; });
  for (size_t i = 0; i < out.deviations.size(); ++i)
    if (i == 0 || out.deviations[i]->cluster != out.deviations[i - 1]->cluster) out.first.push_back(i);
  out.first.push_back(out.deviations.size());
  return out;
}

Equations equations_of(const Clusters& clusters, size_t causes) {
  Equations e{Matrix(causes), Vector(causes, 0), Vector(causes, 0)};
  for (size_t c = 0; c < clusters.count(); ++c)
    for (size_t i = clusters.first[c]; i < clusters.first[c + 1]; ++i) {
      const Deviation& d = *clusters.deviations[i];
      const double w = clusters.weight(c);
      for (size_t j = 0; j < causes; ++j) {
        e.right[j] += w * d.by_cause[j] * d.given;
        for (size_t k = 0; k <= j; ++k) e.products(j, k) += w * d.by_cause[j] * d.by_cause[k];
      }
    }
  for (size_t j = 0; j < causes; ++j) e.length[j] = std::sqrt(e.products(j, j));
  for (size_t j = 0; j < causes; ++j) {
    e.right[j] = e.length[j] > 0 ? e.right[j] / e.length[j] : 0;
    for (size_t k = 0; k <= j; ++k) {
      const double scale = e.length[j] * e.length[k];
      e.products(j, k) = e.products(k, j) = scale > 0 ? e.products(j, k) / scale : 0;
    }
  }
  return e;
}

/// The solution over the causes in `free`, by Gauss and Jordan; empty where there is none.
Vector solution(const Matrix& products, const std::vector<size_t>& free, Vector right) {
  const size_t n = free.size();
  Matrix a(n);
  for (size_t i = 0; i < n; ++i)
    for (size_t j = 0; j < n; ++j) a(i, j) = products(free[i], free[j]);
  constexpr double kSingular = 1e-6;  // of causes of unit length
  for (size_t p = 0; p < n; ++p) {
    size_t best = p;
    for (size_t i = p + 1; i < n; ++i)
      if (std::fabs(a(i, p)) > std::fabs(a(best, p))) best = i;
    if (!(std::fabs(a(best, p)) > kSingular)) return {};
    for (size_t j = 0; j < n; ++j) std::swap(a(p, j), a(best, j));
    std::swap(right[p], right[best]);
    for (size_t i = 0; i < n; ++i) {
      if (i == p) continue;
      const double times = a(i, p) / a(p, p);
      for (size_t j = p; j < n; ++j) a(i, j) -= times * a(p, j);
      right[i] -= times * right[p];
    }
  }
  for (size_t p = 0; p < n; ++p) right[p] /= a(p, p);
  return right;
}

/// Least squares within bounds: which causes are free is found by going to the solution of those that are, until a
/// bound stops one, and by freeing the cause that its bound holds hardest (Philip Stark and Robert Parker,
/// Bounded-Variable Least Squares, Computational Statistics 10, 1995). Causes are of unit length.
class BoundedFit {
 public:
  /// free_cause: has no bounds; kNone: all have
  BoundedFit(const Equations& e, std::span<const CauseBounds> bounds, size_t free_cause = kNone)
      : e_(e), x_(e.right.size(), 0), state_(e.right.size(), State::held) {
    for (size_t j = 0; j < x_.size(); ++j) {
      low_.push_back(j == free_cause ? -HUGE_VAL : bounds[j].low * e.length[j]);
      high_.push_back(j == free_cause ? HUGE_VAL : bounds[j].high * e.length[j]);
      if (low_[j] == high_[j] || !(e.length[j] > 0)) state_[j] = State::absent;
    }
    const size_t steps = 20 * x_.size();
    if (free_cause != kNone) state_[free_cause] = State::free;
    for (size_t i = 0; i < steps && go(); ++i) continue;
  }

  static constexpr size_t kNone = SIZE_MAX;

  const Vector& at() const { return x_; }
  std::vector<size_t> free() const {
    std::vector<size_t> out;
    for (size_t j = 0; j < x_.size(); ++j)
      if (state_[j] == State::free) out.push_back(j);
    return out;
  }

 private:
  enum class State : uint8_t { free, held, absent };

  /// The slope of half the sum of squares against cause j, negated: above 0, the sum falls where the cause grows.
  double gain(size_t j) const {
    double g = e_.right[j];
    for (size_t k = 0; k < x_.size(); ++k) g -= e_.products(j, k) * x_[k];
    return g;
  }

  /// One step: goes toward the solution of the free causes up to the first bound, or frees a cause. False at the end.
  bool go() {
    const std::vector<size_t> set = free();
    Vector right;
    for (const size_t j : set) {
      double r = e_.right[j];
      for (size_t k = 0; k < x_.size(); ++k)
        if (state_[k] != State::free) r -= e_.products(j, k) * x_[k];
      right.push_back(r);
    }
    const Vector to = solution(e_.products, set, std::move(right));
    if (to.empty() && !set.empty()) return last_freed_ != kNone && hold(last_freed_);  // it does what the others do
    double part = 1;
    std::optional<size_t> stops;
    for (size_t i = 0; i < set.size(); ++i) {
      const size_t j = set[i];
      const double bound = to[i] > high_[j] ? high_[j] : to[i] < low_[j] ? low_[j] : to[i];
      if (bound == to[i]) continue;
      const double share = to[i] == x_[j] ? 0 : (bound - x_[j]) / (to[i] - x_[j]);
      if (share < part || !stops) part = std::min(part, std::max(0.0, share)), stops = i;
    }
    for (size_t i = 0; i < set.size(); ++i) x_[set[i]] += part * (to[i] - x_[set[i]]);
    if (!stops) return free_one();
    const size_t j = set[*stops];
    x_[j] = to[*stops] > high_[j] ? high_[j] : low_[j];
    return hold(j);
  }

  bool hold(size_t j) {
    state_[j] = State::held;
    if (j == last_freed_ && ++refusals_ > x_.size()) return false;
    return true;
  }

  bool free_one() {
    constexpr double kStill = 1e-12;
    double most = kStill;
    std::optional<size_t> best;
    for (size_t j = 0; j < x_.size(); ++j) {
      if (state_[j] != State::held || (last_freed_ == j && refusals_ > 0)) continue;
      const double g = gain(j), pull = g > 0 && x_[j] < high_[j] ? g : g < 0 && x_[j] > low_[j] ? -g : 0;
      if (pull > most) most = pull, best = j;
    }
    if (!best) return false;
    state_[*best] = State::free, last_freed_ = *best;
    return true;
  }

  const Equations& e_;
  Vector x_, low_, high_;
  std::vector<State> state_;
  size_t last_freed_ = kNone, refusals_ = 0;
};

double pull_of(const Deviation& d, const Equations& e, const std::vector<size_t>& free, const Vector& row) {
  double pull = 0;
  for (size_t j = 0; j < free.size(); ++j) pull += row[j] * d.by_cause[free[j]] / e.length[free[j]];
  return pull;
}

/// The deviation that the causes predict if their sizes are x.
double told_of(const Deviation& d, const Equations& e, const Vector& x) {
  double told = 0;
  for (size_t j = 0; j < x.size(); ++j)
    if (e.length[j] > 0) told += x[j] * d.by_cause[j] / e.length[j];
  return told;
}

/// What a row of the inverse makes of the deviations that are left, and its variance: over clusters, of what is left of
/// each, or of its noise and what the causes' own bends make, where that is more.
struct Step {
  double size = 0, variance = 0;
};
constexpr double kBend = 0.1;  // of what the causes tell: they are taken to be linear, and are not quite
Step step_of(const Clusters& clusters, const Equations& e, const std::vector<size_t>& free, const Vector& row,
             const Vector& x) {
  Step sum;
  for (size_t c = 0; c < clusters.count(); ++c) {
    double left = 0, noise = 0;
    for (size_t i = clusters.first[c]; i < clusters.first[c + 1]; ++i) {
      const Deviation& d = *clusters.deviations[i];
      const double pull = clusters.weight(c) * pull_of(d, e, free, row), told = told_of(d, e, x);
      left += pull * (d.given - told), noise += pull * (d.noise + kBend * std::fabs(told));
    }
    sum.size += left, sum.variance += std::max(left * left, noise * noise);
  }
  return sum;
}

/// The variance over places of what is left where the causes in `free` are the likeliest, whatever their bounds.
struct Spread {
  double variance = 0;
  size_t places = 0;
};
Spread spread_over_places(const Clusters& clusters, const Equations& e, const std::vector<size_t>& free,
                          const Vector& row, const Vector& within) {
  Vector right;
  for (const size_t j : free) {
    double r = e.right[j];
    for (size_t k = 0; k < within.size(); ++k)
      if (std::find(free.begin(), free.end(), k) == free.end()) r -= e.products(j, k) * within[k];
    right.push_back(r);
  }
  const Vector to = solution(e.products, free, std::move(right));
  Vector x = within;
  for (size_t j = 0; j < to.size(); ++j) x[free[j]] = to[j];
  std::map<uint32_t, double> left;
  for (size_t c = 0; c < clusters.count(); ++c)
    for (size_t i = clusters.first[c]; i < clusters.first[c + 1]; ++i) {
      const Deviation& d = *clusters.deviations[i];
      left[d.place] += clusters.weight(c) * pull_of(d, e, free, row) * (d.given - told_of(d, e, x));
    }
  Spread spread{0, left.size()};
  for (const auto& [place, sum] : left) spread.variance += sum * sum;
  return spread;
}

}  // namespace

// A t distribution's deviations that are as rare as a normal one's (David Wallace, Bounds on Normal Approximations to
// Student's and the Chi-Square Distributions, Annals of Mathematical Statistics 30, 1959).
double CauseEstimate::error_at(double deviations) const {
  if (places < 2) return HUGE_VAL;
  const auto freedom = double(places - 1);
  const double student = std::sqrt(freedom * std::expm1(deviations * deviations / freedom));
  return std::max(error, error_of_places * student / deviations);
}

double left_within(std::span<const Deviation> deviations, std::span<const CauseBounds> bounds) {
  const Clusters clusters = clusters_of(deviations);
  const Equations e = equations_of(clusters, bounds.size());
  const BoundedFit fit(e, bounds);
  double sum = 0;
  for (size_t c = 0; c < clusters.count(); ++c)
    for (size_t i = clusters.first[c]; i < clusters.first[c + 1]; ++i) {
      const Deviation& d = *clusters.deviations[i];
      const double left = d.given - told_of(d, e, fit.at());
      sum += clusters.weight(c) * left * left;
    }
  return sum;
}

std::vector<CauseEstimate> estimate_causes(std::span<const Deviation> deviations, std::span<const CauseBounds> bounds) {
  const size_t causes = bounds.size();
  const Clusters clusters = clusters_of(deviations);
  const Equations e = equations_of(clusters, causes);
  std::vector<CauseEstimate> out(causes, {0, 0, HUGE_VAL});
  const BoundedFit within(e, bounds);
  for (size_t cause = 0; cause < causes; ++cause) {
    if (!(e.length[cause] > 0)) continue;
    out[cause].value = BoundedFit(e, bounds, cause).at()[cause] / e.length[cause];
    std::vector<size_t> free = within.free();
    std::erase(free, cause);
    free.push_back(cause);
    Vector unit(free.size(), 0);
    unit.back() = 1;
    const Vector row = solution(e.products, free, std::move(unit));
    if (row.empty()) continue;
    const Step step = step_of(clusters, e, free, row, within.at());
    out[cause].error = std::sqrt(step.variance) / e.length[cause];
    out[cause].beyond = std::fabs(step.size) / e.length[cause];
    const Spread spread = spread_over_places(clusters, e, free, row, within.at());
    out[cause].error_of_places = std::sqrt(spread.variance) / e.length[cause], out[cause].places = spread.places;
  }
  return out;
}

}  // namespace trueshade::oracle
