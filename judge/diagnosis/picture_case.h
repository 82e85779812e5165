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

/// Keeps pixels that a light pass has made, so that many faults that act after the pass can be tried on them.
class KnownPixels {
 public:
  /// The pixel at (x, y). `make` computes it unless it is kept. Any thread may call.
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

/// Faults that a picture is supposed to have, all at once. They act in the order of the members.
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

  /// Supposes one more fault. Sets `known` to null where the fault changes what the light pass makes.
  void suppose(const PictureFault& fault, const FaultParameter& parameter);
};

/// A captured picture beside predictions of what it should be. Borrows the scene and the capture.
class PictureCase {
 public:
  /// Chooses the samples of pixels. Leaves out pixels that are not predicted: those under glass, and those where the
  /// capture holds the nominal value but the prediction differs. Throws as CapturedSurface does.
  PictureCase(const Scene& scene, const Pipeline& pipeline, const Profile& profile, const Capture& capture,
              const StageVerdict& stage);

  /// The supposition that nothing is wrong.
  PictureSupposition right() const {
    PictureSupposition s;
    s.pass = right_, s.known = known_;
    return s;
  }
  /// The sampled pixels that findings are judged by, some 1500 at most.
  const std::vector<SampledPixel>& sample() const { return sample_; }
  /// A smaller sample of pixels, for a first, cheap look at each fault.
  const std::vector<SampledPixel>& few() const { return few_; }

  /// How far the captured pixel is from the prediction: the largest difference of a channel, in steps of the format. 0
  /// where it is below kSameSteps, and in a tile that is supposed to be stale. 1000 where a captured channel is NaN or
  /// infinite and the predicted one is finite.
  double steps_off(const PictureSupposition& supposed, const SampledPixel& pixel) const;
  /// How well the supposed faults predict `pixels`: how much is still off, and which pixels become right or wrong.
  ///   off_if_right: steps_off() of each of `pixels` without any fault
  Disagreement disagreement(const PictureSupposition& supposed, const std::vector<SampledPixel>& pixels,
                            const std::vector<double>& off_if_right) const;
  /// How many steps each of `pixels` is off under the supposed faults.
  std::vector<double> steps_off(const PictureSupposition& supposed, const std::vector<SampledPixel>& pixels) const;

  /// What is predicted of one pixel. Faults that change the finished colour may act before the target stores it, or
  /// after, in which case it is stored again; both are predicted.
  struct Prediction {
    Color drawn;            ///< what is stored if they act before the store
    Color stored, nearest;  ///< if they act after it, and are stored again: as the pipeline says, or to nearest
    Color value;            ///< the number whose store is `drawn`
  };
  /// Predicts the pixel at (x, y), from the top left. Call make_tiles() before, if tiles are supposed.
  Prediction predicted(const PictureSupposition& supposed, int x, int y) const;
  /// What the capture holds in one channel of the pixel: a code or a float.
  double given(int x, int y, int channel) const { return color_.stored(x, y, channel); }
  /// The values that the captured pixel's codes or floats stand for; 0 for colour channels that it lacks, 1 for an
  /// alpha.
  Color given_value(int x, int y) const;
  /// How many channels the picture has, at most 4.
  int channels() const { return std::min(color_.channels, 4); }
  /// steps_off() of one channel; it does not ask whether the pixel is in a stale tile.
  double steps_off(const PictureSupposition& supposed, const Prediction& predicted, int x, int y, int channel) const;
  /// The number to report as predicted: the captured one where it agrees with the prediction or the tile is stale, else
  /// predicted.stored.
  double shown(const PictureSupposition& supposed, const Prediction& predicted, int x, int y, int channel) const;
  /// Whether the pixel lies in a tile that the supposition takes for stale.
  bool in_stale_tile(const PictureSupposition& supposed, int x, int y) const;
  /// Whether the sample's captured codes differ from the predicted values as dithering makes them differ. For targets
  /// of codes that are stored once, not blended.
  bool looks_dithered(const PictureSupposition& supposed) const;
  /// The distance of neighbouring numbers of the target's format near `value`; 1e-5 of the value for 32-bit floats. In
  /// floating point it is never less than near 2^-9.
  double step_at(double value, int channel) const;

  /// The surface that the light pass reads at a pixel: from the captured planes, and after heal() from the expected
  /// ones.
  PlainSurface surface(int x, int y) const;
  /// Makes surface() take the planes that are wrong from `expected` instead of the capture. Forgets the pixels that
  /// were kept. No other thread may use this object meanwhile.
  void heal(std::shared_ptr<const ExpectedPlanes> expected, const std::array<bool, kPlanes>& wrong) {
    expected_ = std::move(expected), wrong_ = wrong;
    known_ = std::make_shared<KnownPixels>();
  }
  /// From now on right() draws by this light program. Drops the pixels that right() has kept. No other thread may use
  /// this object meanwhile.
  void draw_by(std::shared_ptr<const PlainProgram> program) {
    right_.program = std::move(program);
    known_ = std::make_shared<KnownPixels>();
  }
  /// Which pixel of the drawn picture is shown at (x, y) where the picture is moved by `move`; beyond its edge, the
  /// edge's pixel.
  std::array<int, 2> source(const Move& move, int x, int y) const;
  /// What it costs to suppose stale tiles of that side: StaleTiles::cost().
  double stale_cost(int side) const { return stale_.cost(side); }
  /// Makes the boxes that tiles' light lists are made from, unless they are made. No other thread may use this object
  /// meanwhile.
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

/// How densely a pixel is sampled. A dull one says little when it is right: it is black, or shows no surface.
enum class PixelUse : uint8_t { usual, dull, left_out };

/// A sample of a stage's pixels, the same one every time. At most most[i] pixels come from stratum i: violations,
/// store_2 pixels, other pixels, and other pixels that are dull. Each has the weight of the pixels that it stands for.
/// Pixels that are left out, by `uses` or by the stage, are not sampled.
///   uses: of each pixel of the stage
std::vector<SampledPixel> sampled_pixels(const StageVerdict& stage, const std::array<size_t, 4>& most,
                                         const std::vector<PixelUse>& uses);

}  // namespace trueshade::oracle
