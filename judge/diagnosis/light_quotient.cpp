#include "judge/diagnosis/light_quotient.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "core/json_number.h"
#include "core/json_string.h"
#include "judge/diagnosis/known_falloffs.h"
#include "judge/diagnosis/picture_case.h"
#include "judge/diagnosis/plain_program.h"

namespace trueshade::oracle {

namespace {

constexpr double kLeastExplained = 0.5;  // of the difference, before anything is said
constexpr double kSlack = 1.15;          // a named curve may leave so much more than the free one

/// One light at one pixel.
struct Share {
  uint32_t light = 0;
  Triple3 term{};                   ///< what it should add
  double d = 0;                     ///< scene units; 0 of a light without a place
  double part = 0, nl = 0, nh = 0;  ///< d / range; cosines
};

struct Pixel {
  PlainSurface surface;
  Triple3 off{}, weight{};  ///< what is given minus what is right; 1 / error^2, 0 where the channel says nothing
  std::vector<Share> lights;
};

/// A quantity that a term may depend on, and its edges; outside these a factor stays 1.
struct Quantity {
  const char* name;
  double (*of)(const Share&);
  std::vector<double> edges;
};

constexpr double kPi = 3.14159265358979323846;

/// Equal steps, of cosines equal steps of the angle: what is sharp is sharp near 1.
std::vector<double> equal_steps(double from, double to, size_t count) {
  std::vector<double> edges(count + 1);
  for (size_t i = 0; i <= count; ++i) edges[i] = from + (to - from) * double(i) / double(count);
  return edges;
}
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

std::string number_text(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", x);
  return text;
}

class QuotientFit {
 public:
  QuotientFit(const Scene& scene, const Pipeline& pipeline, const Profile& profile, const Capture& capture,
              const StageVerdict& lighting)
      : scene_(scene), case_(scene, pipeline, profile, capture, lighting), pass_(light_pass_of(scene, pipeline)) {
    for (const SampledPixel& at : case_.sample()) add(at.x, at.y);
    before_ = error_with([](const Share&) { return 0.0; });
  }

  std::optional<LightQuotient> best() const {
    if (!(before_ > 0)) return std::nullopt;
    std::optional<LightQuotient> out = missing_lights();
    for (const Quantity& quantity : quantities()) {
      LightQuotient fit = fit_of(quantity);
      if (!out || fit.left < 0.9 * out->left) out = std::move(fit);
    }
    if (!(out->left <= kLeastExplained)) return std::nullopt;
    if (out->text.empty()) describe(*out);
    return out;
  }

 private:
  void add(int x, int y) {
    Pixel pixel;
    pixel.surface = case_.surface(x, y);
    if (!pixel.surface.covered || pixel.surface.unlit) return;
    const PredictedPixel right = predicted_pixel(pass_, pixel.surface);
    const Color given = case_.given_value(x, y);
    for (size_t k = 0; k < 3 && int(k) < case_.channels(); ++k) {
      const double step = case_.step_at(given[k], int(k));
      pixel.off[k] = given[k] - right.value[k];
      const double error = step / 2 + 1e-3 * std::max(std::fabs(given[k]), std::fabs(right.value[k]));
      const bool is_held = info(pass_.pipeline.target).number_class == NumberClass::unorm &&
                           (given[k] + step > 1 || right.value[k] + step > 1);
      pixel.weight[k] = is_held || !std::isfinite(pixel.off[k]) ? 0 : 1 / (error * error);
    }
    for (const LightAdded& added : lights_added(pass_, pixel.surface)) pixel.lights.push_back(share(pixel, added));
    if (!pixel.lights.empty()) pixels_.push_back(std::move(pixel));
  }

