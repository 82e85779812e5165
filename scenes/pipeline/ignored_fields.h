#pragma once
#include <cstdint>
#include <string_view>
#include <vector>

#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade {

/// A value that lights or materials of a scene state, and that no stage of a pipeline reads: no pixel depends on it.
struct IgnoredField {
  std::string_view of;      ///< who states the value: `light` or `material`
  std::string_view field;   ///< its key in a scene file
  std::string_view reason;  ///< why the pipeline does not read it; a full sentence without its full stop
  uint64_t count = 0;       ///< how many lights or materials state it
};

/// Every such field once, lights before materials. A field is stated where its value is not the one that an absent key
/// has. The lights of built-in scenes, and those about a geometry file alone, state `range` and `attenuation` for one
/// and the same falloff, so that each preset finds the one that it reads: neither counts while the other is read.
/// A pipeline whose view is not `lit` states what it shows by itself: then nothing is ignored.
std::vector<IgnoredField> ignored_fields(const Scene& scene, const Pipeline& pipeline);

/// A colour of a surface above this is taken for a slip, such as codes from 0 to 255: no surface reflects more light
/// than it receives, so reflectances end at 1. Scenes that exaggerate a little are left alone.
inline constexpr float kLargestPlausibleReflectance = 16.0f;

/// How many materials have a base or specular colour with a channel above kLargestPlausibleReflectance.
uint64_t implausible_reflectances(const Scene& scene);

}  // namespace trueshade
