#include "judge/diagnosis/plane_case.h"

#include <algorithm>
#include <cmath>

#include "judge/diagnosis/picture_case.h"

namespace trueshade::oracle {

namespace {

constexpr std::array<size_t, 4> kPlaneSample = {500, 100, 300, 60}, kPlaneFew = {110, 20, 60, 16};

/// The number of a plane's channel, and the constant that stands where there is none.
double number_of(const PlaneValues& v, Plane plane, int channel) {
  const auto k = size_t(channel);
  switch (plane) {
    case Plane::depth:
      return v.depth;
    case Plane::position:
      return k < 3 ? v.position[k] : v.covered ? 1 : 0;
    case Plane::normal:
      return k < 3 ? v.normal[k] : v.covered ? 1 : 0;
    case Plane::albedo:
      return v.albedo[k];
    case Plane::uv:
      return k < 2 ? v.uv[k] : k == 3 && v.covered ? 1 : 0;
    case Plane::specular:
      return v.specular[k];
    case Plane::emission:
      return v.emission[k];
    case Plane::object:
      return v.object;
    default:
      return v.material;
  }
}

}  // namespace

PlaneCase::PlaneCase(const Scene& scene, const Pipeline& pipeline, const Profile& profile, const Capture& capture,
                     const StageVerdict& stage)
    : scene_(scene),
      pipeline_(pipeline),
      profile_(resolved(profile, pipeline)),
      drawn_at_(capture.drawn_at),
      context_(plane_context(scene_, pipeline_)),
      right_(std::make_shared<ExpectedPlanes>(scene, pipeline_, profile_, capture.drawn_at)) {
  for (size_t i = 0; i < kPlanes; ++i) {
    const LightModel& model = pipeline_.light_model;
    if (Plane(i) == Plane::position && pipeline_.gbuffer.position_from_depth) continue;
    if (Plane(i) == Plane::specular && !reads_specular_plane(model)) continue;
    if (Plane(i) == Plane::emission && !model.emission) continue;
    views_[i] = plane_of(capture, pipeline_, kPlaneNames[i]);
  }
  std::vector<PixelUse> uses(stage.classes.size());
  for (int y = 0; y < stage.height; ++y)
    for (int x = 0; x < stage.width; ++x)
      if (!right_->covered(x, y)) uses[size_t(y) * size_t(stage.width) + size_t(x)] = PixelUse::dull;
  sample_ = sampled_pixels(stage, kPlaneSample, uses), few_ = sampled_pixels(stage, kPlaneFew, uses);
  for (const SampledPixel& p : few_)
    for (const double v : right_->at(p.x, p.y).value.position) extent_ = std::max(extent_, std::fabs(v));
}

int PlaneCase::planes() const {
  return int(std::count_if(views_.begin(), views_.end(), [](const PlaneView& v) { return bool(v); }));
}

namespace {

/// Makes the fault's change of the scene, the pipeline or the sampling. False where it changes nothing.
bool redrawn(Scene& scene, Pipeline& pipeline, Profile& profile, const NamedPlaneFault& f) {
  if (f.fault->sample != nullptr) return f.fault->sample(scene, profile.sampling, f.parameter.number);
  return f.fault->edit != nullptr ? f.fault->edit(scene, pipeline, f.parameter)
                                  : f.fault->redraw(scene, pipeline, f.parameter.number);
}

}  // namespace

std::optional<PlaneSupposition> PlaneCase::with(const PlaneSupposition& base, const NamedPlaneFault& fault) const {
  PlaneSupposition s = base;
  s.faults.push_back(fault);
  if (!fault.fault->redraws()) return s;
  const auto scene = std::make_shared<Scene>(scene_);
  Pipeline pipeline = pipeline_;
  Profile profile = profile_;
  for (const NamedPlaneFault& f : s.faults)
    if (f.fault->redraws() && !redrawn(*scene, pipeline, profile, f)) return std::nullopt;
  s.scene = scene;
  s.drawn = std::make_shared<ExpectedPlanes>(*scene, pipeline, profile, drawn_at_);
  return s;
}

/// What a plane should show at a pixel under the supposed faults: the surface of the pixel that was moved here, encoded
/// as they encode it.
ExpectedPixel PlaneCase::changed(const PlaneSupposition& supposed, Plane plane, int x, int y, bool after) const {
  PlaneMove move;
  for (const NamedPlaneFault& f : supposed.faults)
    if (f.fault->move != nullptr && (f.fault->plane == plane || f.fault->plane == Plane::all))
      f.fault->move(move, f.parameter.number);
  x = std::clamp(x - move.x, 0, pipeline_.width - 1), y = std::clamp(y - move.y, 0, pipeline_.height - 1);
  ExpectedPixel p =
      supposed.drawn->at(move.flip_x ? pipeline_.width - 1 - x : x, move.flip_y ? pipeline_.height - 1 - y : y);
  if (after && plane == Plane::albedo)
    for (PlaneValues* v : {&p.value, &p.low, &p.high})
      for (int k = 0; k < 4; ++k)
        v->albedo[size_t(k)] =
            std::nearbyint(stored(plane, v->albedo[size_t(k)], k)) / views_[size_t(plane)].layout.largest_code(k);
  for (const NamedPlaneFault& f : supposed.faults)
    if (f.fault->change != nullptr && f.fault->plane == plane) encode(*f.fault, f.parameter.number, p);
  return p;
}

/// The fault's change of a pixel's nominal values and of the bounds about them. A normal and a position lie in a box of
/// legal values. The fault is applied to all eight corners of that box, and the new bounds enclose what comes out: an
/// encoding that mixes the components, as octahedra do, need not take the lowest corner to the lowest result.
void PlaneCase::encode(const PlaneFault& fault, double parameter, ExpectedPixel& p) const {
  const ExpectedPixel plain = p;
  for (PlaneValues* v : {&p.value, &p.low, &p.high}) fault.change(context_, *v, parameter);
  const auto numbers = fault.plane == Plane::normal ? &PlaneValues::normal : &PlaneValues::position;
  if (fault.plane != Plane::normal && fault.plane != Plane::position) return;
  auto &low = p.low.*numbers, &high = p.high.*numbers;
  low = high = p.value.*numbers;
  for (unsigned corner = 0; corner < 8; ++corner) {
    PlaneValues v = plain.value;
    for (size_t k = 0; k < 3; ++k)
      (v.*numbers)[k] = ((corner >> k & 1u) != 0 ? plain.high.*numbers : plain.low.*numbers)[k];
    fault.change(context_, v, parameter);
    for (size_t k = 0; k < 3; ++k)
      low[k] = std::min(low[k], (v.*numbers)[k]), high[k] = std::max(high[k], (v.*numbers)[k]);
  }
}

/// A number in the plane's unit: a code, not rounded, where the format is unorm; otherwise as it is.
double PlaneCase::stored(Plane plane, double value, int channel) const {
  const PlaneView& view = views_[size_t(plane)];
  if (!view.unorm()) return value;
  const double v = plane == Plane::normal && channel < 3 ? value * 0.5 + 0.5 : value;
  return std::clamp(v, 0.0, 1.0) * view.layout.largest_code(channel);
}

/// Steps that a channel is off beyond its legal values, rounding and `reach`: 0, or kSameSteps and more. 1000 where one
/// of the numbers is NaN or infinite, unless they are equal.
double PlaneCase::channel_off(Plane plane, const ExpectedPixel& p, double reach, int x, int y, int channel) const {
  const PlaneView& view = views_[size_t(plane)];
  const double given = view.stored(x, y, channel), value = stored(plane, number_of(p.value, plane, channel), channel);
  const double a = stored(plane, number_of(p.low, plane, channel), channel),
               b = stored(plane, number_of(p.high, plane, channel), channel);
  const double slack = std::max(std::fabs(a - value), std::fabs(b - value));
  if (!std::isfinite(given) || !std::isfinite(value)) return given == value ? 0 : 1e3;
  // No fault of an albedo exchanges its ends, and lookups reach much farther one way than the other.
  const double off = plane == Plane::albedo
                         ? std::max({0.0, std::min({a, b, value}) - given, given - std::max({a, b, value})})
                         : std::max(0.0, std::fabs(given - value) - slack);
  double unit = 1, room = 0.51;  // of a code
  if (!view.unorm()) {
    const double size = std::max(std::fabs(value), std::fabs(given));
    unit = plane == Plane::position ? extent_ * 0x1p-20 : plane == Plane::depth ? 0x1p-22 : 0x1p-20;
    if (plane == Plane::specular || plane == Plane::emission) unit *= std::max(1.0, size);
    if (view.layout.number_class == NumberClass::integer) unit = 1;
    if (view.layout.small_float()) unit = std::ldexp(1.0, std::max(size > 0 ? std::ilogb(size) : -14, -14) - 10);
    room = view.layout.small_float() ? 1.01 : 0.4;
  }
  return std::max(0.0, off / unit - room - reach) + (off / unit > room + reach ? kSameSteps : 0);
}

namespace {

/// Sets each number of `out` to mix(number of a, number of b).
template <class Mix>
void mix_numbers(PlaneValues& out, const PlaneValues& a, const PlaneValues& b, const Mix& mix) {
  out.depth = mix(a.depth, b.depth);
  for (size_t k = 0; k < 3; ++k) {
    out.position[k] = mix(a.position[k], b.position[k]), out.normal[k] = mix(a.normal[k], b.normal[k]);
  }
  for (size_t k = 0; k < 4; ++k) {
    out.albedo[k] = mix(a.albedo[k], b.albedo[k]), out.specular[k] = mix(a.specular[k], b.specular[k]);
    out.emission[k] = mix(a.emission[k], b.emission[k]);
  }
  for (size_t k = 0; k < 2; ++k) out.uv[k] = mix(a.uv[k], b.uv[k]);
}

}  // namespace

/// The bounds of any average of the surfaces at a pixel and its eight neighbours; nothing where all show one triangle.
std::optional<ExpectedPixel> PlaneCase::average_at(const ExpectedPlanes& planes, int x, int y) const {
  const auto least = [](double u, double v) { return std::min(u, v); };
  const auto most = [](double u, double v) { return std::max(u, v); };
  const PlaneValues seen = given(x, y);
  ExpectedPixel hull = planes.at(x, y);
  bool is_edge = false, is_one = false;
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      const ExpectedPixel p =
          planes.at(std::clamp(x + dx, 0, pipeline_.width - 1), std::clamp(y + dy, 0, pipeline_.height - 1));
      is_edge = is_edge || p.value.object != hull.value.object || p.triangle != hull.triangle;
      is_one = is_one || (p.value.object == seen.object && p.value.material == seen.material);
      mix_numbers(hull.low, hull.low, p.low, least), mix_numbers(hull.high, hull.high, p.high, most);
    }
  if (!is_edge) return std::nullopt;
  mix_numbers(hull.value, hull.low, hull.high, [](double u, double v) { return (u + v) / 2; });
  if (is_one)  // identifiers are not averaged, but of any of them
    for (PlaneValues* v : {&hull.value, &hull.low, &hull.high}) v->object = seen.object, v->material = seen.material;
  return hull;
}

