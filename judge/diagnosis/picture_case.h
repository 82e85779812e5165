#pragma once
// Compares a captured picture with the one that a light pass, right or with supposed faults, makes of the capture's own
// G-buffer.
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

/// Keeps pixels that a light pass has made, so that many faults of what follows the pass can be tried on them.
class KnownPixels {
 public:
  /// The pixel at (x, y), which `make` computes at the first call; from any thread.
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
  int tile = 0, tile_from = 0;                      ///< side in pixels of tiles, 0: none; TileLists::list()'s `from`
  int tile_most = std::numeric_limits<int>::max();  ///< the most lights in a tile's list
  double reach = 0;                                 ///< steps that a value may be off before its store: a dither's
  int stale = 0;                       ///< side in pixels of tiles, of which those that stand out hold anything; or 0
  std::shared_ptr<KnownPixels> known;  ///< pixels that `pass` made; null: none are kept

  /// Adds a fault to those that are supposed. Drops `known` where the fault changes what the pass makes.
  void suppose(const PictureFault& fault, const FaultParameter& parameter);
};

/// A captured picture beside predictions of it. Borrows the scene and the capture.
class PictureCase {
 public:
  /// Chooses the samples. They leave out pixels that are not predicted: under glass, and where the capture holds the
  /// nominal value and the prediction is another. Throws as CapturedSurface does.
  PictureCase(const Scene& scene, const Pipeline& pipeline, const Profile& profile, const Capture& capture,
              const StageVerdict& stage);

  /// A picture without a fault.
  PictureSupposition right() const {
    PictureSupposition s;
    s.pass = right_, s.known = known_;
    return s;
  }
  /// The sample that findings are judged by.
  const std::vector<SampledPixel>& sample() const { return sample_; }
  /// A smaller sample, for a first look.
  const std::vector<SampledPixel>& few() const { return few_; }

  /// How far the captured pixel is from the prediction: the largest difference of a channel, in steps of the format. 0
  /// below kSameSteps, and in a tile that is supposed to be stale. 1000 where a captured channel is NaN or infinite and
  /// the predicted one is finite.
  double steps_off(const PictureSupposition& supposed, const SampledPixel& pixel) const;
  /// Sums up how well supposed faults predict `pixels`, which of these they explain and which they contradict.
  ///   off_if_right: steps_off() of each of `pixels` without any fault
  Disagreement disagreement(const PictureSupposition& supposed, const std::vector<SampledPixel>& pixels,
                            const std::vector<double>& off_if_right) const;
  /// steps_off() of each of `pixels`.
  std::vector<double> steps_off(const PictureSupposition& supposed, const std::vector<SampledPixel>& pixels) const;

  /// A pixel under the supposed faults. Those that change a finished color may act before the target stores it or
  /// after; both are predicted.
  struct Prediction {
    Color drawn;            ///< what is stored if they act before the store
    Color stored, nearest;  ///< if they act after it, and are stored again: as the pipeline says, or to nearest
    Color value;            ///< the number whose store is `drawn`
  };
  /// Predicts the pixel at (x, y), from the top left. make_tiles() comes before, where tiles are supposed.
  Prediction predicted(const PictureSupposition& supposed, int x, int y) const;
  /// The captured code or float.
  double given(int x, int y, int channel) const { return color_.stored(x, y, channel); }
  /// The values that the captured codes or floats stand for; 0, and an alpha of 1, of channels that there are not.
  Color given_value(int x, int y) const;
  /// How many channels the picture has, at most 4.
  int channels() const { return std::min(color_.channels, 4); }
  /// steps_off() of one channel, whatever is supposed of stale tiles.
  double steps_off(const PictureSupposition& supposed, const Prediction& predicted, int x, int y, int channel) const;
  /// The number to report as predicted: the captured one where it agrees with the prediction, else predicted.stored.
  double shown(const PictureSupposition& supposed, const Prediction& predicted, int x, int y, int channel) const;
  /// Whether the pixel is in a tile that is supposed to be stale.
  bool in_stale_tile(const PictureSupposition& supposed, int x, int y) const;
  /// Whether the captured codes differ from the predicted values as a dither makes them. For codes that are stored
  /// once.
  bool looks_dithered(const PictureSupposition& supposed) const;
  /// How far neighbouring numbers of the target's format lie apart near `value`; 1e-5 of it for 32-bit floats. Of
  /// floats below 2^-9 it is that of 2^-9.
  double step_at(double value, int channel) const;

  /// The surface that the light pass reads at a pixel, from the capture's planes.
  PlainSurface surface(int x, int y) const;
  /// From now on surface() takes the planes that are wrong from `expected`, not from the capture. Drops the pixels
  /// that right() has kept. Not while other threads ask.
  void heal(std::shared_ptr<const ExpectedPlanes> expected, const std::array<bool, kPlanes>& wrong) {
    expected_ = std::move(expected), wrong_ = wrong;
    known_ = std::make_shared<KnownPixels>();
  }
  /// The pixel of the drawn picture that is shown at (x, y) where the picture is moved; beyond its edge, the edge's
  /// pixel.
  std::array<int, 2> source(const Move& move, int x, int y) const;
  /// StaleTiles::cost().
  double stale_cost(int side) const { return stale_.cost(side); }
  /// Makes the tiles' boxes, which lists of lights are made from, unless they are made. Not while other threads ask.
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

/// How densely pixels are sampled. A dull one says little where it is right: it is black, or nothing is drawn there.
enum class PixelUse : uint8_t { usual, dull, left_out };

/// A sample of a stage's pixels, the same one every time. It has at most most[i] pixels of stratum i: violations,
/// stores of another legal neighbour (store_2), other pixels, and other pixels that are dull. Each has the weight of
/// the pixels of its stratum that it stands for. Pixels that are left out, by `uses` or by the stage, are in none.
///   uses: of each pixel of the stage
std::vector<SampledPixel> sampled_pixels(const StageVerdict& stage, const std::array<size_t, 4>& most,
                                         const std::vector<PixelUse>& uses);

}  // namespace trueshade::oracle
