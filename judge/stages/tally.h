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

/// A plane of the capture, and how its format stores. Values of unorm planes are integer codes, 0 to the largest.
struct PlaneView {
  const Image* image = nullptr;
  FormatInfo layout = info(Format::rgba32f);
  int channels = 0;                       ///< those that are judged: of a target without alpha 3, whatever its format
  const DecodedPlane* decoded = nullptr;  ///< where the values are unpacked ones

  PlaneView() = default;
  /// Views an image, which it borrows. Of null it makes an empty view, on which only operator bool may be called.
  explicit PlaneView(const Image* i);
  /// Whether the view has a plane.
  explicit operator bool() const { return image != nullptr; }
  /// What a channel holds: a code, a float or an integer. y from the top.
  double stored(int x, int y, int channel) const {
    if (!is_words_) return stored_otherwise(x, y, channel);
    uint32_t word;
    std::memcpy(&word, &image->texels[(pixel(x, y) * size_t(layout.channels) + size_t(channel)) * sizeof word],
                sizeof word);
    return layout.number_class == NumberClass::integer ? double(word) : double(std::bit_cast<float>(word));
  }
  /// Whether channels hold unorm codes.
  bool unorm() const { return layout.number_class == NumberClass::unorm; }
  /// How far what a shader unpacks may be from the pixel's unpacked value (DecodedPlane::reading_error); 0 for a plane
  /// that was not packed. y from the top.
  double reading_error(int x, int y) const {
    return decoded == nullptr ? 0 : decoded->at(decoded->reading_error, pixel(x, y));
  }
  /// How far storing the packed value may have moved the pixel's value (DecodedPlane::packing_error); 0 for a plane
  /// that was not packed. y from the top.
  double packing_error(int x, int y) const {
    return decoded == nullptr ? 0 : decoded->at(decoded->packing_error, pixel(x, y));
  }
  /// The index of a pixel in row-major order; y from the top.
  size_t pixel(int x, int y) const { return size_t(y) * size_t(image->width) + size_t(x); }
  /// Whether stores round: channels hold codes or floats of fewer than 32 bits.
  bool quantised() const { return unorm() || layout.small_float(); }
  /// What a channel would hold of `value` without rounding: in fixed point a code, of the sRGB encoding where the
  /// format has one; otherwise the value itself.
  double held(double value, int channel) const;
  /// The stored channel minus `expected`, which is in the unit of held(). Nothing where the format may have clamped it,
  /// for floats of 10 or 11 bits, and where one of the two is NaN or infinite. The caller adds `by_cause`.
  std::optional<Deviation> deviation(int x, int y, int channel, double expected) const;
  /// A constant that a shader writes, 0 or 1, as stored() reads it: every format stores it exactly.
  double constant(double value, int channel) const { return unorm() ? value * layout.largest_code(channel) : value; }

 private:
  double stored_otherwise(int x, int y, int channel) const;
  bool is_words_ = false;  ///< floats of 32 bits or integers
};

/// The name of a plane's channel in verdicts: `color.R`, `position.Z`, `uv.U`, `depth.Z`; planes of one number, such as
/// `id.object`, go by their own name.
std::string channel_of(std::string_view plane, int channel);

/// The capture's plane of that name (`color`: the target); an empty view if there is none. Error(bad_input) if its size
/// is not the pipeline's.
PlaneView plane_of(const Capture& capture, const Pipeline& pipeline, std::string_view name);

/// The capture's target, the plane `color`. Error(bad_input) if there is none, or its size is not the pipeline's.
PlaneView target_of(const Capture& capture, const Pipeline& pipeline);

/// One store that rounded, for comparison with the same store of the next pixel.
struct SeenStore {
  float value;   ///< the real value before the store
  bool is_sure;  ///< the likely rule leaves one outcome for it
  int8_t taken;  ///< as in StoreChoice
};

/// How one pixel compares with one surface: whether all channels are legal, the worst channel, and its roundings.
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

  /// Judges one channel: sets `legal` to false where `stored` is none of the values that an output in `range` may be
  /// stored as; NaN is one only where anything is. Otherwise notes the channel's error, its rounding, and the choice it
  /// had.
  void channel_is(const PlaneView& view, const char* name, int channel, const Range& range, double stored,
                  uint32_t pixel, const Profile& profile);
  /// Judges one channel whose value comes from a texture lookup, as channel_is() does, but another legal value than the
  /// nominal one sets `tex`, and no rounding is noted.
  void lookup_is(const PlaneView& view, const char* name, int channel, const Range& range, double stored,
                 uint32_t pixel, const Profile& profile);
  /// Judges one channel, as channel_is() does, whose legal values `texel` are known. `value`: the real number before
  /// the store.
  void texel_is(const PlaneView& view, const char* name, int channel, const LegalTexel& texel, double value,
                double stored, uint32_t pixel, const Profile& profile);
  /// Sets `legal` to false, and keeps the channel if it is the farthest outside so far; NaN is infinitely far.
  ///   unit: distance outside that counts as an excess of 1; the range's width where that is more
  void note(const char* name, int channel, const LegalTexel& legal, double stored, double unit);
};

/// What a store chose, by what the likely rule expects of its value: `likely`. Its chance is 0 where that rule excludes
/// what was stored.
StoreChoice choice_of(const PlaneView& view, int channel, uint32_t pixel, double value, const LegalTexel& likely,
                      double stored, const Profile& profile);

/// Whether pixels of that class are listed in a verdict (StageVerdict::worst): all but EXACT and STORE-2.
inline bool is_told(PixelClass c) { return c != PixelClass::exact && c != PixelClass::store_2; }

/// Whether a pixel, by its index, is in the pseudo-random sample that tests of materials look at: all pixels of a small
/// image, some 24,000 of a large one.
bool is_sampled(uint32_t pixel, int width, int height);

/// What was found in one row of an image, to be added up by verdict_of().
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

  /// Notes that a pixel (y * width + x, y from the top) may show another surface or branch, with the given probability.
  ///   surface: the instance and triangle nominally seen
  void may_be_other(uint32_t pixel, uint64_t surface, double chance);
  /// Adds the row's next pixel: its class, a comparison of its stores with those of the pixel to the left, and what
  /// record() adds. Stores of an UNDEFINED pixel do not count.
  ///   surface: the surface meant, in words; read where the class is_told()
  void take(int x, int y, PixelClass c, const Match& match, const std::string& surface);
  /// Adds the row's next pixel as one that is not judged.
  void leave_out() { classes.push_back(PixelClass::left_out); }
  /// Adds a pixel's errors, its rounding choices and, where the class is_told(), a WorstPixel. It leaves out the class,
  /// for stages that look at a pixel more than once.
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

/// The profile with what it leaves to the pipeline filled in. `ideal` rounds halves as the pipeline's half_round says;
/// for others that allow both ways, that way is nominal. `likely` becomes the tightest rule that the profile's fields
/// leave, nearest codes where they leave all.
Profile resolved(const Profile& profile, const Pipeline& pipeline);

/// Adds up the rows of a stage, from the top. Pixels of a row that was not judged are EXACT, and in no count.
StageVerdict verdict_of(std::string_view stage, const Profile& profile, int width, int height,
                        std::vector<RowTally>& rows);

}  // namespace trueshade::oracle
