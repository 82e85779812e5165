#pragma once
// Building a verdict: rows are judged apart and added up in order.
#include <algorithm>
#include <bit>
#include <cstring>
#include <optional>

#include "core/image.h"
#include "judge/legal/store.h"
#include "judge/stages/verdict.h"
#include "oracle/capture.h"
#include "scenes/pipeline/pipeline.h"

namespace trueshade::oracle {

/// A plane of the capture, with what its format means for a store. Values of unorm planes are codes.
struct PlaneView {
  const Image* image = nullptr;
  FormatInfo layout = info(Format::rgba32f);
  int channels = 0;                       ///< those that are judged: of a target without alpha 3, whatever its format
  const DecodedPlane* decoded = nullptr;  ///< where the values are unpacked ones

  PlaneView() = default;
  /// Borrows the image; null: an empty view, of which nothing but operator bool is asked.
  explicit PlaneView(const Image* i);
  /// Whether there is a plane.
  explicit operator bool() const { return image != nullptr; }
  /// The code, or the float or integer, that a channel holds; y from the top.
  double stored(int x, int y, int channel) const {
    if (!is_words_) return stored_otherwise(x, y, channel);
    uint32_t word;
    std::memcpy(&word, &image->texels[(pixel(x, y) * size_t(layout.channels) + size_t(channel)) * sizeof word],
                sizeof word);
    return layout.number_class == NumberClass::integer ? double(word) : double(std::bit_cast<float>(word));
  }
  /// Whether channels hold codes.
  bool unorm() const { return layout.number_class == NumberClass::unorm; }
  /// DecodedPlane::reading_error of a component; 0 of a plane that is as it was stored. y from the top.
  double reading_error(int x, int y) const {
    return decoded == nullptr ? 0 : decoded->at(decoded->reading_error, pixel(x, y));
  }
  /// DecodedPlane::packing_error of a component; 0 of a plane that is as it was stored. y from the top.
  double packing_error(int x, int y) const {
    return decoded == nullptr ? 0 : decoded->at(decoded->packing_error, pixel(x, y));
  }
  /// The index of a pixel; y from the top.
  size_t pixel(int x, int y) const { return size_t(y) * size_t(image->width) + size_t(x); }
  /// Whether channels hold codes or small floats, so that stores round.
  bool quantised() const { return unorm() || layout.small_float(); }
  /// A value as the plane would hold it but for rounding: of fixed point in codes, sRGB encoded; else the value itself.
  double held(double value, int channel) const;
  /// How far the stored channel is from what it is expected to hold; nothing where the format clamps it, where it is a
  /// float of 10 or 11 bits, and where one of the two is NaN or infinite. The causes are left to the caller.
  std::optional<Deviation> deviation(int x, int y, int channel, double expected) const;
  /// A constant a shader writes, as stored() has it: exactly stored by every format.
  double constant(double value, int channel) const { return unorm() ? value * layout.largest_code(channel) : value; }

 private:
  double stored_otherwise(int x, int y, int channel) const;
  bool is_words_ = false;  ///< floats of 32 bits or integers
};

/// A channel of a plane as verdicts name it: `color.R`, `position.Z`, `uv.U`, `depth.Z`; planes of one number, such as
/// `id.object`, go by their own name.
std::string channel_of(std::string_view plane, int channel);

/// The plane of that name, empty if there is none. Error(bad_input) if its size is not the pipeline's.
PlaneView plane_of(const Capture& capture, const Pipeline& pipeline, std::string_view name);

/// The target. Error(bad_input) if there is none, or its size is not the pipeline's.
PlaneView target_of(const Capture& capture, const Pipeline& pipeline);

/// A store of codes or small floats.
struct SeenStore {
  float value;   ///< the real value before it
  bool is_sure;  ///< the likely rule leaves one outcome
  int8_t taken;  ///< as in StoreChoice
};

/// How one pixel fares against one surface.
struct Match {
  bool legal = true;
  bool tex = false;         ///< some channel took a value that another legal lookup gives
  bool off_lookup = false;  ///< a float channel is farther from the nominal lookup's value than roundings make it
  bool second = false;      ///< some channel took a neighbour that is not the nominal one
  double worst_error = 0;   ///< float channels: |given - value| / bound
  double excess = 0;        ///< of the worst channel outside its range
  const char* plane = "";
  int channel = 0;
  LegalTexel legal_value;
  double given = 0;
  std::vector<StoreChoice> choices;
  std::vector<NearThreshold> near_thresholds;
  static constexpr size_t kMostStores = 24;  // that are compared with the next pixel's
  std::array<SeenStore, kMostStores> stores;
  size_t store_count = 0;
  uint64_t stored_values = 0;
  PixelClass layered = PixelClass::exact;  ///< of transparent fragments, another number than the nominal one

