#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "explain/fragments.h"
#include "explain/interpolation.h"

namespace trueshade {

/// A map's lookup for a pixel.
struct MapLookup {
  std::string map;  ///< color, specular, normal, metallic-roughness, emission, occlusion
  TexturePoint at;
  std::array<float, 4> texel;
};

/// The planes of a surface: what lights read of it.
struct SurfacePlanes {
  std::array<float, 3> position{}, normal{};
  std::array<float, 4> albedo{};
  std::array<float, 2> uv{};
  std::array<float, 4> specular{};    ///< colour and shininess; or metallic and roughness, for a light program
  std::array<float, 4> emission{};    ///< and the share of ambient light that arrives
  uint32_t object = 0, material = 0;  ///< counted from 1; 0: none
};

/// The surface of a fragment.
struct PixelSurface {
  CornerWeights weights;
  bool turned = false;  ///< the normal of a double-sided back face was negated
  std::vector<MapLookup> lookups;
  std::optional<std::array<float, 4>> tangent{};  ///< of vertices, interpolated in the world; the side of B
  SurfacePlanes computed;                         ///< before any plane's format rounds them
  SurfacePlanes read;                             ///< as lights read them from the planes
};

/// The surface of a fragment that has a piece, be the sample beside it, before and after the formats of `planes` round
/// it (docs/arithmetic.md sections 5, 7 and 13). Looks the material's maps up.
PixelSurface surface_of(const ExplainedFrame& frame, const PixelFragment& fragment, const GBufferState& planes,
                        WindowPixel pixel);

/// Whether fragments of an instance undergo the alpha test: the material's cutoff is not 0, and the frame has maps or
/// cutoffs at all.
bool has_alpha_test(const ExplainedFrame& frame, uint32_t instance);

/// The alpha that is compared with the material's cutoff; nothing where the instance has no alpha test. Looks the
/// colour map up.
std::optional<float> tested_alpha(const ExplainedFrame& frame, const PixelFragment& fragment);

/// What a shader reads of `target`, a plane or the target, after a draw without blending has stored `values` there.
std::array<float, 4> read_back(const std::array<float, 4>& values, const BlendTarget& target);

}  // namespace trueshade
