#pragma once
// What lights should add to sampled pixels, and how far the picture is off there.
#include <cmath>
#include <vector>

#include "judge/diagnosis/picture_case.h"
#include "judge/diagnosis/triple.h"

namespace trueshade::oracle {

/// What one light should add to one pixel, and the quantities that light models depend on there.
struct Share {
  uint32_t light = 0;
  Triple3 term{};                   ///< what it should add
  double d = 0;                     ///< scene units; 0 of a light without a place
  double part = 0, nl = 0, nh = 0;  ///< d / range; cosines
};

/// One sampled pixel, how far it is off, and the lights that add to it.
struct SharedPixel {
  PlainSurface surface;
  Triple3 off{}, weight{};  ///< what is given minus what is right; 1 / error^2, 0 where the channel says nothing
  std::vector<Share> lights;
};

/// Sampled pixels of a picture, each with what every light should add to it. Borrows the scene and the capture.
class LightShares {
 public:
  /// Leaves out pixels that no light adds to, that show no surface or an unlit one, and of which a term is not finite.
  LightShares(const Scene& scene, const Pipeline& pipeline, const Profile& profile, const Capture& capture,
              const StageVerdict& lighting);

  /// The scene, which is borrowed.
  const Scene& scene() const { return scene_; }
  /// The light pass without any fault.
  const LightPass& pass() const { return pass_; }
  /// The sampled pixels that are left.
  const std::vector<SharedPixel>& pixels() const { return pixels_; }
  /// Whether the capture differs at any of the pixels from what is right.
  bool differs() const { return before_ > 0; }

  /// The sum over R, G, B of the squares of a difference, each in units of the channel's error.
  static double squared(const SharedPixel& p, const Triple3& off) {
    return p.weight[0] * off[0] * off[0] + p.weight[1] * off[1] * off[1] + p.weight[2] * off[2] * off[2];
  }

  /// The sum of squared differences, in units of the errors, that all pixels keep if part(share) times each light's
  /// term is added to what is right.
  template <class Part>
  double error_with(const Part& part) const {
    double sum = 0;
    for (const SharedPixel& p : pixels_) {
      Triple3 off = p.off;
      for (const Share& s : p.lights) off = minus(off, times(s.term, part(s)));
      sum += squared(p, off);
    }
    return sum;
  }
  /// The root mean square of what is left, as a share of that of the whole difference. From both, what rounding leaves
  /// of a right picture is taken off: a third of the squared half step a channel.
  ///   error: the sum of squares that is left, as error_with() gives it
  double left_of(double error) const {
    double rounding = 0;
    for (const SharedPixel& p : pixels_)
      for (const double w : p.weight) rounding += w > 0 ? 1.0 / 3 : 0;
    return std::sqrt(std::max(error - rounding, 0.0) / std::max(before_ - rounding, 1e-300));
  }

 private:
  void add(int x, int y);
  Share share(const SharedPixel& pixel, const LightAdded& added) const;

  const Scene& scene_;
  const PictureCase case_;
  const LightPass pass_;
  std::vector<SharedPixel> pixels_;
  double before_ = 0;
};

}  // namespace trueshade::oracle