  Share share(const Pixel& pixel, const LightAdded& added) const {
    const Light& light = scene_.lights[added.light];
    Share s{added.light, added.term};
    if (light.type == LightType::ambient) return s;
    const bool is_placed = light.type != LightType::directional;
    const Triple3 way = is_placed ? minus(triple(light.position), pixel.surface.position) : times(triple(light.direction), -1);
    if (is_placed) s.d = std::sqrt(inner(way, way)), s.part = s.d / double(light.range);
    const Triple3 n = unit(pixel.surface.normal), l = unit(way);
    s.nl = inner(n, l);
    s.nh = inner(n, unit(plus(l, unit(minus(triple(scene_.camera.eye), pixel.surface.position)))));
    return s;
  }

  /// Squares of what is left, in errors, where each term is changed by a part of it.
  template <class Part>
  double error_with(const Part& part) const {
    double sum = 0;
    for (const Pixel& p : pixels_) {
      Triple3 off = p.off;
      for (const Share& s : p.lights) off = minus(off, times(s.term, part(s)));
      for (size_t k = 0; k < 3; ++k) sum += p.weight[k] * off[k] * off[k];
    }
    return sum;
  }
  double left_of(double error) const { return std::sqrt(std::max(error, 0.0) / before_); }

  std::vector<Quantity> quantities() const {
    double most = 1;
    for (const Pixel& p : pixels_)
      for (const Share& s : p.lights) most = std::isfinite(s.part) ? std::max(most, s.part) : most;
    return {{"d / range", [](const Share& s) { return s.d > 0 ? s.part : -1; }, equal_steps(0, most + 1e-9, 16)},
            {"N.L", [](const Share& s) { return s.nl; }, equal_steps(-1e-9, 1 + 1e-6, 16)},
            {"N.H", [](const Share& s) { return s.nh; },
             cosines({90, 75, 60, 50, 40, 32, 26, 21, 17, 14, 11, 8, 6, 4, 3, 2, 1, 0})}};
  }

  LightQuotient fit_of(const Quantity& quantity) const {
    const size_t n = quantity.edges.size() - 1;
    const auto step_of = [&](const Share& s) {
      const double x = quantity.of(s);
      if (s.nl == 0 || !(x >= quantity.edges.front() && x < quantity.edges.back())) return n;
      return size_t(std::upper_bound(quantity.edges.begin(), quantity.edges.end(), x) - quantity.edges.begin()) - 1;
    };
    const std::vector<double> change = change_by(n, step_of);
    LightQuotient out;
    out.against = quantity.name;
    std::vector<size_t> seen(n + 1);
    for (const Pixel& p : pixels_)
      for (const Share& s : p.lights) ++seen[step_of(s)];
    for (size_t i = 0; i < n; ++i)
      if (seen[i] >= kLeastSeen) out.curve.push_back({quantity.edges[i], quantity.edges[i + 1], 1 + change[i]});
    out.left = left_of(error_with([&](const Share& s) {
      const size_t step = step_of(s);
      return step < n ? change[step] : 0.0;
    }));
    return out;
  }