/// Steps that each captured plane is off from the expected pixel.
std::array<double, kPlanes> PlaneCase::steps_off(const ExpectedPixel& p, int x, int y) const {
  std::array<double, kPlanes> off{};
  for (size_t i = 0; i < kPlanes; ++i)
    for (int k = 0; views_[i] && k < views_[i].channels; ++k)
      off[i] = std::max(off[i], channel_off(Plane(i), p, 0, x, y, k));
  return off;
}

std::array<double, kPlanes> PlaneCase::steps_off(const PlaneSupposition& supposed, int x, int y) const {
  std::array<double, kPlanes> off{};
  bool moved = false;
  for (const NamedPlaneFault& f : supposed.faults)
    moved = moved || f.fault->move != nullptr || f.fault->change != nullptr;
  const ExpectedPixel plain = moved ? ExpectedPixel{} : supposed.drawn->at(x, y);
  for (size_t i = 0; i < kPlanes; ++i) {
    if (!views_[i]) continue;
    double reach = 0;
    for (const NamedPlaneFault& f : supposed.faults)
      if (f.fault->plane == Plane(i)) reach = std::max(reach, f.fault->reach);
    const auto off_by = [&](const ExpectedPixel& p) {
      double most = 0;
      for (int k = 0; k < views_[i].channels; ++k) most = std::max(most, channel_off(Plane(i), p, reach, x, y, k));
      return most;
    };
    off[i] = off_by(moved ? changed(supposed, Plane(i), x, y, false) : plain);
    if (moved && off[i] >= kSameSteps && Plane(i) == Plane::albedo && views_[i].unorm())
      off[i] = std::min(off[i], off_by(changed(supposed, Plane(i), x, y, true)));
  }
  const bool averages = std::any_of(supposed.faults.begin(), supposed.faults.end(),
                                    [](const NamedPlaneFault& f) { return f.fault->averages; });
  if (!averages || std::all_of(off.begin(), off.end(), [](double o) { return o < kSameSteps; })) return off;
  const std::optional<ExpectedPixel> average = average_at(*supposed.drawn, x, y);
  return average ? steps_off(*average, x, y) : off;
}

