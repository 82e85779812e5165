#pragma once
// A captured picture against what its own G-buffer should have made it, under any faults that are supposed.
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <unordered_map>
#include <vector>

#include "judge/diagnosis/disagreement.h"
#include "judge/diagnosis/finding.h"
#include "judge/diagnosis/picture_faults.h"
#include "judge/diagnosis/picture_tiles.h"
#include "judge/diagnosis/plane_faults.h"
#include "judge/stages/captured_surface.h"

namespace trueshade::oracle {

/// Pixels as a light pass made them, so that what is done to the picture afterwards can be tried again and again.
class KnownPixels {
 public:
  template <class Make>
  PredictedPixel at(int x, int y, const Make& make) {
    const uint64_t key = uint64_t(uint32_t(y)) << 32 | uint32_t(x);
    {
      const std::shared_lock lock(asked_);
      if (const auto found = pixels_.find(key); found != pixels_.end()) return found->second;
    }
    const PredictedPixel pixel = make();
    const std::unique_lock lock(asked_);
    return pixels_.emplace(key, pixel).first->second;
  }

 private:
  std::shared_mutex asked_;
  std::unordered_map<uint64_t, PredictedPixel> pixels_;
};

/// Faults that a picture is supposed to have, all at once; they are predicted in this order.
struct PictureSupposition {
  LightPass pass;
  struct Step {
    void (*change)(Color&, double, int x, int y);
    double parameter;
  };
  std::vector<Step> steps;
  Move move;
  int tile = 0, tile_from = 0;  ///< pixels a side of tiles; whose lists they have, of eight neighbours, or their own
  int tile_most = std::numeric_limits<int>::max();  ///< lights that a list holds
  double reach = 0;
  int stale = 0;                       ///< pixels a side of tiles, those of which that stand out hold anything
  std::shared_ptr<KnownPixels> known;  ///< by the pass; null: not worth keeping

  void suppose(const PictureFault& fault, const FaultParameter& parameter);
};

/// Borrows the scene and the capture.
class PictureCase {
 public:
  PictureCase(const Scene& scene, const Pipeline& pipeline, const Profile& profile, const Capture& capture,
              const StageVerdict& stage);

  PictureSupposition right() const {
    PictureSupposition s;
    s.pass = right_, s.known = known_;
    return s;
  }
  const std::vector<SampledPixel>& sample() const { return sample_; }
  const std::vector<SampledPixel>& few() const { return few_; }  ///< of the sample, for a first look

  /// How many steps of the format the pixel is off.
  double steps_off(const PictureSupposition& supposed, const SampledPixel& pixel) const;
  /// Over pixels, against what they are off where nothing is wrong.
  Disagreement disagreement(const PictureSupposition& supposed, const std::vector<SampledPixel>& pixels,
                            const std::vector<double>& off_if_right) const;
  std::vector<double> steps_off(const PictureSupposition& supposed, const std::vector<SampledPixel>& pixels) const;

  /// Channel by channel: what the picture stands for before it is stored, and after.
  struct Prediction {
    Color drawn;            ///< where the faults come before the store
    Color stored, nearest;  ///< where they come after it, stored again as the pipeline says, or to nearest
    Color value;            ///< of `drawn`, before the store
  };
  Prediction predicted(const PictureSupposition& supposed, int x, int y) const;
  double given(int x, int y, int channel) const { return color_.stored(x, y, channel); }
  Color given_value(int x, int y) const;
  int channels() const { return std::min(color_.channels, 4); }
  double steps_off(const PictureSupposition& supposed, const Prediction& predicted, int x, int y, int channel) const;
  /// The number that a supposition predicts: what was given, where it is as good as what is predicted.
  double shown(const PictureSupposition& supposed, const Prediction& predicted, int x, int y, int channel) const;
  bool in_stale_tile(const PictureSupposition& supposed, int x, int y) const;
  /// Whether what is left beside the values that are predicted is a dither's. Of codes that are stored once.
  bool looks_dithered(const PictureSupposition& supposed) const;
  /// One step of the format, in values, about a value.
  double step_at(double value, int channel) const;

  PlainSurface surface(int x, int y) const;
  /// From now on the planes that are wrong are read as they should be. Not while others ask.
  void heal(std::shared_ptr<const ExpectedPlanes> expected, const std::array<bool, kPlanes>& wrong) {
    expected_ = std::move(expected), wrong_ = wrong;
    known_ = std::make_shared<KnownPixels>();
  }
  /// The pixel that is shown at (x, y).
  std::array<int, 2> source(const Move& move, int x, int y) const;
  double stale_cost(int side) const { return stale_.cost(side); }
  /// Makes the tiles' boxes, which lists of lights are made from. Not while others ask.
  void make_tiles();

 private:
  void heal_surface(int x, int y, PlainSurface& surface) const;
  void draw_sample(const StageVerdict& stage, const Profile& profile, const Capture& capture);

  const Scene& scene_;
  const Pipeline pipeline_;
  const CapturedSurface captured_;
  const PlaneView color_;
  const PixelMask& mask_;
  LightPass right_;
  std::vector<SampledPixel> sample_, few_;
  StaleTiles stale_;
  std::shared_ptr<const TileLists> tiles_;
  std::shared_ptr<KnownPixels> known_ = std::make_shared<KnownPixels>();  ///< where nothing is wrong
  std::shared_ptr<const ExpectedPlanes> expected_;
  std::array<bool, kPlanes> wrong_{};
};

/// Whether a pixel that is as it should be says much: dull ones are black, or nothing is drawn there.
enum class PixelUse : uint8_t { usual, dull, left_out };

/// The strata of a stage's pixels, each sampled: violations, second neighbours, others, and of these the dull ones.
std::vector<SampledPixel> sampled_pixels(const StageVerdict& stage, const std::array<size_t, 4>& most,
                                         const std::vector<PixelUse>& uses);

}  // namespace trueshade::oracle
