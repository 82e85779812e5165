#include "judge/diagnosis/changed_light.h"

#include <algorithm>
#include <cmath>

#include "judge/diagnosis/least_squares.h"
#include "judge/diagnosis/predicted_term.h"
#include "scenes/pipeline/light_mesh.h"

namespace trueshade::oracle {

namespace {

constexpr size_t kMostLights = 1024;  ///< of a scene that are tried
constexpr size_t kTerms = 8000;       ///< lights and pixels together, by which the lights are chosen
constexpr double kScale = 8;          ///< steps beyond which a pixel may have another fault
constexpr size_t kFitted = 2;         ///< lights that are fitted to all pixels

/// Finds the lights that may be wrong, and fits the fault's numbers. Borrows all that it is made from.
class LightFit {
 public:
  LightFit(const PictureCase& picture, const PictureSupposition& supposed, const PictureFault& fault,
           const std::vector<SampledPixel>& pixels, const std::vector<double>& off_if_right)
      : picture_(picture), supposed_(supposed), fault_(fault), pixels_(pixels), off_(off_if_right) {
    codes_ = info(supposed.pass.pipeline.target).number_class == NumberClass::unorm;
    room_ = codes_ ? 0.5 : info(supposed.pass.pipeline.target).small_float() ? 1 : 0;
    blends_ =
        supposed.pass.pipeline.strategy == Strategy::deferred_volumes && supposed.pass.pipeline.blend == kAddLight;
    last_ = supposed.pass.pipeline.light_model.order == TermOrder::albedo_last;
    see_pixels();
  }

  /// changed_lights(), where no tiles are supposed.
  std::vector<FaultParameter> best() const;

 private:
  /// A sampled pixel as captured, and as predicted without the faults that change a finished color.
  struct Seen {
    SampledPixel pixel;
    PlainSurface surface;
    Color value, given;  ///< value: as a real number, whatever each blend rounds and clamps
    bool changed;
    std::vector<uint8_t> adds{};  ///< whether each light adds anything, where lights are blended
    Color held{};                 ///< what the target holds then
  };
  void see_pixels();
  void add_up(Seen& seen) const;
  /// A light of the pass with the fault of these numbers.
  Light changed(size_t light, const Triple3& vector) const {
    Light l = supposed_.pass.lights[light];
    fault_.one_light(l, vector);
    return l;
  }
  Color shown(const Seen& seen, const Triple3& more) const;
  Color afterwards(const Seen& seen, Color value) const;
  /// Predicts pixels with one light replaced by `now`; blend by blend, where lights are blended.
  class Relit {
   public:
    Relit(const LightFit& fit, size_t light, const Light& now) : fit_(fit), light_(light), pass_(fit.supposed_.pass) {
      pass_.lights[light] = now;
    }
    Color at(const Seen& seen, const Triple3& more) const;

   private:
    const LightFit& fit_;
    size_t light_;
    LightPass pass_;
  };
  double size_of(size_t light) const;
  /// What was captured of a channel minus `value`, in steps; what the store may round away counts for a twentieth.
  double off(const Seen& seen, const Color& value, int channel) const;
  NormalEquations equations(size_t light, const Triple3& at, size_t most, double scale) const;
  double error(size_t light, const Triple3& at, double scale, size_t most = ~size_t(0)) const;
  Triple3 fitted(size_t light, const Triple3& from) const;
  std::optional<Triple3> first_step(size_t light, const Triple3& start, size_t most) const;
  void look_about(size_t light, double scale, Triple3& at) const;
  /// What all fragments of a light add; 0 where it is not drawn.
  Triple3 term_of(const PredictedTerms& terms, const PlainSurface& surface, const Light& light) const {
    const int fragments = terms.fragments(surface, light);
    return fragments > 0 ? times(terms.term(surface, light), fragments) : Triple3{};
  }
  /// Whether the changed light adds anything to any pixel.
  bool shines(size_t light, const Triple3& at) const {
    const Light here = changed(light, at);
    return std::any_of(seen_.begin(), seen_.end(), [&](const Seen& s) {
      return term_of(PredictedTerms(supposed_.pass, s.surface), s.surface, here) != Triple3{};
    });
  }
  /// What the pixels cost with the fault supposed beside the others.
  double cost(const FaultParameter& parameter) const {
    PictureSupposition s = supposed_;
    s.suppose(fault_, parameter);
    return picture_.disagreement(s, pixels_, off_).cost;
  }
  FaultParameter shortest(FaultParameter parameter) const;

