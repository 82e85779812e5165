#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "cli/resolved_arrays.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade {

/// How many numbers the arrays of resolved_text() hold.
struct ResolvedNumbers {
  uint64_t of_scene = 0;   ///< vertices, triangles and texels
  uint64_t of_lights = 0;  ///< their geometry, where it is drawn
};
ResolvedNumbers resolved_numbers(const Scene& scene, const Pipeline& pipeline);

/// Bytes that resolved_text() takes at most, without the arrays.
uint64_t resolved_text_bytes(const Scene& scene);

/// Everything that the renderer reads of a scene at one time, as JSON that docs/resolved.md describes. Numbers are
/// those that pixels are made of, to the bit. In pieces that follow each other; arrays go to `arrays`, which borrows
/// from the scene. `file`: the name of the file of arrays; empty: they are in the text.
std::vector<std::string> resolved_text(const Scene& scene, const Pipeline& pipeline, double time,
                                       const std::string& file, ResolvedArrays& arrays);

}  // namespace trueshade
