#pragma once
// Tests of maps and of glass all over an image: each pixel has latitude, but an implementation uses it one way.
#include <span>
#include <string>
#include <vector>

#include "judge/stages/verdict.h"
#include "oracle/capture.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade::oracle {

/// How much of one cause, such as a gain, one plane shows of one material.
struct MaterialEvidence {
  std::string stage;
  uint32_t material = 0;
  std::string name;   ///< the material's, if it has one
  std::string plane;  ///< `albedo`, `albedo.A`, `specular`, `emission`, `emission.A`, `normal`, `color`, or one channel
  std::string map{};  ///< as scene files call it, `color_map`; empty of glass
  std::string cause{};         ///< `gain`, `scale`, `level`, `order`, `alpha`
  double value = 0;            ///< estimated: relative where the cause is a gain or scale, else levels, alpha; `order`
                               ///< 0 or 1
  double error = 0;            ///< its standard deviation
  double least = 0;            ///< the smallest |value| that the test would notice
  bool is_of_channel = false;  ///< of one channel of a plane that is also tested as a whole
  bool against = false;        ///< no known implementation makes it: the test fails

  /// The material in words: `material 3 (floor)`.
  std::string subject() const;
  /// What was found, in words: `color_map has a gain of 0.97 in albedo, where 0.996 to 1.004 are expected`.
  std::string text() const;
};

/// Tests each material's maps for gains, scales of normal maps and offset levels of detail, and whether all are decoded
/// and filtered in one order; and tests glass for its alpha. What implementations choose is estimated along with these,
/// as one number for a material and plane: the formula of rho between the limits of 8.14.1, 2^-6 of a texel, how 8-bit
/// steps, factors and blends are rounded, when and how sRGB is decoded. A cause is passed over where too few pixels
/// tell, or where such a choice may explain it too. What speaks against maps does so under either order and decoder of
/// sRGB.
///   stages: the verdicts of validate_capture()
///   significance: how many right images may fail one of the tests
std::vector<MaterialEvidence> material_evidence(const Scene& scene, const Pipeline& pipeline, const Profile& profile,
                                                const Capture& capture, std::span<const StageVerdict> stages,
                                                double significance);

}  // namespace trueshade::oracle