  const PictureCase& picture_;
  const PictureSupposition& supposed_;
  const PictureFault& fault_;
  const std::vector<SampledPixel>& pixels_;
  const std::vector<double>& off_;
  bool codes_ = false, last_ = false, blends_ = false;
  double room_ = 0;           ///< steps that a store may be off
  double farthest_ = kScale;  ///< twice the most steps that a pixel is off, from kScale to 1e6
  std::vector<Seen> seen_;    ///< those that are not as they should be first
};

/// Sets seen_ to the pixels that show a surface, those that are wrong first, and farthest_. Differences that are not
/// finite do not count.
void LightFit::see_pixels() {
  for (size_t i = 0; i < pixels_.size(); ++i) {
    const SampledPixel& p = pixels_[i];
    const auto [x, y] = picture_.source(supposed_.move, p.x, p.y);
    Seen seen{p, picture_.surface(x, y), {}, picture_.given_value(p.x, p.y), off_[i] >= kSameSteps};
    if (!seen.surface.covered) continue;
    seen.value = seen.held = predicted_pixel(supposed_.pass, seen.surface).value;
    if (blends_) add_up(seen);
    seen_.push_back(std::move(seen));
  }
  for (const Seen& s : seen_)
    for (int k = 0; k < std::min(3, picture_.channels()); ++k)
      if (const double steps = std::fabs(off(s, afterwards(s, s.held), k)); std::isfinite(steps))
        farthest_ = std::max(farthest_, std::min(2 * steps, 1e6));
  std::stable_partition(seen_.begin(), seen_.end(), [](const Seen& s) { return s.changed; });
}

/// Where lights are blended: sets seen.value to the sum of what they add, without blending's rounding, and seen.adds.
void LightFit::add_up(Seen& seen) const {
  LightPass dark = supposed_.pass;
  dark.lights.clear();
  seen.value = predicted_pixel(dark, seen.surface).value;
  seen.adds.resize(supposed_.pass.lights.size());
  for (const LightAdded& added : lights_added(supposed_.pass, seen.surface)) {
    seen.adds[added.light] = 1;
    for (size_t k = 0; k < 3; ++k) seen.value[k] += added.term[k];
  }
}

/// The color of a pixel that receives `more` light of the changed one, under the faults that change a finished color.
Color LightFit::Relit::at(const Seen& seen, const Triple3& more) const {
  if (!fit_.blends_) return fit_.shown(seen, more);
  if (more == Triple3{}) return fit_.afterwards(seen, seen.held);
  std::vector<uint8_t> listed = seen.adds;
  listed[light_] = 1;
  return fit_.afterwards(seen, predicted_pixel(pass_, seen.surface, &listed).value);
}

/// The color of a pixel that receives `more` light than is predicted, under the faults that change a finished color.
Color LightFit::shown(const Seen& seen, const Triple3& more) const {
  Color v = seen.value;
  for (size_t k = 0; k < 3; ++k) v[k] += last_ ? more[k] * seen.surface.albedo[k] : more[k];
  return afterwards(seen, v);
}

/// A color under the faults that change a finished one; clamped to [0, 1] where the target holds codes.
Color LightFit::afterwards(const Seen& seen, Color v) const {
  for (const PictureSupposition::Step& step : supposed_.steps)
    step.change(v, step.parameter, seen.pixel.x, seen.pixel.y);
  for (size_t k = 0; k < 3 && codes_; ++k) v[k] = std::clamp(v[k], 0.0, 1.0);
  return v;
}

/// A small change of one of the fault's numbers: 1e-3, or for a position a thousandth of the way from the light to the
/// nearest surface.
double LightFit::size_of(size_t light) const {
  if (fault_.start != 0 || is_directional(supposed_.pass.lights[light].type)) return 1e-3;
  double nearest = HUGE_VAL;
  for (const Seen& s : seen_) {
    const Triple3 offset = minus(triple(supposed_.pass.lights[light].position), s.surface.position);
    nearest = std::min(nearest, inner(offset, offset));
  }
  return 1e-3 * std::max(1e-3, std::sqrt(std::min(nearest, 1e12)));
}

/// Pixels are sampled by whether they are off, so what a store rounds away is not spread evenly over them, and counts
/// for little. Every pixel counts for as much as the others, whatever its weight. NaN or infinite where one of the two
/// is.
double LightFit::off(const Seen& seen, const Color& value, int channel) const {
  constexpr double kShare = 0.05;
  const auto k = size_t(channel);
  const double steps = (seen.given[k] - value[k]) / picture_.step_at(seen.given[k], channel);
  return std::copysign(std::max(0.0, std::fabs(steps) - room_), steps) + kShare * steps;
}

/// The normal equations of a step from `at`, each residual weighed by Cauchy's rule, over about `most` pixels.
/// Residuals that are not finite do not count.
NormalEquations LightFit::equations(size_t light, const Triple3& at, size_t most, double scale) const {
  const double size = size_of(light);
  const Light here = changed(light, at);
  std::array<Light, 3> moved{here, here, here};
  for (size_t i = 0; i < 3; ++i) {
    Triple3 v = at;
    v[i] += size;
    moved[i] = changed(light, v);
  }
  NormalEquations n;
  const Relit relit(*this, light, here);
  const size_t stride = std::max<size_t>(1, seen_.size() / most);
  for (size_t at_pixel = 0; at_pixel < seen_.size(); at_pixel += stride) {
    const Seen& s = seen_[at_pixel];
    const PredictedTerms terms(supposed_.pass, s.surface);
    const Triple3 right = term_of(terms, s.surface, supposed_.pass.lights[light]),
                  now = term_of(terms, s.surface, here);
    std::array<Color, 3> along{};
    bool any = right != Triple3{} || now != Triple3{};
    for (size_t i = 0; i < 3; ++i) {
      const Triple3 term = term_of(terms, s.surface, moved[i]);
      any = any || term != Triple3{};
      along[i] = shown(s, minus(term, right));
    }
    if (!any) continue;
    const Color value = shown(s, minus(now, right)), stored = relit.at(s, minus(now, right));
    for (int k = 0; k < std::min(3, picture_.channels()); ++k) {
      const auto c = size_t(k);
      const double step = picture_.step_at(s.given[c], k), residual = off(s, stored, k);
      if (!std::isfinite(residual)) continue;
      const Triple3 slope = {(along[0][c] - value[c]) / size / step, (along[1][c] - value[c]) / size / step,
                             (along[2][c] - value[c]) / size / step};
      const double inside = std::fabs(s.given[c] - stored[c]) <= room_ * step ? 0.05 : 1;
      const double weight = 1 / (1 + residual * residual / (scale * scale));
      for (size_t i = 0; i < 3; ++i) {
        n.b[i] += weight * slope[i] * residual;
        for (size_t j = 0; j < 3; ++j) n.a[i][j] += weight * inside * slope[i] * slope[j];
      }
    }
  }
  return n;
}

/// The sum of the residuals by Cauchy's rule, with the light changed by `at`, over about `most` pixels. Residuals that
/// are not finite do not count.
double LightFit::error(size_t light, const Triple3& at, double scale, size_t most) const {
  const Light here = changed(light, at);
  const Relit relit(*this, light, here);
  double sum = 0;
  const size_t stride = std::max<size_t>(1, seen_.size() / most);
  for (size_t at_pixel = 0; at_pixel < seen_.size(); at_pixel += stride) {
    const Seen& s = seen_[at_pixel];
    const PredictedTerms terms(supposed_.pass, s.surface);
    const Color value =
        relit.at(s, minus(term_of(terms, s.surface, here), term_of(terms, s.surface, supposed_.pass.lights[light])));
    for (int k = 0; k < std::min(3, picture_.channels()); ++k) {
      const double residual = off(s, value, k);
      if (std::isfinite(residual)) sum += std::log1p(residual * residual / (scale * scale));
    }
  }
  return sum;
}

/// The numbers that steps of least squares lead to from `from`, shortened for as long as they lead nowhere (Levenberg
/// and Marquardt). Looks about as well where the fault has other vectors to start from.
Triple3 LightFit::fitted(size_t light, const Triple3& from) const {
  Triple3 at = from;
  for (const double scale : {farthest_, kScale}) {  // what is far off counts for much at first, and then for little
    double least = error(light, at, scale), damping = 1e-3;
    for (int i = 0; i < 16 && damping < 1e6; ++i) {
      const std::optional<Triple3> step = equations(light, at, seen_.size(), scale).solved(damping);
      if (!step) break;
      const Triple3 next = plus(at, *step);
      const double e = error(light, next, scale);
      if (!(e < least)) {
        damping *= 8;
        continue;
      }
      const bool done = least - e < 1e-6 * least;
      at = next, least = e, damping = std::max(1e-9, damping / 8);
      if (done) break;
    }
    if (!fault_.from.empty()) look_about(light, scale, at);
  }
  return at;
}

/// Where one step of least squares leads from `start`; nothing if to numbers that are negative or not finite.
std::optional<Triple3> LightFit::first_step(size_t light, const Triple3& start, size_t most) const {
  const std::optional<Triple3> step = equations(light, start, most, farthest_).solved(1e-3);
  if (!step) return std::nullopt;
  const Triple3 at = plus(start, *step);
  const bool is_factor = std::all_of(at.begin(), at.end(), [](double v) { return v >= 0 && std::isfinite(v); });
  return is_factor ? std::optional(at) : std::nullopt;
}

/// Moves `at` by steps along each number, ever smaller, for as long as they lead to less: where a light ends without
/// fading there is no slope.
void LightFit::look_about(size_t light, double scale, Triple3& at) const {
  double least = error(light, at, scale);
  for (double step = 0.128; step > 5e-4; step /= 2)
    for (size_t k = 0; k < size_t(fault_.numbers); ++k)
      for (const double sign : {-1.0, 1.0}) {
        Triple3 next = at;
        next[k] *= 1 + sign * step;
        const double e = error(light, next, scale);
        if (e < least * (1 - 1e-9)) at = next, least = e;
      }
}

/// The parameter with its numbers rounded to the coarsest unit that costs no more.
FaultParameter LightFit::shortest(FaultParameter parameter) const {
  const double least = cost(parameter);
  for (const double unit : {0.1, 0.05, 0.01, 1e-3, 1e-4}) {
    FaultParameter rounded = parameter;
    for (double& v : rounded.vector) v = std::nearbyint(v / unit) * unit + 0.0;  // not -0
    if (cost(rounded) <= least * (1 + 1e-9)) return rounded;
  }
  return parameter;
}

std::vector<FaultParameter> LightFit::best() const {
  const std::vector<Light>& lights = supposed_.pass.lights;
  const Triple3 start = {fault_.start, fault_.start, fault_.start};
  const size_t most = std::max<size_t>(60, kTerms / std::max<size_t>(1, std::min(lights.size(), kMostLights)));
  std::vector<std::pair<double, size_t>> gains;  // by what one step of least squares is expected to gain
  std::vector<Triple3> froms(lights.size(), start);
  for (size_t i = 0; i < std::min(lights.size(), kMostLights); ++i) {
    if (!fault_.of_light(lights[i])) continue;
    if (!fault_.from.empty()) {  // or by what the best of some changes, and of the step, gains
      const double right = error(i, start, kScale, most);
      double least = HUGE_VAL;
      const auto try_from = [&](const Triple3& from) {
        if (const double e = error(i, from, kScale, most); e < least) least = e, froms[i] = from;
      };
      for (const Triple3& from : fault_.from) try_from(from);
      if (const std::optional<Triple3> stepped = first_step(i, start, most)) try_from(*stepped);
      if (least < right) gains.emplace_back(least - right, i);
      continue;
    }
    const NormalEquations n = equations(i, start, most, farthest_);
    if (const std::optional<Triple3> step = n.solved(1e-3)) gains.emplace_back(-inner(*step, n.b), i);
  }
  std::sort(gains.begin(), gains.end());
  std::vector<FaultParameter> parameters;
  for (size_t i = 0; i < std::min(kFitted, gains.size()); ++i) {
    const FaultParameter found(double(gains[i].second), fitted(gains[i].second, froms[gains[i].second]));
    const auto all = [&found](const auto& is) { return std::all_of(found.vector.begin(), found.vector.end(), is); };
    if (!all([](double v) { return std::isfinite(v); })) continue;
    // Of a colour these are faults of their own: a light that is missing, or drawn twice.
    const bool colors = fault_.start == 1 && fault_.from.empty();
    if (colors &&
        (all([](double v) { return std::fabs(v) < 0.02; }) || all([](double v) { return std::fabs(v - 2) < 0.02; })))
      continue;
    if (fault_.start == 1 && !all([](double v) { return v >= 0; })) continue;
    if (!shines(size_t(found.number), found.vector)) continue;  // it might as well be missing
    parameters.push_back(shortest(found));
  }
  return parameters;
}

}  // namespace

std::vector<FaultParameter> changed_lights(const PictureCase& picture, const PictureSupposition& supposed,
                                           const PictureFault& fault, const std::vector<SampledPixel>& pixels,
                                           const std::vector<double>& off_if_right) {
  if (supposed.tile > 0 || supposed.stale > 0) return {};
  return LightFit(picture, supposed, fault, pixels, off_if_right).best();
}

}  // namespace trueshade::oracle
