#pragma once
#include <array>
#include <functional>
#include <span>

#include "scenes/scene.h"
#include "scenes/uv_transform.h"

namespace trueshade {

/// What a map of a file reads: a set of texture coordinates, transformed.
struct UvSource {
  uint32_t set = 0;
  UvTransform transform{};
  bool operator==(const UvSource&) const = default;
};

/// A set that a source names, in f64 and rounded once.
UvStreams baked(const UvStreams& set, const UvTransform& transform);

/// Of a material, in the order of maps_of(); not read where the material has no such map.
using UvSources = std::array<UvSource, kMaterialMaps>;

/// Gives every mesh the sets that the maps of its material read: one for each distinct source. Sources are ordered by
/// the set that they come from, then by the order of the maps. A set is transformed in f64 and rounded once.
/// TextureSlot::uv_set becomes the index among them, so that a material whose maps share a source reads set 0 alone. A
/// mesh whose sets are the sources as they stand stays as it is. A mesh that is drawn by materials of other sources is
/// copied for each; `take(bytes)` is told before.
///   sources: of each of the scene's materials
///   A mesh that timeline.posed moves is drawn by one material.
void bake_uv(Scene& scene, std::span<const UvSources> sources, const std::function<void(uint64_t)>& take);

}  // namespace trueshade