/// The numbers that the captured planes hold at a pixel, decoded from codes. Planes that were not captured keep the
/// defaults of PlaneValues; `object` is -1 then.
PlaneValues PlaneCase::given(int x, int y) const {
  PlaneValues v;
  const auto number = [&](Plane plane, int channel) {
    const PlaneView& view = views_[size_t(plane)];
    const double stored = view.stored(x, y, channel);
    if (!view.unorm()) return stored;
    const double value = stored / view.layout.largest_code(channel);
    return plane == Plane::normal ? 2 * value - 1 : value;
  };
  const auto fill = [&](Plane plane, auto& numbers) {
    const PlaneView& view = views_[size_t(plane)];
    for (size_t k = 0; view && k < std::min(numbers.size(), size_t(view.channels)); ++k)
      numbers[k] = number(plane, int(k));
  };
  fill(Plane::position, v.position), fill(Plane::normal, v.normal), fill(Plane::albedo, v.albedo);
  fill(Plane::uv, v.uv), fill(Plane::specular, v.specular), fill(Plane::emission, v.emission);
  if (views_[size_t(Plane::depth)]) v.depth = number(Plane::depth, 0);
  if (views_[size_t(Plane::material)]) v.material = number(Plane::material, 0);
  v.object = views_[size_t(Plane::object)] ? number(Plane::object, 0) : -1;
  v.covered = v.object >= 0 ? v.object > 0 : !is_clear_depth(pipeline_.geometry, v.depth);
  return v;
}