  /// Judges one channel: sets `legal` to false where the stored number is not legal, as NaN is not unless anything is.
  /// Else notes the channel's error, its rounding and the choice that it had.
  void channel_is(const PlaneView& view, const char* name, int channel, const Range& range, double stored,
                  uint32_t pixel, const Profile& profile);
  /// The same of a channel that a texture lookup decides: another legal value is TEX, and no rounding to be counted.
  void lookup_is(const PlaneView& view, const char* name, int channel, const Range& range, double stored,
                 uint32_t pixel, const Profile& profile);
  /// The same of a channel whose legal texels are known; `value` is the real one before the store.
  void texel_is(const PlaneView& view, const char* name, int channel, const LegalTexel& texel, double value,
                double stored, uint32_t pixel, const Profile& profile);
  /// Sets `legal` to false, and keeps the channel if it is the farthest outside so far; NaN is infinitely far.
  ///   unit: what the excess is counted in, unless the range is wider
  void note(const char* name, int channel, const LegalTexel& legal, double stored, double unit);
};

/// The choice that a store had, by what the likely rule makes of its value. One that the rule rules out has a chance of
/// 0, wherever it lies.
StoreChoice choice_of(const PlaneView& view, int channel, uint32_t pixel, double value, const LegalTexel& likely,
                      double stored, const Profile& profile);

/// Whether a verdict may list a pixel of that class.
inline bool is_told(PixelClass c) { return c != PixelClass::exact && c != PixelClass::store_2; }

/// Whether a pixel is one of those that tests of materials look at: of a large image some are enough.
bool is_sampled(uint32_t pixel, int width, int height);

/// One row's share of a verdict.
struct RowTally {
  std::vector<PixelClass> classes;
  uint64_t covered = 0, ambiguous = 0, stored_values = 0, stored_apart = 0;
  double predicted_other = 0, worst_error = 0;
  std::vector<SurfaceChoice> surface_choices;
  std::vector<StoreChoice> choices;
  std::vector<NearThreshold> near_thresholds;
  std::vector<WorstPixel> worst;
  std::vector<TexturedPixel> textured;
  std::vector<GlassDeviation> glass;
  std::vector<float> excess;  ///< of violations by x, as far as the last of them
  std::vector<float> shown;   ///< of some lit pixels: the part by which light must be off to be a violation there

  /// Notes that a pixel (y * width + x, y from the top) may show another surface or branch.
  void may_be_other(uint32_t pixel, uint64_t surface, double chance);
  /// Takes the pixel that comes next in the row: its class, its stores beside those of the pixel to the left, and what
  /// record() takes. Stores of an UNDEFINED pixel do not count.
  ///   surface: the surface meant, in words; read where the class is_told()
  void take(int x, int y, PixelClass c, const Match& match, const std::string& surface);
  /// Takes a pixel that is not judged.
  void leave_out() { classes.push_back(PixelClass::left_out); }
  /// Adds a pixel's figures, choices and, where the class is_told(), a WorstPixel. Not its class: for a stage that
  /// looks at a pixel more than once.
  void record(int x, int y, PixelClass c, const Match& match, const std::string& surface);

 private:
  void compare(int x, const Match& match);
  void keep_excess(int x, double outside);
  void keep_choices(int y, const Match& match);
  std::vector<uint32_t> runs_;                       ///< of each of `choices`: the run of records that it is of
  uint32_t records_ = 0;                             ///< that had a choice
  uint32_t one_in_ = 1;                              ///< so many runs is kept: a power of two
  std::array<SeenStore, Match::kMostStores> before;  ///< of the pixel to the left, if there is one
  size_t before_count = 0;
  int before_x = -2;
};

/// The profile as it applies: `ideal` follows the pipeline's half_round; of others that allow either, it is nominal.
/// The likely rule of stores is the tightest that the profile's knobs leave, nearest codes where they leave all.
Profile resolved(const Profile& profile, const Pipeline& pipeline);

/// Adds up the rows, from the top. The pixels of a row that was not judged are EXACT.
StageVerdict verdict_of(std::string_view stage, const Profile& profile, int width, int height,
                        std::vector<RowTally>& rows);

}  // namespace trueshade::oracle
