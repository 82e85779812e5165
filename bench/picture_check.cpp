#include "bench/picture_check.h"

#include <algorithm>
#include <cmath>

namespace trueshade {

namespace {

bool is_textured(const Scene& scene) {
  return std::any_of(scene.materials.begin(), scene.materials.end(), [](const Material& m) { return m.textured(); });
}

}  // namespace

uint64_t one_pixel_in(const Scene& scene) { return is_textured(scene) ? 40 : 100; }

double picture_codes(const Scene& scene, Strategy strategy) {
  return is_textured(scene) && blends_lights(strategy) ? 2.0 + std::sqrt(double(scene.lights.size())) : 2.0;
}

uint64_t pixels_apart(const Image& a, const Image& b, double codes) {
  uint64_t count = 0;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) {
      bool near = true;
      for (int k = 0; k < info(a.format).channels; ++k) {
        const double p = a.value(x, y, k), q = b.value(x, y, k);
        const double code = std::max({1.0, std::fabs(p), std::fabs(q)}) / 255.0;
        near = near && std::fabs(p - q) <= (codes + 1e-3) * code;  // the last: values are rounded quotients of codes
      }
      count += near ? 0 : 1;
    }
  return count;
}

PictureCheck picture_check(const PreparedScene& prepared, const Execution& execution, const Pipeline& pipeline,
                           const Image& timed, const PeerPicture& theirs) {
  const Image ours = render_frame(prepared, theirs.as, execution).color;
  const double codes =
      std::max(picture_codes(prepared.scene(), theirs.as.strategy), picture_codes(prepared.scene(), pipeline.strategy));
  return {theirs.as.strategy,
          blends_lights(theirs.as.strategy) == blends_lights(pipeline.strategy),
          codes,
          pixels_apart(theirs.image, ours, codes),
          pixels_apart(theirs.image, timed, codes),
          uint64_t(ours.width) * uint64_t(ours.height),
          one_pixel_in(prepared.scene())};
}

}  // namespace trueshade
