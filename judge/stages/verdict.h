#pragma once
// What a judgement says. Coordinates count from the top left, as image viewers do.
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/local_windows.h"
#include "judge/bounds/profile.h"
#include "judge/legal/pixel_class.h"
#include "judge/legal/possible_surfaces.h"
#include "judge/stages/cause_fit.h"

namespace trueshade::oracle {

/// A pixel worth looking at: what it may hold, and what it holds. Violations come first, the farthest outside first.
struct WorstPixel {
  int x = 0, y = 0;
  PixelClass pixel_class = PixelClass::violation;
  std::string plane;  ///< plane and channel that do not fit the likeliest surface: `normal.Y`, `color.R`
  double low = 0, high = 0, nominal = 0, given = 0;  ///< unorm8 in codes
  double excess = 0;  ///< how far outside, in units of the last place of the format or of the range, whichever is more
  std::string note;   ///< the surface meant: `instance 3, triangle 17`, or `nothing drawn`
};

/// A rounding of one channel that could go either way by the likely rule, or went a way that the rule excludes. Kept
/// for the tests of the whole image.
struct StoreChoice {
  uint32_t pixel;  ///< y * width + x, y from the top
  float value;     ///< the real value before the store: equal values are one choice, however many pixels have them
  float chance;    ///< predicted that the second neighbour is taken; 0 where the rule rules out what was stored
  int8_t side;     ///< where the nearest threshold lies: -1 below, 1 above
  int8_t taken;    ///< 0: the nominal one; -1, 1: one below, above
};

/// A value whose conversion to codes may, by the likely rule, give either of two codes. Kept where that rule may round
/// to a code more than half a code away. What was stored may be the sum of several such conversions, which stand one
/// behind another, in the order in which they were added.
struct NearThreshold {
  float low = 0, high = 0;        ///< bounds of the value, in codes from the middle between the two
  uint16_t threshold = 0;         ///< the lower of the two codes
  uint16_t threshold_of_sum = 0;  ///< the same of what a blended target becomes, had those before it gone as nominal
  uint8_t channel = 0;
  uint8_t sum_of = 1;          ///< how many conversions are of one sum, this one and those behind it
  uint8_t uppers = 0;          ///< of these, how many gave the upper code
  bool nominal_above = false;  ///< the upper code is the nominal one
};

/// A surface, or a branch of the shader, that a pixel may show in place of the nominal one. A pixel may have several.
struct SurfaceChoice {
  uint64_t surface;  ///< instance and triangle nominally seen: pixels of one triangle are one choice
  uint32_t pixel;    ///< y * width + x, y from the top
  float chance;      ///< predicted that another is shown
};

/// A pixel that shows the nominal surface, one whose material has maps.
struct TexturedPixel {
  uint32_t pixel;  ///< y * width + x, y from the top
  PossibleSurface surface;
};

/// What a renderer may do otherwise where it blends glass, each as one number for the whole picture.
enum class GlassCause : uint8_t {
  alpha,  ///< of the source
  step_r,
  step_g,
  step_b,  ///< codes that a blend is off on average, in each channel: a source is often one colour
};
inline constexpr size_t kGlassCauses = 4;

/// How far a channel of a pixel is from nominal, under transparent surfaces of one material.
struct GlassDeviation {
  uint32_t material;
  Deviation deviation;  ///< by GlassCause
};

/// What was found of one stage of the judgement, such as the lighting.
struct StageVerdict {
  std::string stage, profile;
  int width = 0, height = 0;
  std::vector<PixelClass> classes;               ///< row 0 at the top; rows that were not judged are EXACT
  std::array<uint64_t, kPixelClasses> counts{};  ///< by class
  uint64_t left_out = 0;                         ///< pixels that were not judged: in no other figure
  uint64_t covered = 0;                          ///< pixels where a surface is nominally seen
  uint64_t ambiguous = 0;                        ///< pixels with more than one legal surface or branch
  double predicted_other = 0;                    ///< expected number of edge + depth_tie + clip + branch pixels
  uint64_t stored_values = 0;                    ///< unorm and half channels judged
  std::vector<SurfaceChoice> surface_choices;    ///< of the ambiguous pixels
  std::vector<StoreChoice> choices;              ///< those of them with two likely values, or that took a second one
  std::vector<NearThreshold> near_thresholds;    ///< of fixed-point targets whose conversion to codes is seen
  uint64_t stored_apart = 0;  ///< stores whose value is that of the pixel to the left, which stored another code,
                              ///< although the likely rule leaves one outcome
  std::vector<TexturedPixel> textured;  ///< some of them, by numbers that look like chance
  std::vector<GlassDeviation> glass;    ///< of pixels under it, as many
  StoreRule rule;                       ///< by which `choices` are choices
  double worst_error = 0;               ///< float planes: largest |given - value| / bound
  std::vector<double> row_errors;       ///< the same of each row
  std::vector<WorstPixel> worst;        ///< at most 32
  double power = 0;           ///< of lights: light that is off by this part is a violation at half of the lit pixels,
                              ///< each by itself; 0 where nothing is lit, 1 where it may be off by more
  std::vector<float> excess;  ///< WorstPixel::excess of each pixel, 0 of legal ones; empty: there is no violation

  /// How many pixels were judged, not left out.
  uint64_t judged() const { return classes.size() - left_out; }
  /// How many pixels have this class.
  uint64_t count(PixelClass c) const { return counts[size_t(c)]; }
  /// Whether no pixel is a violation.
  bool passes() const { return count(PixelClass::violation) == 0; }
  /// How many pixels show another surface, or another branch of the shader, than the nominal one, legally.
  uint64_t explained() const {
    return count(PixelClass::edge) + count(PixelClass::depth_tie) + count(PixelClass::clip) + count(PixelClass::branch);
  }
};

/// For each of kWindowSides, the square window with the most errors: violations (LocalWindow::found) or pixels that
/// show another surface or branch (others). Sizes without any are left out. A pixel's error is WorstPixel::excess.
std::vector<LocalWindow> worst_windows(const StageVerdict& verdict);

}  // namespace trueshade::oracle
