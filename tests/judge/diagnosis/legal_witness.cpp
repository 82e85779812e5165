#include "tests/judge/diagnosis/legal_witness.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "oracle/matrices.h"
#include "oracle/scalar_light.h"

namespace trueshade::testing {

namespace {

using namespace trueshade::oracle;

constexpr double kReach = 0.6;

/// A value before its conversion, in codes.
struct Converted {
  double value = 0, error = 0;
};

/// What is converted and added up in one channel of one pixel, and the code that was captured.
struct Stored {
  std::vector<Converted> parts;
  int code = 0;
  size_t pixel = 0;
};

/// Where the conversion changes from a code to the next.
class Thresholds {
 public:
  explicit Thresholds(int largest) : low_(size_t(largest)), high_(size_t(largest)) {
    for (size_t k = 0; k < low_.size(); ++k) low_[k] = double(k + 1) - kReach, high_[k] = double(k) + kReach;
  }
  /// The two codes that a value may become by what is known so far.
  std::array<int, 2> codes(const Converted& c) const {
    const auto code = [&](double v, const std::vector<double>& thresholds) {
      return int(std::upper_bound(thresholds.begin(), thresholds.end(), v) - thresholds.begin());
    };
    return {code(c.value - c.error, high_), code(c.value + c.error, low_)};
  }
  /// Learns of a value that was stored as the lower of two codes, or as the upper one.
  void learn(const Converted& c, int lower, bool above) {
    double &low = low_[size_t(lower)], &high = high_[size_t(lower)];
    if (above)
      high = std::min(high, std::max(low, c.value + c.error));
    else
      low = std::max(low, std::min(high, c.value - c.error));
  }
  /// The lowest of the thresholds that are left, or those so far on to the highest.
  void choose(double share) {
    for (size_t k = 0; k < low_.size(); ++k) low_[k] = high_[k] = low_[k] + share * (high_[k] - low_[k]);
  }

 private:
  std::vector<double> low_, high_;
};

class Witness {
 public:
  Witness(const Scene& scene, const Pipeline& pipeline, const Capture& capture)
      : scene_(scene),
        pipeline_(pipeline),
        capture_(capture),
        largest_(int(info(pipeline.target).largest_code(0))),
        axis_(view_axis(projection_of(scene.camera, pipeline.geometry, pipeline.width, pipeline.height))) {
    dark_.camera = scene.camera;
    if (!blends_lights(pipeline.strategy)) return;
    for (const Light& light : scene.lights) alone_.emplace_back().camera = scene.camera, alone_.back().lights = {light};
  }

  uint64_t missed() {
    for (int y = 0; y < pipeline_.height; ++y)
      for (int x = 0; x < pipeline_.width; ++x)
        if (!add(x, y)) return uint64_t(pipeline_.width) * uint64_t(pipeline_.height);
    Thresholds known(largest_);
    for (const Stored& s : stored_) learn(s, known);
    uint64_t least = ~uint64_t(0);
    for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0}) {
      Thresholds chosen = known;
      chosen.choose(share);
      least = std::min(least, missed_by(chosen));
    }
    return least;
  }

 private:
  /// False where a plane is missing, or nothing explains what is stored where nothing is drawn.
  bool add(int x, int y);
  Converted converted(const LitSum& sum, size_t k) const {
    const double value = std::clamp(double(sum.color[k]), 0.0, 1.0) * largest_;
    return {value, 0x1p-19 * value};  // sixteen roundings of floats: far less than OpenGL lets a renderer err
  }
  /// A pixel that has one conversion in doubt says which way it went.
  static void learn(const Stored& s, Thresholds& known) {
    int sum = 0;
    const Converted* open = nullptr;
    int lower = 0;
    for (const Converted& c : s.parts) {
      const std::array<int, 2> codes = known.codes(c);
      sum += codes[0];
      if (codes[0] == codes[1]) continue;
      if (open != nullptr || codes[1] != codes[0] + 1) return;
      open = &c, lower = codes[0];
    }
    if (open != nullptr && (s.code == sum || s.code == sum + 1)) known.learn(*open, lower, s.code > sum);
  }
  uint64_t missed_by(const Thresholds& chosen) const {
    uint64_t missed = 0;
    size_t last = ~size_t(0);
    for (const Stored& s : stored_) {
      int low = 0, high = 0;
      for (const Converted& c : s.parts) {
        const std::array<int, 2> codes = chosen.codes(c);
        low += codes[0], high += codes[1];
      }
      if (s.code >= std::min(low, largest_) && s.code <= std::min(high, largest_)) continue;
      missed += s.pixel != last ? 1 : 0, last = s.pixel;
    }
    return missed;
  }

  const Scene& scene_;
  const Pipeline& pipeline_;
  const Capture& capture_;
  const int largest_;
  const std::array<double, 3> axis_;
  Scene dark_;
  std::vector<Scene> alone_;
  std::vector<Stored> stored_;
};

bool Witness::add(int x, int y) {
  const Image *position = capture_.plane("position"), *normal = capture_.plane("normal"),
              *albedo = capture_.plane("albedo"), *ids = capture_.plane("id.object"),
              *specular = capture_.plane("specular"), *emission = capture_.plane("emission");
  if (position == nullptr || normal == nullptr || albedo == nullptr || ids == nullptr) return false;
  const LightModel& m = pipeline_.light_model;
  const size_t pixel = size_t(y) * size_t(pipeline_.width) + size_t(x);
  if (ids->code(x, y, 0) == 0) {
    for (int k = 0; k < 3; ++k)
      if (std::fabs(std::clamp(double(scene_.clear[k]), 0.0, 1.0) * largest_ - capture_.color.code(x, y, k)) > kReach)
        return false;
    return true;
  }
  Surface s;
  for (int k = 0; k < 3; ++k) {
    const auto i = size_t(k);
    s.position[i] = position->value(x, y, k), s.albedo[i] = albedo->value(x, y, k);
    s.normal[i] = normal->value(x, y, k);
    if (info(normal->format).number_class == NumberClass::unorm) s.normal[i] = 2 * s.normal[i] - 1;
    if (specular != nullptr) s.specular[i] = specular->value(x, y, k);
    if (emission != nullptr) s.emission[i] = emission->value(x, y, k);
  }
  if (specular != nullptr) s.shininess = specular->value(x, y, 3);
  std::array<Stored, 3> out;
  for (int k = 0; k < 3; ++k) out[size_t(k)].code = int(capture_.color.code(x, y, k)), out[size_t(k)].pixel = pixel;
  const auto convert = [&](const Scene& lit) {
    const LitSum sum = lit_sum(s, lit, m, axis_);
    for (size_t k = 0; k < 3; ++k) out[k].parts.push_back(converted(sum, k));
  };
  if (alone_.empty()) {
    convert(scene_);
  } else {
    if (pipeline_.light_volumes.base) convert(dark_);
    for (const Scene& light : alone_) convert(light);
  }
  for (Stored& channel : out) stored_.push_back(std::move(channel));
  return true;
}

}  // namespace

uint64_t pixels_without_witness(const Scene& scene, const Pipeline& pipeline, const Capture& capture) {
  const FormatInfo layout = info(pipeline.target);
  const bool suits = layout.number_class == NumberClass::unorm && !layout.srgb &&
                     (pipeline.strategy == Strategy::deferred_loop || pipeline.strategy == Strategy::deferred_volumes);
  if (!suits) return uint64_t(pipeline.width) * uint64_t(pipeline.height);
  return Witness(scene, pipeline, capture).missed();
}

}  // namespace trueshade::testing
