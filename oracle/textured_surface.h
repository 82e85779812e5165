#pragma once
// What maps make of a fragment: docs/arithmetic.md section 13 read as mathematics.
#include <optional>

#include "oracle/scalar_renderer.h"
#include "oracle/texture_lookup.h"

namespace trueshade::oracle {

/// Texture coordinates of a set at pixel (x, y), rounded to float as the renderer hands them to lookups, and the exact
/// planes' derivatives.
TexturePlace texture_place(const DrawnTriangle& triangle, Interpolation interpolation, int x, int y, size_t set = 0);

/// Vertex colour times texel times base colour.
struct SurfaceColor {
  TexelValue value;
  bool certain = true;  ///< false where a lookup is so close to another texel, level or filter that rounding decides
};
SurfaceColor surface_color(const Scene& scene, const GBufferState& planes, const DrawnTriangle& triangle, int x, int y);

/// What a material with its maps makes of a fragment where lights read it: docs/arithmetic.md section 7 as mathematics.
struct MaterialSurface {
  std::array<long double, 3> albedo{}, specular{}, emission{};
  long double roughness = 0;      ///< the map's times the material's, where the model maps metals
  long double exponent = 0;       ///< the shininess before it is rounded and clamped to [1, 8192], of such models
  long double ambient_share = 1;  ///< of ambient light, what arrives
  bool certain = true;            ///< SurfaceColor::certain, of all maps
};
MaterialSurface material_surface(const Scene& scene, const Pipeline& pipeline, const DrawnTriangle& triangle, int x,
                                 int y);

/// Whether the alpha test drops the fragment; nothing where its alpha is too close to the cutoff to tell.
std::optional<bool> discarded(const Scene& scene, const GBufferState& planes, const DrawnTriangle& triangle, int x,
                              int y);

}  // namespace trueshade::oracle
