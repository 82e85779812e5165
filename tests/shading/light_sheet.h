#pragma once
// A bumpy sheet under random lights, drawn small, and its pixels held against the naive loop.
#include <random>
#include <string_view>

#include "scenes/pipeline/pipeline.h"
#include "shading/frame.h"
#include "tests/shading/naive_lights.h"

namespace trueshade {

using Random = std::mt19937_64;
float float_between(Random& random, double low, double high);

/// Red of every occlusion map.
inline constexpr float kOcclusionTexel = 0.3f;

/// A bumpy sheet across the view, x and y in [-2, 2].
Scene sheet(Random& random);

/// A light of any type near the sheet: of twelve one ambient, one directional and three spots; some without a range.
Light random_light(Random& random);

/// A preset drawn at 57x43 into floats.
Pipeline loop_pipeline(std::string_view preset);

struct Result {
  Frame frame;
  std::vector<Material> materials;
  bool metals;                      ///< shininess comes from the roughness
  Pixel pixel(int x, int y) const;  ///< y from the top
  bool covered(int x, int y) const { return frame.aovs[3].image.value(x, y, 0) != 0; }
};

Result render(const Scene& scene, const Pipeline& pipeline, const Execution& execution = {});

/// Requires every covered pixel to have the naive loop's bits.
void compare_with_loop(const Scene& scene, const Pipeline& pipeline, const Result& result);

}  // namespace trueshade
