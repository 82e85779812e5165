#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade {

/// Bytes that drawing a frame takes at once, besides the scene: the clusters of its meshes; transforms, lists and
/// tables of its instances and lights; the picture and its planes; the pictures of the post chain. `aovs`: as
/// render_frame() has them. An estimate for who refuses a frame before it begins; what lists of clusters and lights
/// take depends on what is seen (tests/cli/memory.cpp holds it to a fifth of what frames really take).
uint64_t predicted_memory(const Scene& scene, const Pipeline& pipeline, const Execution& execution,
                          std::span<const std::string> aovs);

}  // namespace trueshade
