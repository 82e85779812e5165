// The numbers of a fault that changes what is drawn, from the pixels: the change is sketched, and what is left of the
// differences made small.
#include <algorithm>
#include <cmath>
#include <map>

#include "judge/diagnosis/least_squares.h"
#include "judge/diagnosis/object_border.h"
#include "judge/diagnosis/sketch.h"
#include "oracle/camera_view.h"
#include "oracle/exact_coverage.h"

namespace trueshade::oracle {

namespace {

constexpr size_t kMostOfObject = 240, kMostOfCamera = 300;  ///< pixels
constexpr double kFitScales[] = {0.1,  0.01, 1e-3,
                                 1e-4, 1e-5, 1e-6};  ///< of the scene's extent, of a unit normal, of a window
constexpr double kOnFaces = 1e-4;  ///< of kFitScales: beside pixels of an outline, each of which counts 1
constexpr double kBlamed = 0.3;    ///< the share of wrong pixels that an object has which is to blame
constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

/// Every n-th element, so that at most so many are left.
template <class T>
std::vector<T> thinned(const std::vector<T>& all, size_t most) {
  std::vector<T> some;
  const size_t stride = std::max<size_t>(1, (all.size() + most - 1) / most);
  for (size_t i = 0; i < all.size(); i += stride) some.push_back(all[i]);
  return some;
}

/// A scene without its meshes, but for one, and without textures: cheap to copy.
Scene bare_scene(const Scene& scene, std::optional<uint32_t> mesh) {
  Scene bare;
  bare.meshes.resize(scene.meshes.size());
  if (mesh) bare.meshes[*mesh] = scene.meshes[*mesh];
  bare.materials = scene.materials, bare.instances = scene.instances, bare.camera = scene.camera;
  bare.textures.resize(scene.textures.size());
  return bare;
}

/// How far positions reach, which their differences are measured by.
double extent_of(const PlaneEvidence& evidence) {
  Triple3 low = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, high = times(low, -1);
  for (const EvidentPixel& p : evidence.pixels)
    for (size_t k = 0; k < 3 && p.expected.covered; ++k)
      low[k] = std::min(low[k], p.expected.position[k]), high[k] = std::max(high[k], p.expected.position[k]);
  const Triple3 size = minus(high, low);
  const double extent = std::sqrt(inner(size, size));
  return extent > 0 && std::isfinite(extent) ? extent : 1;
}

/// Appends six differences between a sketch and the capture at a pixel: three of the position or the depth, three of
/// the normal. They are NaN where not both show the same object.
void add_differences(const PlaneEvidence& evidence, double extent, const PlaneValues& sketched,
                     const PlaneValues& given, bool same, std::vector<double>& out) {
  const bool has_position = evidence.has_plane(Plane::position), has_normal = evidence.has_plane(Plane::normal);
  for (size_t k = 0; k < 3; ++k) {
    double off = k > 0 || !evidence.has_plane(Plane::depth) ? 0 : (sketched.depth - given.depth) * 10;
    if (has_position) off = (sketched.position[k] - given.position[k]) / extent;
    out.push_back(same ? off : kNothing);
  }
  // Interpolated normals are not of unit length, and some planes hold them made so.
  const Triple3 a = unit(sketched.normal), b = unit(given.normal);
  for (size_t k = 0; k < 3; ++k) out.push_back(!same ? kNothing : has_normal ? 0.1 * (a[k] - b[k]) : 0);
}

/// One object's pixels, and what lies behind or before it there.
class ObjectFit {
 public:
  ObjectFit(const PlaneEvidence& evidence, uint32_t object)
      : evidence_(evidence), object_(object), border_(evidence, object) {
    const double number = object + 1.0;
    for (const EvidentPixel& p : evidence.pixels)
      if (p.given.object == number || (p.expected.covered && p.expected.object == number) ||
          (p.given.object < 0 && p.wrong))
        pixels_.push_back(&p);
    pixels_ = thinned(pixels_, kMostOfObject);
    for (const EvidentPixel* p : pixels_) places_.push_back(p->at);
    extent_ = extent_of(evidence);
    bare_ = bare_scene(evidence.scene, evidence.scene.instances[object].mesh);
    sketch_.emplace(places_, evidence.pipeline);
  }