  /// The part by which the terms of each of n kinds are changed, by least squares.
  template <class Kind>
  std::vector<double> change_by(size_t n, const Kind& kind) const {
    std::vector<double> a(n * n), b(n);
    std::vector<Triple3> sum(n);
    for (const Pixel& p : pixels_) {
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
    return solved(std::move(a), std::move(b));
  }

  /// Lights that are there at some pixels and missing at others, as behind what stands in their way.
  std::optional<LightQuotient> missing_lights() const {
    constexpr size_t kStrongest = 4;
    std::vector<double> asked(scene_.lights.size()), missing(scene_.lights.size());
    double error = 0;
    for (const Pixel& p : pixels_) {
      std::vector<Share> strongest = p.lights;
      std::sort(strongest.begin(), strongest.end(), [](const Share& a, const Share& b) {
        return inner(a.term, a.term) > inner(b.term, b.term);
      });
      strongest.resize(std::min(strongest.size(), kStrongest));
      size_t best = 0;
      double least = HUGE_VAL;
      for (size_t set = 0; set < size_t(1) << strongest.size(); ++set) {
        double left = 0;
        for (size_t k = 0; k < 3; ++k) {
          double off = p.off[k];
          for (size_t i = 0; i < strongest.size(); ++i) off += (set >> i & 1) != 0 ? strongest[i].term[k] : 0;
          left += p.weight[k] * off * off;
        }
        if (left < least) least = left, best = set;
      }
      error += least;
      for (size_t i = 0; i < strongest.size(); ++i)
        asked[strongest[i].light] += 1, missing[strongest[i].light] += (best >> i & 1) != 0;
    }
    LightQuotient out;
    out.against = "light", out.left = left_of(error);
    // Sixteen sets to choose from fit much by chance: what is left must be next to nothing.
    if (!(out.left < 0.15)) return std::nullopt;
    for (size_t i = 0; i < asked.size(); ++i)
      if (asked[i] >= kLeastSeen)
        out.curve.push_back({double(i), double(i), 1 - missing[i] / asked[i]});
    out.text = missing_text(out.curve);
    return out.text.empty() ? std::nullopt : std::optional(out);
  }

  static std::string missing_text(const std::vector<LightQuotient::Step>& curve) {
    std::vector<LightQuotient::Step> most = curve;
    std::erase_if(most, [](const auto& s) { return s.factor > 0.97; });
    std::stable_sort(most.begin(), most.end(), [](const auto& a, const auto& b) { return a.factor < b.factor; });
    std::string text;
    for (size_t i = 0; i < std::min<size_t>(3, most.size()); ++i) {
      const std::string light = "light " + number_text(most[i].from);
      const std::string share = number_text(100 * (1 - most[i].factor));
      text += (i > 0 ? "; " : "") + light +
              (most[i].factor < 0.03 ? " is missing" : " is missing at " + share + " % of the pixels that it should light, as in a shadow");
    }
    if (most.size() > 3) text += "; and so are " + std::to_string(most.size() - 3) + " more";
    return text;
  }

  void describe(LightQuotient& q) const {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (const auto& step : q.curve) low = std::min(low, step.factor), high = std::max(high, step.factor);
    if (high - low < 0.02 * std::fabs(high)) {
      q.text = "all light is " + number_text((low + high) / 2) + " times what it should be";
    } else if (q.against[0] == 'd') {
      q.text = falloff_text(q);
    } else if (q.against == "N.L") {
      q.text = "another diffuse term: it differs most where N.L is " + place_text(q);
    } else {
      q.text = "another highlight: it differs most where N.H is " + place_text(q);
    }
  }

  /// Where the factor is farthest from 1, and how large it is.
  static std::string place_text(const LightQuotient& q) {
    const auto far = [](const LightQuotient::Step& s) { return std::fabs(std::log(std::max(s.factor, 1e-3))); };
    const auto most = std::max_element(q.curve.begin(), q.curve.end(),
                                       [&](const auto& a, const auto& b) { return far(a) < far(b); });
    return number_text((most->from + most->to) / 2) + ", by a factor of " + number_text(most->factor);
  }

  std::string falloff_text(const LightQuotient& q) const {
    const KnownFalloff* ours = own_falloff();
    const KnownFalloff* best = nullptr;
    double least = HUGE_VAL, scale = 1;
    for (const KnownFalloff& theirs : known_falloffs()) {
      if (ours == nullptr || &theirs == ours) continue;
      const auto ratio = [&](const Share& s) {
        const Light& light = scene_.lights[s.light];
        return s.d > 0 ? theirs.at(s.d, light) / ours->at(s.d, light) : 1.0;
      };
      // The scale by least squares: off + sum of terms is scale times the sum of terms times the ratio.
      double above = 0, below = 0;
      for (const Pixel& p : pixels_) {
        Triple3 there = p.off, made{};
        for (const Share& s : p.lights) there = plus(there, s.term), made = plus(made, times(s.term, ratio(s)));
        for (size_t k = 0; k < 3; ++k)
          above += p.weight[k] * there[k] * made[k], below += p.weight[k] * made[k] * made[k];
      }
      const double by = below > 0 ? above / below : 1;
      const double left = left_of(error_with([&](const Share& s) { return by * ratio(s) - 1; }));
      if (left < least) least = left, best = &theirs, scale = by;
    }
    if (best == nullptr || least > kSlack * q.left + 0.02) return "another falloff: the factor goes from " + ends_text(q);
    const std::string times = std::fabs(scale - 1) < 0.02 ? "" : number_text(scale) + " times ";
    return "as if the falloff were " + times + std::string(best->text) + ", where it is " + std::string(ours->text);
  }

  static std::string ends_text(const LightQuotient& q) {
    return number_text(q.curve.front().factor) + " at " + number_text(q.curve.front().to) + " of the range to " +
           number_text(q.curve.back().factor) + " at " + number_text(q.curve.back().from);
  }

  /// The known falloff that the right light pass has: a light is moved along its way to a pixel and asked again.
  const KnownFalloff* own_falloff() const {
    for (const KnownFalloff& known : known_falloffs()) {
      size_t same = 0, asked = 0;
      for (size_t i = 0; i < pixels_.size() && asked < 8; i += 1 + pixels_.size() / 8) {
        const Share& s = pixels_[i].lights[0];
        if (!(s.d > 0) || !(s.part < 0.8)) continue;
        ++asked, same += moves_like(known, pixels_[i], s);
      }
      if (asked > 0 && same == asked) return &known;
    }
    return nullptr;
  }

  bool moves_like(const KnownFalloff& known, const Pixel& pixel, const Share& s) const {
    LightPass moved = pass_;
    Light& light = moved.lights[s.light];
    const Triple3 way = minus(triple(light.position), pixel.surface.position);
    for (const double by : {0.5, 0.8, 1.2}) {
      for (size_t k = 0; k < 3; ++k) light.position[int(k)] = float(pixel.surface.position[k] + by * way[k]);
      const double wanted = known.at(by * s.d, light) / known.at(s.d, light);
      double made = 0;
      for (const LightAdded& added : lights_added(moved, pixel.surface))
        if (added.light == s.light) made = (added.term[0] + added.term[1] + added.term[2]) / (s.term[0] + s.term[1] + s.term[2]);
      if (std::fabs(made - wanted) > 2e-3 * wanted) return false;
    }
    return true;
  }

  static constexpr size_t kLeastSeen = 8;
  const Scene& scene_;
  const PictureCase case_;
  const LightPass pass_;
  std::vector<Pixel> pixels_;
  double before_ = 0;
};

}  // namespace

std::optional<LightQuotient> light_quotient(const Scene& scene, const Pipeline& pipeline, const Profile& profile,
                                            const Capture& capture, const StageVerdict& lighting) {
  if (blends_lights(pipeline.strategy) || lighting.count(PixelClass::violation) == 0) return std::nullopt;
  if (pipeline.light_program.used() && PlainProgram(scene, pipeline).defines_finish()) return std::nullopt;
  const QuotientFit fit(scene, pipeline, profile, capture, lighting);
  return fit.best();
}

std::string quotient_json(const LightQuotient& q) {
  std::string json = "{\"against\":" + json_string(q.against) + ",\"curve\":[";
  for (const LightQuotient::Step& step : q.curve)
    json += std::string(&step == q.curve.data() ? "" : ",") + "{\"from\":" + json_in_nine_digits(step.from) +
            ",\"to\":" + json_in_nine_digits(step.to) + ",\"factor\":" + json_in_nine_digits(step.factor) + "}";
  return json + "],\"left\":" + json_in_nine_digits(q.left) + ",\"text\":" + json_string(q.text) + "}";
}

}  // namespace trueshade::oracle
