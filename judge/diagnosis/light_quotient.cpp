#include "judge/diagnosis/light_quotient.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "core/json_number.h"
#include "core/json_string.h"
#include "judge/diagnosis/falloff_name.h"
#include "judge/diagnosis/missing_lights.h"
#include "judge/diagnosis/plain_program.h"

namespace trueshade::oracle {

namespace {

constexpr double kMostLeft = 0.5;  // of the difference, before anything is said
constexpr size_t kLeastSeen = 8;   // pixels of a step

/// A quantity that a term may depend on, and its edges; outside these a factor stays 1.
struct Quantity {
  const char* name;
  double (*of)(const Share&);
  std::vector<double> edges;
};

constexpr double kPi = 3.14159265358979323846;

/// The edges of `count` equal steps.
std::vector<double> equal_steps(double from, double to, size_t count) {
  std::vector<double> edges(count + 1);
  for (size_t i = 0; i <= count; ++i) edges[i] = from + (to - from) * double(i) / double(count);
  return edges;
}
/// Edges at the cosines of these angles, of which the first is 90 and the last 0: what is sharp is sharp near 1.
std::vector<double> cosines(std::initializer_list<double> degrees) {
  std::vector<double> edges;
  for (const double d : degrees) edges.push_back(std::cos(d * kPi / 180));
  edges.front() = -1e-9, edges.back() = 1 + 1e-6;
  return edges;
}

/// Solves (a + ridge) x = b by Cholesky's factors; `a` is symmetric, row by row.
std::vector<double> solved(std::vector<double> a, std::vector<double> b) {
  const size_t n = b.size();
  double trace = 0;
  for (size_t i = 0; i < n; ++i) trace += a[i * n + i];
  for (size_t i = 0; i < n; ++i) a[i * n + i] += 1e-6 * trace / double(n) + 1e-300;
  for (size_t j = 0; j < n; ++j) {
    for (size_t k = 0; k < j; ++k)
      for (size_t i = j; i < n; ++i) a[i * n + j] -= a[i * n + k] * a[j * n + k];
    const double root = std::sqrt(a[j * n + j]);
    for (size_t i = j; i < n; ++i) a[i * n + j] /= root;
  }
  for (size_t i = 0; i < n; ++i) {
    for (size_t k = 0; k < i; ++k) b[i] -= a[i * n + k] * b[k];
    b[i] /= a[i * n + i];
  }
  for (size_t i = n; i-- > 0;) {
    for (size_t k = i + 1; k < n; ++k) b[i] -= a[k * n + i] * b[k];
    b[i] /= a[i * n + i];
  }
  return b;
}

/// Solves what solved() does, by changes of at least -1: no light's term turns round. Murty's principal pivoting: of
/// the changes that are below, and of those held at -1 that would grow, the last one changes its side, until there is
/// none.
std::vector<double> solved_with_light(const std::vector<double>& a, const std::vector<double>& b) {
  constexpr double kNoLight = -1;
  constexpr int kMostPivots = 1000;
  const size_t n = b.size();
  std::vector<uint8_t> held(n);
  std::vector<double> x;
  for (int pivot = 0; pivot < kMostPivots; ++pivot) {
    std::vector<double> left = a, right = b;
    for (size_t i = 0; i < n; ++i)
      for (size_t j = 0; j < n; ++j) {
        if (held[j] != 0 && held[i] == 0) right[i] -= a[i * n + j] * kNoLight;
        if (held[i] != 0 || held[j] != 0) left[i * n + j] = i == j ? a[i * n + i] : 0;
      }
    for (size_t i = 0; i < n; ++i)
      if (held[i] != 0) right[i] = a[i * n + i] * kNoLight;
    x = solved(std::move(left), std::move(right));
    for (size_t i = 0; i < n; ++i)
      if (held[i] != 0) x[i] = kNoLight;
    size_t turned = n;
    for (size_t i = 0; i < n; ++i) {
      double grows = b[i];
      for (size_t j = 0; j < n; ++j) grows -= a[i * n + j] * x[j];
      if (held[i] != 0 ? grows > 0 : x[i] < kNoLight) turned = i;
    }
    if (turned == n) return x;
    held[turned] = held[turned] == 0 ? 1 : 0;
  }
  for (double& change : x) change = std::max(change, kNoLight);
  return x;
}

/// Fits factors of the lights' terms against each quantity.
class QuotientFit {
 public:
  QuotientFit(const Scene& scene, const Pipeline& pipeline, const Profile& profile, const Capture& capture,
              const StageVerdict& lighting)
      : shares_(scene, pipeline, profile, capture, lighting) {}

