#pragma once
// A renderer that takes every liberty OpenGL gives: rounding up or down at random, sums in any order, contraction or not,
// divisions and roots off by the ulps GLSL allows, any subpixel grid, planes from snapped or unsnapped vertices, any fill
// rule. Independent of the renderer and of the judge; small scenes only, nothing may cross the near or far plane.
#include "oracle/capture.h"
#include "scenes/pcg32.h"
#include "scenes/pipeline.h"
#include "scenes/scene.h"

namespace trueshade::testing {

struct Liberties {
  bool any_rounding = true;    ///< otherwise to nearest, divisions and roots correct, as llvmpipe
  int subpixel_bits = 8;       ///< 0: vertices are not snapped
  bool snapped_planes = false;
  bool turn_ties = false;      ///< samples on an edge belong to the other side
  bool any_neighbour = false;  ///< unorm stores take either neighbour
  bool reverse_lights = false;
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

/// Lights one pixel; planes as the shader reads them.
void loose_light(LooseFloat& f, const Scene& scene, const LightModel& model, bool reverse, const float position[3],
                 const float normal[3], const float albedo[3], float color[3]);

/// The whole capture: depth, position, normal (rgba32f), albedo (rgba8), id.object and the target in the pipeline's format.
oracle::Capture loose_frame(const Scene& scene, const Pipeline& pipeline, const Liberties& liberties, uint64_t seed);

}  // namespace trueshade::testing