  /// What the fault leaves of the differences at the object's pixels, six a pixel; the object alone is drawn.
  std::vector<double> residuals(const PlaneFault& fault, const FaultParameter& parameter) {
    Scene scene = bare_;
    Pipeline pipeline = evidence_.pipeline;
    const double number = object_ + 1.0;
    std::vector<double> out;
    fault.edit(scene, pipeline, parameter);  // or it changes nothing
    sketch_->clear(pipeline);
    sketch_->draw(scene, pipeline, scene.meshes[scene.instances[object_].mesh], object_);
    for (size_t i = 0; i < pixels_.size(); ++i) {
      const PlaneValues& drawn = sketch_->pixels()[i];
      const EvidentPixel& p = *pixels_[i];
      // Without identifiers what it does not cover may be anything.
      const bool is_given = p.given.object < 0 ? p.given.covered && drawn.covered : p.given.object == number;
      // Something else before it says nothing.
      const bool hidden = drawn.covered && !is_given && p.given.covered && p.given.depth <= drawn.depth;
      if (hidden || (!drawn.covered && !is_given)) {
        out.insert(out.end(), 6, 0.0);
        continue;
      }
      add_differences(evidence_, extent_, drawn, p.given, drawn.covered && is_given, out);
    }
    return out;
  }
  /// The error of the residuals, and a cost of 1 for each pixel where the outline is wrong: it alone tells how far an
  /// object is moved along a face.
  double cost(const PlaneFault& fault, const FaultParameter& parameter) {
    Scene scene = bare_;
    Pipeline pipeline = evidence_.pipeline;
    fault.edit(scene, pipeline, parameter);
    return robust_error(residuals(fault, parameter), kOnFaces) + border_.mismatches(scene, pipeline);
  }
  bool has_border() const { return !border_.empty(); }
  size_t pixels() const { return pixels_.size(); }
  double extent() const { return extent_; }

 private:
  const PlaneEvidence& evidence_;
  const uint32_t object_;
  ObjectBorder border_;
  std::vector<const EvidentPixel*> pixels_;
  std::vector<SampledPixel> places_;
  double extent_ = 1;
  Scene bare_;
  std::optional<Sketch> sketch_;
};

/// Fits the camera to the pixels that have a surface. Residuals compare a pixel's place with where the camera projects
/// the captured position or, where positions were not captured, the captured values with a sketch.
class CameraFit {
 public:
  explicit CameraFit(const PlaneEvidence& evidence) : evidence_(evidence), bare_(bare_scene(evidence.scene, {})) {
    for (const EvidentPixel& p : evidence.pixels)
      if (p.given.covered && p.expected.covered) pixels_.push_back(&p);
    pixels_ = thinned(pixels_, kMostOfCamera);
    extent_ = extent_of(evidence);
    if (evidence.has_plane(Plane::position)) return;
    for (const EvidentPixel* p : pixels_) places_.push_back(p->at);
    sketch_.emplace(places_, evidence.pipeline);
  }

  std::vector<double> residuals(const PlaneFault& fault, const FaultParameter& parameter) {
    Scene scene = bare_;
    Pipeline pipeline = evidence_.pipeline;
    fault.edit(scene, pipeline, parameter);  // or it changes nothing
    return sketch_ ? sketched(scene, pipeline) : projected(scene, pipeline);
  }
  size_t pixels() const { return pixels_.size(); }
  double extent() const { return extent_; }

 private:
  std::vector<double> projected(const Scene& scene, const Pipeline& p) const {
    const Matrix4 m = projection_of(scene.camera, p.geometry, p.width, p.height);
    const Viewport v = resolved_viewport(p.geometry, p.width, p.height);
    const bool flip = p.geometry.clip_origin == ClipOrigin::upper_left, depth = evidence_.has_plane(Plane::depth);
    const double near = double(p.geometry.depth_near), far = double(p.geometry.depth_far);
    const bool zero = p.geometry.clip_depth == ClipDepth::zero_to_one;
    std::vector<double> out;
    for (const EvidentPixel* pixel : pixels_) {
      const auto& at = pixel->given.position;
      const Vector4 c = transformed(m, {at[0], at[1], at[2], 1});
      const double x = 2 * (pixel->at.x + 0.5 - v.x) / v.width - 1,
                   y = 2 * (p.height - 1 - pixel->at.y + 0.5 - v.y) / v.height - 1, z = c[2] / c[3];
      out.push_back(c[0] / c[3] - x), out.push_back(c[1] / c[3] - (flip ? -y : y));
      const double window = zero ? z * (far - near) + near : z * (far - near) / 2 + (near + far) / 2;
      out.push_back(depth ? window - pixel->given.depth : 0);
    }
    return out;
  }
  std::vector<double> sketched(const Scene& scene, const Pipeline& pipeline) {
    sketch_->clear(pipeline);
    for (uint32_t i = 0; i < scene.instances.size(); ++i)
      sketch_->draw(scene, pipeline, evidence_.scene.meshes[scene.instances[i].mesh], i);
    std::vector<double> out;
    for (size_t i = 0; i < pixels_.size(); ++i) {
      const PlaneValues &drawn = sketch_->pixels()[i], &given = pixels_[i]->given;
      const bool same = drawn.covered && (given.object < 0 || given.object == drawn.object);
      add_differences(evidence_, extent_, drawn, given, same, out);
    }
    return out;
  }

