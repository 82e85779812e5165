#pragma once
// A renderer that takes every liberty OpenGL gives: rounding up or down at random, sums in any order, contraction or not,
// divisions and roots off by the ulps GLSL allows, any subpixel grid, planes from snapped or unsnapped vertices, any fill
// rule, either neighbour in every store, textures of few weight bits and any legal level. Independent of the renderer and
// of the judge; small scenes only, nothing may cross the near or far plane.
#include <array>
#include <vector>

#include "oracle/capture.h"
#include "oracle/texture_lookup.h"
#include "scenes/pcg32.h"
#include "scenes/pipeline.h"
#include "scenes/scene.h"

namespace trueshade::testing {

struct Liberties {
  bool any_rounding = true;    ///< otherwise to nearest, divisions and roots correct, as llvmpipe
  int subpixel_bits = 8;       ///< 0: vertices are not snapped
  bool snapped_planes = false;
  bool turn_ties = false;      ///< samples on an edge belong to the other side
  bool any_neighbour = false;  ///< stores of unorm, half, sRGB and fixed-point depth take either neighbour
  bool reverse_lights = false;
  int weight_bits = 0;         ///< of texture filters; 0: exact
  bool decode_late = false;    ///< sRGB textures are filtered in 8 bits, then decoded
  bool any_level = false;      ///< rho anywhere between OpenGL's limits, else the longer gradient
  int depth_unit = 1;          ///< codes of fixed-point depth that a unit of polygon offset is
  double slope_norm = 0;       ///< of polygon offset: 0 the larger slope, 1 the Euclidean norm, or between
  bool blends_codes = false;   ///< fixed-point targets are blended in their own codes
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

/// The normal of a texel of a normal map, of tangents along_u and along_v in the world.
void loose_bend(LooseFloat& f, const float along_u[3], const float along_v[3], const std::array<float, 4>& texel,
                float scale, float normal[3]);

/// What a fragment may make of a stored texel: of fixed-point formats given as codes, back as values, or as codes where
/// they were blended.
std::array<double, 4> loose_blend(LooseFloat& f, const BlendState& state, Format format, const Liberties& liberties,
                                  const float source[4], const std::array<double, 4>& stored);

/// Texels as a lookup may give them.
class LooseTextures {
 public:
  LooseTextures(const Scene& scene, const Liberties& liberties);
  /// u_dx, v_dx, u_dy, v_dy: change to the next pixel. Of a slot that is used.
  std::array<float, 4> texel(LooseFloat& f, const TextureSlot& slot, const oracle::TexturePlace& place) const;

 private:
  const Scene& scene_;
  const Liberties free_;
  std::vector<Texture> encoded_;  ///< sRGB textures as if they were not
};

/// The whole capture: depth, position, normal, albedo (rgba8), id.object, specular and the target; normal, depth and target in the
/// pipeline's formats (targets: rgba8, srgb8_a8, rgba16f, rgba32f).
oracle::Capture loose_frame(const Scene& scene, const Pipeline& pipeline, const Liberties& liberties, uint64_t seed);

}  // namespace trueshade::testing
