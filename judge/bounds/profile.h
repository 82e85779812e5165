#pragma once
// What is known of the implementation that drew an image: the knobs of docs/gl_rules.md section 0 as values. A tighter
// profile allows fewer values; `unknown` allows whatever OpenGL allows.
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "judge/bounds/bounded.h"
#include "judge/bounds/profile_names.h"

namespace trueshade::oracle {

enum class SnapRule : uint8_t {
  nearest,      ///< round(w * 2^b), ties to even, of a coordinate that float errors may have moved
  nearest_0_6,  ///< either neighbour within 0.6 of 2^-b (D3D11.3 functional spec, 3.2.4.1)
  toward_zero,  ///< floor(w * 2^b): a wrong guess to be told apart when a profile is inferred
  unstated,     ///< anywhere within 0.6 of 2^-b: the two above, finer grids and none at all lie inside
};
enum class PlaneOrigin : uint8_t { snapped, unsnapped, either };
/// Which horizontal edges own the samples that lie on them; left edges always do. Window space, y up.
enum class FillRule : uint8_t {
  left_low,   ///< the lower one; the upper one where the clip origin is the upper left
  left_high,  ///< the other one of these
  unstated,
  left_first,  ///< the lower one, whatever the clip origin (Vulkan: memory's first rows)
  left_last,   ///< the upper one, whatever the clip origin
};
enum class HalfStore : uint8_t {
  toward_zero,
  nearest,
  either,
  through_halves,  ///< to the nearest half, either of two; floats of 11 and 10 bits are that half, cut
                   ///< (SwiftShader)
};
/// How a driver computes the interpolation planes of attributes and of 1 / w.
enum class PlaneForm : uint8_t {
  differences,  ///< through the vertices of what clipping leaves, by differences of their values
  homogeneous,  ///< sums of the values of all three vertices that were submitted, also those behind the eye, times the
                ///< gradients of their weights (Olano and Greer, 1997): a constant is a sum of terms that cancel
};
enum class BlendRule : uint8_t {
  any_precision,  ///< no less than the target's (GL 4.6 core, 17.3.6): anything from its codes to real numbers, fused
                  ///< or not
  float_once,     ///< docs/arithmetic.md section 10: codes added for ONE, ONE; else float32, rounded once
  mesa_codes,     ///< section 11: products of codes, rgb10_a2's in 16 bits; float32 for floats and sRGB
};

/// How far a texture lookup may be from real arithmetic (docs/gl_rules.md section 5). OpenGL states no precision of
/// weights, of filtering or of decoding. The defaults are what its conformance suite lets pass and what measured
/// drivers do.
struct Sampling {
  double weight_error = 0x1p-7;       ///< of a weight between texels of 8 bits a channel (VK-GL-CTS: 7 bits of u and v)
  double wide_weight_error = 0x1p-7;  ///< the same of other formats, and of sRGB
  double nearest_error = 0x1p-8;  ///< texels that the place of a nearest texel may be off: GPUs make it of 8 bits of
                                  ///< fraction (D3D11.3, 7.18.16), SwiftShader of 16 bits of the side
  double lerp_codes = 1;  ///< codes of 255 that one linear step (along u, along v, between levels) of 8-bit texels may
                          ///< be off: either neighbour of its value. 0: filtered as floats
  double srgb_codes = 0.5;   ///< codes that a decoded sRGB texel may be off (D3D11.3, 3.2.3; Mesa's are 0.343 off)
  bool decodes_late = true;  ///< sRGB may be filtered, in 8 bits, before it is decoded (GL 4.6 core, 8.24: "allowed")
  bool mesa_decode = false;  ///< sRGB is decoded by Mesa 22.3's polynomial; srgb_codes is from there
  bool any_scale = true;     ///< rho anything 8.14.1 allows; false: equation 8.11
  double lod_error = 0.05;   ///< of log2 rho: llvmpipe's log2 is 0.043 off
  double relative = 8 * 0x1p-23;  ///< of a filtered value, in floats
  int anisotropy = 1;  ///< most lookups along the longer axis of a pixel (EXT_texture_filter_anisotropic). No profile
                       ///< has more: OpenGL has them where they are asked for, and a diagnosis supposes that they were
  bool operator==(const Sampling&) const = default;
};

/// One way to round what is stored, as a known implementation does it. A profile may allow several; statistical tests
/// of a whole image find out which one the image follows.
struct StoreRule {
  double code_reach = 0.5;             ///< largest |stored code - real code|; the part beyond a half is taken to be
                                       ///< spread evenly
  bool mesa_codes = false;             ///< sRGB and 10-bit codes as llvmpipe stores them, and its blending
  bool sums_in_floats = false;         ///< blended values are kept in floats and rounded once, when the target is read
                                       ///< (softpipe)
  HalfStore half = HalfStore::either;  ///< either: not known yet
  bool intel_estimates = false;        ///< of mesa_codes: sRGB by the estimates of Intel's CPUs; else by AMD's
  bool operator==(const StoreRule&) const = default;
};

/// A rule as one line of text, such as `codes within 0.6, halves toward zero`.
std::string text(const StoreRule& rule);

/// What one implementation, or a whole class of them, is allowed to do.
struct Profile {
  std::string name = "unknown";
  int subpixel_bits = 4;  ///< GL's minimum (GL 4.6, table 23.53), unless the driver says more
  SnapRule snap = SnapRule::unstated;
  FillRule fill = FillRule::unstated;
  PlaneOrigin plane_origin = PlaneOrigin::either;
  PlaneForm planes = PlaneForm::differences;
  bool exact_vertices = false;  ///< clip coordinates and vertex attributes are those of docs/arithmetic.md, bit for bit
  bool exact_planes = false;    ///< attributes are within 1 ulp of the largest vertex value, inside the vertices' hull
  bool clips_to_view = true;    ///< triangles that leave the view may be cut at its sides and snapped again there
  double unorm_reach = 1.0;     ///< a unorm store may reach |code - 255 x|; 1 excludes 1 itself: an integer is exact
  /// A sRGB store may reach |code - 255 x| of the encoded value x: drivers approximate the power (docs/data/drivers.md,
  /// stores).
  double srgb_reach = 1.0;
  HalfStore half = HalfStore::either;
  StoreRule likely;  ///< the rule that is nominal among those allowed; resolved() finds it where its `half` is open
  double least_depth_unit = 1, most_depth_unit = 2;  ///< codes that a unit of polygon offset moves fixed-point depth by
  bool max_norm_slope = false;  ///< polygon offset takes the larger slope; else anything up to their Euclidean norm
  BlendRule blend = BlendRule::any_precision;
  /// The relative error of reading a unorm texel as a float, a division in GLSL. Drivers multiply by 1 / (2^b - 1):
  /// 1.25 ulp at most (docs/data/drivers.md, stores).
  double fetch_error = 2.5 * 0x1p-23;
  Sampling sampling;
  Arithmetic arithmetic;
};

/// The profile of a name in kDriverProfileNames; nothing for other names. Of `ideal`, resolved() takes the rounding of
/// halves from the pipeline; the others state their own.
std::optional<Profile> profile_named(std::string_view name);

/// The snapping rule in words, for reports.
const char* text(SnapRule rule);
/// The vertices that attribute planes go through, in words, for reports.
const char* text(PlaneOrigin origin);
/// The rounding of halves in words, for reports.
const char* text(HalfStore store);

}  // namespace trueshade::oracle
