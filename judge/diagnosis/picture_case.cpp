#include "judge/diagnosis/picture_case.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "judge/stages/transparent_layers.h"
#include "scenes/pipeline/transparency.h"

namespace trueshade::oracle {

namespace {

constexpr std::array<size_t, 4> kSample = {700, 200, 500, 60}, kFew = {140, 50, 110, 16};

/// Deletes all but `most` elements, spread evenly over an order that looks like chance and is always the same.
void thin_out(std::vector<uint32_t>& pixels, size_t most) {
  const auto scrambled = [](uint32_t v) {
    v ^= v >> 16, v *= 0x7feb352du, v ^= v >> 15, v *= 0x846ca68bu;
    return v ^ v >> 16;
  };
  if (pixels.size() <= most) return;
  std::nth_element(pixels.begin(), pixels.begin() + int64_t(most), pixels.end(),
                   [&](uint32_t a, uint32_t b) { return scrambled(a) < scrambled(b); });
  pixels.resize(most);
}

/// What is read back of a value once a plane of the format `of_plane.target` has stored it.
double held_value(const Pipeline& of_plane, double value, int channel) {
  return value_of_stored(of_plane.target, stored_value(of_plane, LightFault::Store::right, value, channel), channel);
}

}  // namespace

std::string parameter_text(double value) {
  char text[32];
  const bool whole = value == std::floor(value) && std::fabs(value) < 1e15;  // a light's number has all its digits
  std::snprintf(text, sizeof text, whole ? "%.0f" : "%.5g", value);
  return text;
}

std::vector<SampledPixel> sampled_pixels(const StageVerdict& stage, const std::array<size_t, 4>& most,
                                         const std::vector<PixelUse>& uses) {
  std::array<std::vector<uint32_t>, 4> strata;
  for (uint32_t i = 0; i < stage.classes.size(); ++i) {
    const PixelClass c = stage.classes[i];
    if (uses[i] == PixelUse::left_out || c == PixelClass::left_out) continue;
    const size_t other = uses[i] == PixelUse::dull ? 3 : 2;
    strata[c == PixelClass::violation ? 0 : c == PixelClass::store_2 ? 1 : other].push_back(i);
  }
  std::vector<SampledPixel> sample;
  for (size_t s = 0; s < strata.size(); ++s) {
    const auto all = double(strata[s].size());
    thin_out(strata[s], most[s]);
    for (const uint32_t i : strata[s])
      sample.push_back({int(i) % stage.width, int(i) / stage.width, all / double(strata[s].size())});
  }
  return sample;
}

void PictureSupposition::suppose(const PictureFault& fault, const FaultParameter& given) {
  const double parameter = given.number;
  if (fault.one_light != nullptr) fault.one_light(pass.lights[size_t(parameter)], given.vector), known = nullptr;
  if (fault.by_vector != nullptr) fault.by_vector(pass, given.vector), known = nullptr;
  if (fault.light != nullptr) fault.light(pass, parameter);
  if (fault.light != nullptr || fault.tile > 0) known = nullptr;
  if (fault.value != nullptr) steps.push_back({fault.value, parameter});
  if (fault.move != nullptr) fault.move(move, parameter);
  if (fault.tile > 0) tile = fault.tile, tile_from = fault.counts ? TileLists::kOwn : int(parameter);
  if (fault.counts) tile_most = int(parameter);
  reach = std::max(reach, fault.reach);
  if (fault.stale > 0) stale = fault.stale;
}

PictureCase::PictureCase(const Scene& scene, const Pipeline& pipeline, const Profile& profile, const Capture& capture,
                         const StageVerdict& stage)
    : scene_(scene),
      pipeline_(pipeline),
      captured_(scene, pipeline, resolved(profile, pipeline), capture),
      color_(target_of(capture, pipeline)),
      mask_(capture.mask),
      right_(light_pass_of(scene, pipeline)),
      stale_(stage) {
  draw_sample(stage, profile, capture);
}

void PictureCase::make_tiles() {
  if (tiles_ == nullptr) tiles_ = std::make_shared<TileLists>(captured_, pipeline_.width, pipeline_.height);
}

/// Chooses the two samples. They leave out pixels under transparent surfaces, which are not predicted, and pixels where
/// the capture holds the nominal value and the prediction is another.
void PictureCase::draw_sample(const StageVerdict& stage, const Profile& profile, const Capture& capture) {
  std::optional<TransparentLayers> layers;
  if (draws_transparent(scene_, pipeline_) && pipeline_.transparency.mode == TransparencyMode::after_lights)
    layers.emplace(scene_, pipeline_, resolved(profile, pipeline_), capture);
  std::vector<PixelUse> uses(stage.classes.size());
  for (int y = 0; y < stage.height; ++y)
    for (int x = 0; x < stage.width; ++x) {
      bool black = true;
      for (int k = 0; k < std::min(3, channels()); ++k) black = black && given(x, y, k) == 0;
      uses[size_t(y) * size_t(stage.width) + size_t(x)] = layers && layers->any(x, y)         ? PixelUse::left_out
                                                          : black || !captured_.covered(x, y) ? PixelUse::dull
                                                                                              : PixelUse::usual;
    }
  sample_ = sampled_pixels(stage, kSample, uses);
  // A first look costs about the same however many lights there are.
  const size_t share = std::clamp<size_t>(scene_.lights.size() / 100, 1, 4);
  std::array<size_t, 4> few = kFew;
  for (size_t& f : few) f = f / share + 8;
  few_ = sampled_pixels(stage, few, uses);
  // Where the nominal value was stored and another is predicted, the prediction is what is wrong.
  const auto is_mistaken = [&](const SampledPixel& p) {
    const PixelClass c = stage.classes[size_t(p.y) * size_t(stage.width) + size_t(p.x)];
    return c == PixelClass::exact && steps_off(right(), p) >= kSameSteps;
  };
  std::erase_if(sample_, is_mistaken), std::erase_if(few_, is_mistaken);
}

PlainSurface PictureCase::surface(int x, int y) const {
  PlainSurface plain;
  plain.covered = captured_.covered(x, y);
  if (!plain.covered) return plain;
  const ShadedSurface s = captured_.at(x, y);
  for (size_t k = 0; k < 3; ++k) {
    plain.position[k] = s.position[k].value, plain.normal[k] = s.normal[k].value;
    plain.specular[k] = s.specular[k].value, plain.emission[k] = s.emission[k].value;
  }
  for (size_t k = 0; k < 4; ++k) plain.albedo[k] = s.albedo[k].value;
  plain.shininess = s.shininess, plain.ambient_share = s.ambient_share.value;
  plain.uv = {s.uv[0].value, s.uv[1].value};
  plain.object = s.object, plain.material = s.material, plain.pixel = s.pixel;
  plain.unlit = s.material > 0 && s.material <= scene_.materials.size() && scene_.materials[s.material - 1].unlit;
  if (expected_ != nullptr) heal_surface(x, y, plain);
  return plain;
}

/// Sets the numbers of the planes that are wrong to those that the plane's format holds of the expected ones.
void PictureCase::heal_surface(int x, int y, PlainSurface& surface) const {
  const PlaneValues v = expected_->at(x, y).value;
  Pipeline of_plane = pipeline_;
  const auto held = [&](Format format, double value, int channel) {
    of_plane.target = format;
    return held_value(of_plane, value, channel);
  };
  const GBufferState& g = pipeline_.gbuffer;
  if (wrong_[size_t(Plane::specular)]) surface.shininess = v.specular[3];
  if (wrong_[size_t(Plane::emission)]) surface.ambient_share = held(g.emission, v.emission[3], 3);
  const bool halved = info(g.normal.format).number_class == NumberClass::unorm;
  for (int i = 0; i < 4; ++i) {
    const auto k = size_t(i);
    if (wrong_[size_t(Plane::albedo)]) surface.albedo[k] = held(g.albedo.format, v.albedo[k], i);
    if (i == 3) continue;
    if (wrong_[size_t(Plane::specular)]) surface.specular[k] = held(g.specular, v.specular[k], i);
    if (wrong_[size_t(Plane::emission)]) surface.emission[k] = held(g.emission, v.emission[k], i);
    if (wrong_[size_t(Plane::position)]) surface.position[k] = held(g.position.format, v.position[k], i);
    if (!wrong_[size_t(Plane::normal)]) continue;
    const double n = held(g.normal.format, halved ? v.normal[k] * 0.5 + 0.5 : v.normal[k], i);
    surface.normal[k] = halved ? n * 2 - 1 : n;
  }
}

std::array<int, 2> PictureCase::source(const Move& move, int x, int y) const {
  x = std::clamp(x - move.x, 0, pipeline_.width - 1), y = std::clamp(y - move.y, 0, pipeline_.height - 1);
  return {move.flip_x ? pipeline_.width - 1 - x : x, move.flip_y ? pipeline_.height - 1 - y : y};
}

PictureCase::Prediction PictureCase::predicted(const PictureSupposition& supposed, int x, int y) const {
  const auto [sx, sy] = source(supposed.move, x, y);
  const auto make = [&, sx = sx, sy = sy] {
    std::vector<uint8_t> listed;
    if (supposed.tile > 0)
      listed = tiles_->list(supposed.pass, supposed.tile, supposed.tile_from, supposed.tile_most, sx, sy);
    return predicted_pixel(supposed.pass, surface(sx, sy), supposed.tile > 0 ? &listed : nullptr);
  };
  const PredictedPixel pixel = supposed.known != nullptr ? supposed.known->at(sx, sy, make) : make();
  Prediction out;
  out.value = pixel.value;
  if (supposed.steps.empty()) {
    out.drawn = out.stored = out.nearest = pixel.stored;
    return out;
  }
  Color after;
  for (int k = 0; k < 4; ++k) after[size_t(k)] = value_of_stored(pipeline_.target, pixel.stored[size_t(k)], k);
  for (const PictureSupposition::Step& step : supposed.steps) {
    step.change(out.value, step.parameter, x, y);
    step.change(after, step.parameter, x, y);
  }
  const LightFault::Store rule = supposed.pass.fault.store;
  const LightFault::Store other = color_.layout.small_float() ? LightFault::Store::nearest : rule;
  for (int k = 0; k < 4; ++k) {
    out.drawn[size_t(k)] = stored_value(pipeline_, rule, out.value[size_t(k)], k);
    out.stored[size_t(k)] = stored_value(pipeline_, rule, after[size_t(k)], k);
    out.nearest[size_t(k)] = stored_value(pipeline_, other, after[size_t(k)], k);
  }
  return out;
}

Color PictureCase::given_value(int x, int y) const {
  Color c{0, 0, 0, 1};
  for (int k = 0; k < channels(); ++k) c[size_t(k)] = value_of_stored(pipeline_.target, given(x, y, k), k);
  return c;
}

double PictureCase::step_at(double value, int channel) const {
  const FormatInfo& layout = color_.layout;
  if (layout.number_class == NumberClass::unorm) {
    const double code = 1.0 / layout.largest_code(channel);
    return layout.srgb_channel(channel) ? code * std::max(0.08, 2.3 * std::pow(std::max(0.0, value), 0.58)) : code;
  }
  const double size = std::max(std::fabs(value), 0x1p-9);
  if (!layout.small_float()) return 1e-5 * size;
  const int bits = layout.bits[size_t(channel)] == 16 ? 10 : layout.bits[size_t(channel)] - 5;
  return std::ldexp(1.0, std::ilogb(size) - bits);
}

double PictureCase::steps_off(const PictureSupposition& supposed, const Prediction& p, int x, int y,
                              int channel) const {
  const auto k = size_t(channel);
  const double stored = given(x, y, channel);
  if (!std::isfinite(stored)) return std::isfinite(p.drawn[k]) || std::isfinite(p.stored[k]) ? 1e3 : 0;
  const double unit = color_.unorm() ? 1 : step_at(stored, channel);
  double off =
      std::min({std::fabs(stored - p.drawn[k]), std::fabs(stored - p.stored[k]), std::fabs(stored - p.nearest[k])}) /
      unit;
  if (off < kSameSteps) return 0;
  if (supposed.reach > 0) {
    const double value = color_.unorm() ? p.value[k] * color_.layout.largest_code(channel) : p.value[k];
    if (std::fabs(stored - value) <= supposed.reach * unit) return 0;
  }
  if (off > 1.5 || blends_lights(pipeline_.strategy)) return off;
  // Floats are off a little: the other side of a threshold is as good.
  for (const double moved : {1 - 3e-6, 1 + 3e-6})
    if (std::fabs(stored - stored_value(pipeline_, supposed.pass.fault.store, p.value[k] * moved, channel)) <
        kSameSteps * unit)
      return 0;
  return off;
}

bool PictureCase::in_stale_tile(const PictureSupposition& supposed, int x, int y) const {
  return supposed.stale > 0 && stale_.hold_anything(supposed.stale, x, y);
}

double PictureCase::shown(const PictureSupposition& supposed, const Prediction& predicted, int x, int y,
                          int channel) const {
  if (in_stale_tile(supposed, x, y) || steps_off(supposed, predicted, x, y, channel) < kSameSteps)
    return given(x, y, channel);
  return predicted.stored[size_t(channel)];
}

/// A dither adds to a value of fraction f either -f or 1 - f codes, on the average nothing, whatever the pixels beside
/// it get. The mean square of that is f (1 - f); rounding to nearest alone makes half of it.
bool PictureCase::looks_dithered(const PictureSupposition& supposed) const {
  constexpr double kLeastSquares = 0.75, kMostSquares = 1.3, kMostMean = 0.08, kMostAlike = 0.2, kMostBeyond = 0.1;
  struct Added {
    double codes = 0, chance = 0;
  };
  const auto added = [&](int x, int y, int channel) -> std::optional<Added> {
    if (x >= pipeline_.width || y >= pipeline_.height || !captured_.covered(x, y) || mask_.has(x, y))
      return std::nullopt;
    const double largest = color_.layout.largest_code(channel);
    const double value = predicted(supposed, x, y).value[size_t(channel)] * largest, f = value - std::floor(value);
    if (!(value > 0) || value >= largest) return std::nullopt;
    return Added{given(x, y, channel) - value, f * (1 - f)};
  };
  double weight = 0, beyond = 0, squares = 0, chances = 0, sum = 0, alike = 0, pairs = 0;
  for (const SampledPixel& p : sample_)  // a quarter of them is too few to tell noise from what looks like it
    for (int k = 0; k < std::min(3, channels()); ++k) {
      const std::optional<Added> here = added(p.x, p.y, k);
      if (!here) continue;
      weight += p.weight;
      if (std::fabs(here->codes) > 1.02) {
        beyond += p.weight;
        continue;
      }
      squares += p.weight * here->codes * here->codes, chances += p.weight * here->chance;
      sum += p.weight * here->codes;
      for (const auto& [dx, dy] : {std::pair(1, 0), std::pair(0, 1)})
        if (const std::optional<Added> beside = added(p.x + dx, p.y + dy, k)) {
          alike += p.weight * here->codes * beside->codes;
          pairs += p.weight * 0.5 * (here->codes * here->codes + beside->codes * beside->codes);
        }
    }
  return chances > 0.02 * weight && beyond < kMostBeyond * weight && squares > kLeastSquares * chances &&
         squares < kMostSquares * chances && std::fabs(sum) < kMostMean * weight && alike < kMostAlike * pairs;
}

double PictureCase::steps_off(const PictureSupposition& supposed, const SampledPixel& pixel) const {
  if (in_stale_tile(supposed, pixel.x, pixel.y)) return 0;
  const Prediction p = predicted(supposed, pixel.x, pixel.y);
  double off = 0;
  for (int k = 0; k < channels(); ++k) off = std::max(off, steps_off(supposed, p, pixel.x, pixel.y, k));
  return off;
}

std::vector<double> PictureCase::steps_off(const PictureSupposition& supposed,
                                           const std::vector<SampledPixel>& pixels) const {
  std::vector<double> off;
  off.reserve(pixels.size());
  for (const SampledPixel& p : pixels) off.push_back(steps_off(supposed, p));
  return off;
}

Disagreement PictureCase::disagreement(const PictureSupposition& supposed, const std::vector<SampledPixel>& pixels,
                                       const std::vector<double>& off_if_right) const {
  Disagreement d;
  for (size_t i = 0; i < pixels.size(); ++i) {
    const double off = steps_off(supposed, pixels[i]), weight = pixels[i].weight;
    const bool is_anything = in_stale_tile(supposed, pixels[i].x, pixels[i].y);
    d.cost += weight * (is_anything ? kAnythingCost : cost_of(off));
    if (off_if_right[i] >= kSameSteps && off < kSameSteps) (is_anything ? d.located : d.explained) += weight;
    if (off_if_right[i] < kSameSteps && off >= kSameSteps) d.contradicted += weight;
  }
  return d;
}

}  // namespace trueshade::oracle
