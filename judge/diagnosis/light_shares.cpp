#include "judge/diagnosis/light_shares.h"

#include <algorithm>

namespace trueshade::oracle {

LightShares::LightShares(const Scene& scene, const Pipeline& pipeline, const Profile& profile, const Capture& capture,
                         const StageVerdict& lighting)
    : scene_(scene), case_(scene, pipeline, profile, capture, lighting), pass_(light_pass_of(scene, pipeline)) {
  for (const SampledPixel& at : case_.sample()) add(at.x, at.y);
  before_ = error_with([](const Share&) { return 0.0; });
}

/// Adds a pixel, if it tells anything. A channel whose difference is not finite, or that is as bright as codes can be,
/// gets the weight 0.
void LightShares::add(int x, int y) {
  SharedPixel pixel;
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
    const bool says_nothing = is_held || !std::isfinite(pixel.off[k]);
    pixel.weight[k] = says_nothing ? 0 : 1 / (error * error);
    if (says_nothing) pixel.off[k] = 0;
  }
  for (const LightAdded& added : lights_added(pass_, pixel.surface)) {
    if (!std::isfinite(added.term[0] + added.term[1] + added.term[2])) return;
    pixel.lights.push_back(share(pixel, added));
  }
  if (!pixel.lights.empty()) pixels_.push_back(std::move(pixel));
}

/// A light's term with the quantities that it may depend on; these are 0 of ambient light.
Share LightShares::share(const SharedPixel& pixel, const LightAdded& added) const {
  const Light& light = scene_.lights[added.light];
  Share s{added.light, added.term};
  if (is_ambient(light.type)) return s;
  const bool is_placed = !is_directional(light.type);
  const Triple3 way =
      is_placed ? minus(triple(light.position), pixel.surface.position) : times(triple(light.direction), -1);
  if (is_placed) s.d = std::sqrt(inner(way, way)), s.part = s.d / double(light.range);
  const Triple3 n = unit(pixel.surface.normal), l = unit(way);
  s.nl = inner(n, l);
  s.nh = inner(n, unit(plus(l, unit(minus(triple(scene_.camera.eye), pixel.surface.position)))));
  return s;
}

}  // namespace trueshade::oracle
