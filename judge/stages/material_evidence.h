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

/// How much of one cause a plane shows of a material.
struct MaterialEvidence {
  std::string stage;
  uint32_t material = 0;
  std::string name;   ///< the material's, if it has one
  std::string plane;  ///< `albedo`, `albedo.A`, `specular`, `emission`, `emission.A`, `normal`, `color`, or one channel
  std::string map{};  ///< as scene files call it, `color_map`; empty of glass
  std::string cause{};         ///< `gain`, `scale`, `level`, `order`, `alpha`
  double value = 0;            ///< found: relative of gains and scales, else levels, alpha; `order` 0 or 1
  double error = 0;            ///< its standard deviation
  double least = 0;            ///< the smallest |value| that would have been told
  bool is_of_channel = false;  ///< of one of several channels that are tested together, too
  bool against = false;        ///< no implementation that is known makes it

  /// The material in words: `material 3 (floor)`.
  std::string subject() const;
  /// What was found, in words: `color_map has a gain of 0.97 in albedo, where 0.996 to 1.004 are expected`.
  std::string text() const;
};

/// Tests each material's maps for gains, scales of normal maps, levels, and whether all are decoded in one order, and
/// glass for its alpha. What implementations choose is estimated beside these, as one number for a material and plane:
/// the formula of rho between the limits of 8.14.1, 2^-6 of a texel, how 8-bit steps, factors and blends are rounded,
/// when and how sRGB is decoded. Passed over is what too few pixels tell, or what such a choice would make, too: what
/// is against maps is so by either order and decoder of sRGB.
///   stages: as judged
///   significance: how many right images may fail one of the tests
std::vector<MaterialEvidence> material_evidence(const Scene& scene, const Pipeline& pipeline, const Profile& profile,
                                                const Capture& capture, std::span<const StageVerdict> stages,
                                                double significance);

}  // namespace trueshade::oracle