  const PlaneEvidence& evidence_;
  std::vector<const EvidentPixel*> pixels_;
  std::vector<SampledPixel> places_;
  double extent_ = 1;
  Scene bare_;
  std::optional<Sketch> sketch_;
};

/// Fits the fault's vector from three of `suspects`, the first and the two that leave least, and returns the best fit.
/// Empty where too few pixels tell, or no fit is finite.
template <class Fitter>
std::vector<FaultParameter> fitted_parameters(const PlaneFault& fault, std::span<const FaultParameter> suspects,
                                              Fitter& fitter) {
  if (fitter.pixels() < 4) return {};
  std::vector<std::pair<double, size_t>> starts;
  for (size_t i = 0; i < suspects.size(); ++i)
    starts.emplace_back(robust_error(fitter.residuals(fault, suspects[i]), kFitScales[1]), i);
  if (starts.size() > 3) std::stable_sort(starts.begin() + 1, starts.end());  // the first changes nothing, or little
  const double size = fault.change_of < 0 ? -fault.change_of * fitter.extent() : fault.change_of;
  std::optional<FaultParameter> best;
  double least = HUGE_VAL;
  for (size_t i = 0; i < std::min<size_t>(3, starts.size()); ++i) {
    const FaultParameter& from = suspects[starts[i].second];
    const auto at = [&](const Triple3& vector) { return FaultParameter(from.number, vector, from.part); };
    const Residuals residuals = [&](const Triple3& vector) { return fitter.residuals(fault, at(vector)); };
    const Triple3 vector = fitted({residuals, fault.numbers.vector, size, kFitScales, fault.start}, from.vector);
    const auto is = [](double v) { return std::isfinite(v) && std::fabs(v) < 1e9; };
    if (!std::all_of(vector.begin(), vector.end(), is)) continue;
    const double error = robust_error(residuals(vector), kFitScales[2]);
    if (error < least) least = error, best = at(vector);
  }
  if (!best) return {};
  return {*best};
}

/// Improves the parameter's vector by the object's outline. Leaves mirrored objects as they are: most bodies have the
/// same outline when mirrored.
void settle(const PlaneFault& fault, ObjectFit& fitter, FaultParameter& parameter) {
  const auto is_mirror = [&](double v) { return fault.start == 1 && v < 0; };
  if (std::any_of(parameter.vector.begin(), parameter.vector.end(), is_mirror)) return;
  const auto cost = [&](const Triple3& vector) {
    return fitter.cost(fault, FaultParameter(parameter.number, vector, parameter.part));
  };
  const double size = fault.change_of < 0 ? -fault.change_of * fitter.extent() : fault.change_of;
  parameter.vector = settled(cost, fault.numbers.vector, size, parameter.vector);
}

}  // namespace

std::vector<uint32_t> suspected_objects(const PlaneEvidence& evidence) {
  std::map<double, double> votes;
  double wrong = 0;
  for (const EvidentPixel& p : evidence.pixels) {
    if (!p.wrong) continue;
    wrong += p.at.weight;
    if (p.expected.covered) votes[p.expected.object] += p.at.weight;
    if (p.given.object > 0 && p.given.object != p.expected.object) votes[p.given.object] += p.at.weight;
  }
  std::vector<std::pair<double, double>> ranked;
  for (const auto& [object, weight] : votes) ranked.emplace_back(-weight, object);
  std::sort(ranked.begin(), ranked.end());
  std::vector<uint32_t> objects;
  for (const auto& [weight, object] : ranked)
    if (objects.size() < 2 && -weight >= kBlamed * wrong && object <= double(evidence.scene.instances.size()))
      objects.push_back(uint32_t(object) - 1);
  return objects;
}

std::vector<FaultParameter> suspected_parameters(const PlaneEvidence& evidence, const PlaneFault& fault) {
  // What is wrong of a camera is wrong nearly everywhere.
  double wrong = 0, covered = 0;
  for (const EvidentPixel& p : evidence.pixels)
    wrong += p.wrong ? p.at.weight : 0, covered += p.expected.covered || p.given.covered ? p.at.weight : 0;
  if (fault.fit == Fit::camera && wrong < kBlamed * covered) return {};
  const std::vector<FaultParameter> suspects = fault.suspects(evidence);
  if (suspects.empty() || fault.fit == Fit::none) return suspects;
  if (fault.fit == Fit::camera) {
    CameraFit fitter(evidence);
    return fitted_parameters(fault, suspects, fitter);
  }
  std::vector<FaultParameter> all;
  for (size_t from = 0; from < suspects.size();) {  // those of one object, or part of it, stand together
    size_t end = from;
    while (end < suspects.size() && suspects[end].number == suspects[from].number &&
           suspects[end].part == suspects[from].part)
      ++end;
    ObjectFit fitter(evidence, uint32_t(suspects[from].number));
    std::vector<FaultParameter> found = fitted_parameters(fault, {&suspects[from], end - from}, fitter);
    if (fitter.has_border())
      for (FaultParameter& p : found) settle(fault, fitter, p);
    all.insert(all.end(), found.begin(), found.end());
    from = end;
  }
  return all;
}

}  // namespace trueshade::oracle
