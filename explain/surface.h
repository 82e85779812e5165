#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "explain/fragments.h"
#include "explain/interpolation.h"

namespace trueshade {

/// One texture lookup of a material's map for a pixel.
struct MapLookup {
  std::string map;  ///< color, specular, normal, metallic-roughness, emission, occlusion
  TexturePoint at;
  std::array<float, 4> texel;
};

/// What lights read of a surface, one member a G-buffer plane.
struct SurfacePlanes {
  std::array<float, 3> position{}, normal{};
  std::array<float, 4> albedo{};
  std::array<float, 2> uv{};
  std::array<float, 4> specular{};    ///< colour and shininess; or metallic and roughness, for a light program
  std::array<float, 4> emission{};    ///< and the share of ambient light that arrives
  uint32_t object = 0, material = 0;  ///< counted from 1; 0: none
};

/// How the surface of a fragment was computed: weights, lookups, and the planes before and after rounding.
struct PixelSurface {
  CornerWeights weights;
  bool turned = false;  ///< a double-sided material shows its back here, so the normal was negated
  std::vector<MapLookup> lookups;
  std::optional<std::array<float, 4>> tangent{};  ///< of vertices, interpolated in the world; the side of B
  SurfacePlanes computed;                         ///< before any plane's format rounds them
  SurfacePlanes read;                             ///< as lights read them from the planes
};

/// The surface of a fragment, before and after the formats of `planes` round it (docs/arithmetic.md sections 5, 7 and
/// 13). The fragment must have a piece; the sample may lie beside it. Looks the material's maps up.
PixelSurface surface_of(const ExplainedFrame& frame, const PixelFragment& fragment, const GBufferState& planes,
                        WindowPixel pixel);

/// Whether an instance's fragments undergo the alpha test: the material's cutoff is not 0, and the frame uses maps or
/// cutoffs at all.
bool has_alpha_test(const ExplainedFrame& frame, uint32_t instance);

/// The alpha that the alpha test compares with the material's cutoff; nothing where the instance has no alpha test.
/// Looks the colour map up.
std::optional<float> tested_alpha(const ExplainedFrame& frame, const PixelFragment& fragment);

/// What a shader reads from `target` after `values` are stored there without blending.
std::array<float, 4> read_back(const std::array<float, 4>& values, const BlendTarget& target);

}  // namespace trueshade