  /// The quotient that leaves least, with its text; nothing where it leaves more than kMostLeft, or has no factor but
  /// 1.
  std::optional<LightQuotient> best() const {
    if (!shares_.differs()) return std::nullopt;
    std::optional<LightQuotient> out = missing_lights(shares_);
    for (const Quantity& quantity : quantities()) {
      LightQuotient fit = fit_of(quantity);
      if (quantity.name[0] == 'd') name_falloff(shares_, fit);
      if (!out || fit.left < 0.9 * out->left) out = std::move(fit);
    }
    if (!(out->left <= kMostLeft)) return std::nullopt;
    if (out->text.empty()) describe(*out);
    return is_right(*out) ? std::nullopt : out;
  }

 private:
  /// The quantities that are tried, with their edges.
  std::vector<Quantity> quantities() const {
    double most = 1;
    for (const SharedPixel& p : shares_.pixels())
      for (const Share& s : p.lights) most = std::isfinite(s.part) ? std::max(most, s.part) : most;
    return {{"d / range", [](const Share& s) { return s.d > 0 ? s.part : -1; }, equal_steps(0, most + 1e-9, 16)},
            {"N.L", [](const Share& s) { return s.nl; }, equal_steps(-1e-9, 1 + 1e-6, 16)},
            {"N.H", [](const Share& s) { return s.nh; },
             cosines({90, 75, 60, 50, 40, 32, 26, 21, 17, 14, 11, 8, 6, 4, 3, 2, 1, 0})}};
  }

  /// The factors against one quantity, by least squares. A step that fewer than kLeastSeen terms are in has none, and
  /// without two steps `left` stays 1.
  LightQuotient fit_of(const Quantity& quantity) const {
    const size_t n = quantity.edges.size() - 1;
    const auto step_of = [&](const Share& s) {
      const double x = quantity.of(s);
      if (s.nl == 0 || !(x >= quantity.edges.front() && x < quantity.edges.back())) return n;
      return size_t(std::upper_bound(quantity.edges.begin(), quantity.edges.end(), x) - quantity.edges.begin()) - 1;
    };
    std::vector<double> change = change_by(n, step_of);
    LightQuotient out;
    out.against = quantity.name;
    std::vector<size_t> seen(n + 1);
    for (const SharedPixel& p : shares_.pixels())
      for (const Share& s : p.lights)
        if (LightShares::squared(p, s.term) > 0) ++seen[step_of(s)];  // not where the picture is as bright as it can be
    for (size_t i = 0; i < n; ++i)
      if (seen[i] >= kLeastSeen)
        out.curve.push_back({quantity.edges[i], quantity.edges[i + 1], 1 + change[i]});
      else
        change[i] = 0;
    if (out.curve.size() < 2) return out;  // which leaves all
    out.left = shares_.left_of(shares_.error_with([&](const Share& s) {
      const size_t step = step_of(s);
      return step < n ? change[step] : 0.0;
    }));
    return out;
  }

