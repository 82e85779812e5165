#pragma once
// A renderer that takes every liberty OpenGL gives: rounding up or down at random, sums in any order, contraction or
// not, divisions and roots off by the ulps GLSL allows, any subpixel grid, planes from snapped or unsnapped vertices,
// any fill rule, either neighbour in every store, textures of few weight bits and any legal level. Independent of the
// renderer and of the judge; small scenes only, nothing may cross the near or far plane.
#include <array>
#include <optional>
#include <vector>

#include "oracle/capture.h"
#include "oracle/texture_lookup.h"
#include "scenes/builtin/pcg32.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade::testing {

/// One way to read textures, the same for a whole picture.
struct TextureWay {
  double rho = 0;         ///< -1: the largest derivative, 0: equation 8.11, 1: the larger ones along u and v added up
  double levels_off = 0;  ///< of log2 rho
  int weight_bits = 0;    ///< 0: exact
  bool cuts_weights = false;               ///< else to the nearest
  std::optional<double> step_threshold{};  ///< 8-bit steps give the upper code from this fraction on: 0.5 to nearest, 1
                                           ///< truncates; nothing: steps are in floats
  bool mesa_decode = false;                ///< sRGB by Mesa's polynomial
};

struct Liberties {
  bool any_rounding = true;  ///< otherwise to nearest, divisions and roots correct, as llvmpipe
  int subpixel_bits = 8;     ///< 0: vertices are not snapped
  bool snapped_planes = false;
  bool turn_ties = false;      ///< samples on an edge belong to the other side
  bool any_neighbour = false;  ///< stores of unorm, half, sRGB and fixed-point depth take either neighbour
  double reach = 0.5;       ///< otherwise any neighbour that is as near as that, of the subpixel grid; stores to codes
                            ///< do not decrease
  uint32_t conversion = 0;  ///< which of these: thresholds between codes are made of this number
  bool reverse_lights = false;
  int weight_bits = 0;              ///< of texture filters; 0: exact
  bool decode_late = false;         ///< sRGB textures are filtered in 8 bits, then decoded
  std::optional<TextureWay> way{};  ///< of all lookups; `weight_bits` and `any_level` are passed over
  bool any_level = false;           ///< rho anywhere between OpenGL's limits, else the longer gradient
  int depth_unit = 1;               ///< codes of fixed-point depth that a unit of polygon offset is
  double slope_norm = 0;            ///< of polygon offset: 0 the larger slope, 1 the Euclidean norm, or between
  bool blends_codes = false;        ///< fixed-point targets are blended in their own codes
  bool nearest_halves = false;      ///< floats of 16, 11 and 10 bits are stored to nearest even, else toward zero
  bool sums_in_floats = false;   ///< a target is kept in floats, clamped where it is fixed-point, and stored at the end
  bool mesa_codes = false;       ///< sRGB codes of llvmpipe's table; ten bits out of sixteen; codes of light are added
  bool intel_estimates = false;  ///< that table as CPUs of Intel have it
};

/// Arithmetic that errs as GLSL 4.60, 4.7.1 allows.
class LooseFloat {
 public:
  LooseFloat(uint64_t seed, bool any_rounding) : random_(seed), any_(any_rounding) {}
  float add(float a, float b) { return round(double(a) + double(b)); }
  float sub(float a, float b) { return round(double(a) - double(b)); }
  float mul(float a, float b) { return round(double(a) * double(b)); }
  float mad(float a, float b, float c);  ///< contracted or not
  float div(float a, float b);
  float inverse_sqrt(float x);
  float sqrt(float x);
  float pow(float x, float y);
  float dot(const float a[3], const float b[3]);
  void unit(const float in[3], float out[3]);
  Pcg32& random() { return random_; }

 private:
  float round(double exact);
  float off_by(double exact, double ulps);
  Pcg32 random_;
  bool any_;
};

/// Lights one pixel; planes as the shader reads them. gloss: specular colour and shininess, where the model reads them.
void loose_light(LooseFloat& f, const Scene& scene, const LightModel& model, bool reverse, const float position[3],
                 const float normal[3], const float albedo[3], float color[3], const float gloss[4] = nullptr,
                 const LightVolumes& extents = {});

/// The normal of a texel of a normal map, of tangents along_u and along_v in the world. `side`: of v, where vertices'
/// tangents say it; 0: along_v says.
void loose_bend(LooseFloat& f, const float along_u[3], const float along_v[3], float side,
                const std::array<float, 4>& texel, float scale, float normal[3]);

/// What a fragment may make of a stored texel: of fixed-point formats given as codes, back as values, or as codes where
/// they were blended.
std::array<double, 4> loose_blend(LooseFloat& f, const BlendState& state, Format format, const Liberties& liberties,
                                  const float source[4], const std::array<double, 4>& stored);

/// Adds light to codes that are no sRGB, as Liberties::mesa_codes has it.
void add_mesa_codes(Image& image, int x, int y, const float source[4]);

/// Whether a target is blended in its own codes, all of one width.
bool blends_in_codes(Format format, const Liberties& liberties);

/// A whole number that a scaled value may become.
double loose_neighbour(LooseFloat& f, const Liberties& liberties, double scaled);

/// One channel, as its format may store it.
void loose_store(LooseFloat& f, const Liberties& liberties, Image& image, int x, int y, int channel, float v);

/// The same of what a blend in floats made of a stored value: that floats miss a code by their own errors is no reason
/// to store the one below it (GL 4.6 core, 17.3.6: precision no less than the target's).
void loose_store_blended(LooseFloat& f, const Liberties& liberties, Image& image, int x, int y, int channel, double v);

/// Texels as a lookup may give them.
class LooseTextures {
 public:
  LooseTextures(const Scene& scene, const Liberties& liberties);
  /// u_dx, v_dx, u_dy, v_dy: change to the next pixel. Of a slot that is used.
  std::array<float, 4> texel(LooseFloat& f, const TextureSlot& slot, const oracle::TexturePlace& place) const;

 private:
  std::array<float, 4> one_way(LooseFloat& f, const TextureSlot& slot, const oracle::TexturePlace& place) const;
  const Scene& scene_;
  const Liberties free_;
  void decode_by_mesa();
  std::vector<Texture> encoded_;  ///< sRGB textures as if they were not
  std::vector<Texture> by_mesa_;  ///< the same in floats, as Mesa decodes them
};

/// The whole capture: depth, position, normal, albedo, id.object, specular and the target; of deferred strategies
/// normals in the pipeline's format and albedo in rgba8, of forward ones floats. Any strategy and target; of
/// deferred-volumes lights drawn as quads alone, blended as kAddLight says.
oracle::Capture loose_frame(const Scene& scene, const Pipeline& pipeline, const Liberties& liberties, uint64_t seed);

}  // namespace trueshade::testing
