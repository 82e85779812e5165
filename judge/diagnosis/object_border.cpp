#include "judge/diagnosis/object_border.h"

#include <algorithm>
#include <cmath>

namespace trueshade::oracle {

namespace {

constexpr size_t kMostPlaces = 1500;     ///< pixels: a sketch is drawn of them some hundred times
constexpr size_t kMostOutlined = 20000;  ///< triangles of the mesh

/// Whether any of a pixel's four neighbours shows the object of this number or, where `shows` is false, does not.
bool has_beside(const PlaneEvidence& evidence, int x, int y, double number, bool shows) {
  constexpr int kBeside[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
  return std::any_of(std::begin(kBeside), std::end(kBeside), [&](const int(&d)[2]) {
    const int bx = x + d[0], by = y + d[1];
    if (bx < 0 || by < 0 || bx >= evidence.pipeline.width || by >= evidence.pipeline.height) return false;
    return (evidence.object_at(bx, by) == number) == shows;
  });
}

}  // namespace

std::vector<SampledPixel> outline_of(const PlaneEvidence& evidence, uint32_t object) {
  const double number = object + 1.0;
  std::vector<SampledPixel> all, some;
  for (int y = 0; y < evidence.pipeline.height && evidence.has_plane(Plane::object); ++y)
    for (int x = 0; x < evidence.pipeline.width; ++x)
      if (has_beside(evidence, x, y, number, evidence.object_at(x, y) != number)) all.push_back({x, y, 1});
  const size_t stride = std::max<size_t>(1, (all.size() + kMostPlaces - 1) / kMostPlaces);
  for (size_t i = 0; i < all.size(); i += stride) some.push_back(all[i]);
  return some;
}

ObjectBorder::ObjectBorder(const PlaneEvidence& evidence, uint32_t object) : object_(object) {
  if (evidence.scene.meshes[evidence.scene.instances[object].mesh].triangle_count() <= kMostOutlined)
    places_ = outline_of(evidence, object);
  if (!places_.empty())  // from where outlines are far off
    for (const EvidentPixel& p : evidence.pixels) places_.push_back(p.at);
  for (const SampledPixel& p : places_) given_.push_back(evidence.given_at(p.x, p.y));
  sketch_.emplace(places_, evidence.pipeline);
}

int ObjectBorder::mismatches(const Scene& scene, const Pipeline& pipeline) {
  sketch_->clear(pipeline);
  sketch_->draw(scene, pipeline, scene.meshes[scene.instances[object_].mesh], object_);
  int count = 0;
  for (size_t i = 0; i < places_.size(); ++i) {
    const PlaneValues& drawn = sketch_->pixels()[i];
    const bool shown = given_[i].object == object_ + 1.0;
    const bool hidden = given_[i].covered && given_[i].depth <= drawn.depth;  // by something else
    count += shown ? !drawn.covered : drawn.covered && !hidden;
  }
  return count;
}

namespace {

using Cost = std::function<double(const Triple3&)>;

/// `at` with one number greater by `by`.
Triple3 moved(Triple3 at, size_t number, double by) {
  at[number] += by;
  return at;
}

/// How far a number can go from `at`, in the direction of `step` and with its sign, at a cost of no more than `most`.
double room(const Cost& cost, const Triple3& at, size_t number, double step, double most) {
  double far = 0;
  for (double next = step; std::fabs(next) < 4096 * std::fabs(step) && cost(moved(at, number, next)) <= most; next *= 2)
    far = next;
  for (double part = far / 2; far != 0 && std::fabs(part) >= std::fabs(step) / 4; part /= 2)
    if (cost(moved(at, number, far + part)) <= most) far += part;
  return far;
}

/// Moves `at` to the best of many places along one number. Small steps alone may not get there: between `at` and the
/// right place all outlines may be as wrong.
void look_along(const Cost& cost, int numbers, double step, Triple3& at, double& least) {
  constexpr int kMostSteps = 16;
  const Triple3 from = at;
  for (size_t k = 0; k < size_t(numbers); ++k)
    for (int i = -kMostSteps; i <= kMostSteps; ++i)
      if (const double c = cost(moved(from, k, i * step)); c < least) least = c, at = moved(from, k, i * step);
}

}  // namespace

namespace {

constexpr double kNoise = 1.5;  ///< a pixel, and what differences of the last digits sum up to

/// Each number rounded to the coarsest unit that costs no more than `most`.
Triple3 shortened(const Cost& cost, int numbers, double most, Triple3 at) {
  for (size_t k = 0; k < size_t(numbers); ++k)
    for (const double unit : {1.0, 0.5, 0.1, 0.05, 0.01, 1e-3, 1e-4}) {
      Triple3 rounded = at;
      rounded[k] = std::nearbyint(at[k] / unit) * unit + 0.0;
      if (cost(rounded) > most) continue;
      at = rounded;
      break;
    }
  return at;
}

}  // namespace

Triple3 settled(const Cost& cost, int numbers, double size, Triple3 at) {
  constexpr int kMostMoves = 24, kCoarse = 64;
  double least = cost(at);
  if (least < 1) return shortened(cost, numbers, least + kNoise, at);  // no pixel of the outline is left
  const auto better = [&](double step) {
    for (size_t k = 0; k < size_t(numbers); ++k)
      for (const double sign : {-1.0, 1.0})
        if (const double c = cost(moved(at, k, sign * step)); c < least) {
          least = c, at = moved(at, k, sign * step);
          return true;
        }
    return false;
  };
  look_along(cost, numbers, kCoarse * size, at, least);
  for (double step = kCoarse * size; step >= size / 16; step /= 2)
    for (int i = 0; i < kMostMoves && better(step); ++i) continue;
  const double most = least + kNoise;
  for (size_t k = 0; k < size_t(numbers); ++k)
    at[k] += (room(cost, at, k, size / 16, most) + room(cost, at, k, -size / 16, most)) / 2;
  return shortened(cost, numbers, most, at);
}

}  // namespace trueshade::oracle