PlaneEvidence PlaneCase::evidence() const {
  PlaneEvidence e{scene_,
                  pipeline_,
                  {},
                  {},
                  [this](int x, int y) { return given(x, y); },
                  [this](int x, int y) { return views_[size_t(Plane::object)].stored(x, y, 0); }};
  for (size_t k = 0; k < kPlanes; ++k) e.has[k] = bool(views_[k]);
  for (const SampledPixel& p : sample_) {
    const ExpectedPixel expected = right_->at(p.x, p.y);
    e.pixels.push_back({p, false, given(p.x, p.y), expected.value, expected.triangle});
  }
  return e;
}

double PlaneCase::predicted(const PlaneSupposition& supposed, Plane plane, int x, int y, int channel) const {
  if (std::any_of(supposed.faults.begin(), supposed.faults.end(),
                  [](const NamedPlaneFault& f) { return f.fault->averages; }))
    if (const std::optional<ExpectedPixel> average = average_at(*supposed.drawn, x, y)) {
      const double v = stored(plane, number_of(average->value, plane, channel), channel);
      return views_[size_t(plane)].unorm() ? std::nearbyint(v) : v;
    }
  const double v = stored(plane, number_of(changed(supposed, plane, x, y, false).value, plane, channel), channel);
  return views_[size_t(plane)].unorm() ? std::nearbyint(v) : v;
}

}  // namespace trueshade::oracle