  /// The part by which the terms of each of n kinds are changed, by least squares; -1 at least.
  template <class Kind>
  std::vector<double> change_by(size_t n, const Kind& kind) const {
    std::vector<double> a(n * n), b(n);
    std::vector<Triple3> sum(n);
    for (const SharedPixel& p : shares_.pixels()) {
      std::fill(sum.begin(), sum.end(), Triple3{});
      for (const Share& s : p.lights)
        if (const size_t i = kind(s); i < n) sum[i] = plus(sum[i], s.term);
      for (size_t k = 0; k < 3; ++k)
        for (size_t i = 0; i < n; ++i) {
          b[i] += p.weight[k] * sum[i][k] * p.off[k];
          for (size_t j = 0; j <= i; ++j) a[i * n + j] += p.weight[k] * sum[i][k] * sum[j][k];
        }
    }
    for (size_t i = 0; i < n; ++i)
      for (size_t j = 0; j < i; ++j) a[j * n + i] = a[i * n + j];
    return solved_with_light(a, b);
  }

  /// Whether a quotient has no factor but 1, so that something other than light is wrong.
  static bool is_right(const LightQuotient& q) {
    constexpr double kOff = 0.005;
    return q.against != "light" && std::all_of(q.curve.begin(), q.curve.end(), [](const LightQuotient::Step& step) {
             return std::fabs(step.factor - 1) < kOff;
           });
  }

  /// Sets the text from the curve, in place of any that is there. The curve has a step or more.
  void describe(LightQuotient& q) const {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (const auto& step : q.curve) low = std::min(low, step.factor), high = std::max(high, step.factor);
    if (high - low < 0.02 * std::fabs(high)) {
      q.text = "all light is " + digits((low + high) / 2) + " times what it should be";
    } else if (q.against[0] == 'd') {
      q.text = "another falloff: the factor goes from " + ends_text(q);
    } else if (q.against == "N.L") {
      q.text = "another diffuse term: it differs most where N.L is " + place_text(q);
    } else {
      q.text = "another highlight: it differs most where N.H is " + place_text(q);
    }
  }

  static double middle(const LightQuotient::Step& step) { return (step.from + step.to) / 2; }

  /// Where the factor is farthest from 1, and how large it is.
  static std::string place_text(const LightQuotient& q) {
    const auto far = [](const LightQuotient::Step& s) { return std::fabs(std::log(std::max(s.factor, 1e-3))); };
    const auto most =
        std::max_element(q.curve.begin(), q.curve.end(), [&](const auto& a, const auto& b) { return far(a) < far(b); });
    return digits(middle(*most)) + ", by a factor of " + digits(most->factor);
  }

  /// The factors at both ends of the curve.
  static std::string ends_text(const LightQuotient& q) {
    return digits(q.curve.front().factor) + " at " + digits(middle(q.curve.front())) + " of the range to " +
           digits(q.curve.back().factor) + " at " + digits(middle(q.curve.back()));
  }

  const LightShares shares_;
};

}  // namespace

std::optional<LightQuotient> light_quotient(const Scene& scene, const Pipeline& pipeline, const Profile& profile,
                                            const Capture& capture, const StageVerdict& lighting) {
  if (blends_lights(pipeline.strategy) || lighting.count(PixelClass::violation) == 0) return std::nullopt;
  if (pipeline.light_program.used() && PlainProgram(scene, pipeline).defines_finish()) return std::nullopt;
  const QuotientFit fit(scene, pipeline, profile, capture, lighting);
  return fit.best();
}

std::string digits(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", x);
  return text;
}

std::string quotient_json(const LightQuotient& q) {
  std::string json = "{\"against\":" + json_string(q.against) + ",\"curve\":[";
  for (const LightQuotient::Step& step : q.curve)
    json += std::string(&step == q.curve.data() ? "" : ",") + "{\"from\":" + json_in_nine_digits(step.from) +
            ",\"to\":" + json_in_nine_digits(step.to) + ",\"factor\":" + json_in_nine_digits(step.factor) + "}";
  return json + "],\"left\":" + json_in_nine_digits(q.left) + ",\"text\":" + json_string(q.text) + "}";
}

}  // namespace trueshade::oracle
