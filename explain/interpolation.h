#pragma once
#include <array>

#include "explain/fragments.h"
#include "raster/textures/texture.h"
#include "scenes/pipeline/pipeline.h"

namespace trueshade {

/// The weights of corners 1 and 2 (of 0 to 2, in canonical order) at a fragment's sample, and how much they change from
/// one pixel to the next on the right and above (docs/arithmetic.md sections 5 and 13).
struct CornerWeights {
  std::array<double, 3> u;  ///< 1 / w of the corners
  double q = 0, area = 0;   ///< l_0 + l_1 + l_2; the edges' exact sum, rounded once
  std::array<double, 2> smooth{}, linear{};
  std::array<double, 2> smooth_x{}, smooth_y{}, linear_x{}, linear_y{};
};

/// The weights at a fragment's sample, which may lie beside the triangle. The fragment must have a piece.
CornerWeights corner_weights(const PixelFragment& fragment);

/// An attribute at the sample, from its values at the corners as submitted. The result is clamped to the range of the
/// values at the corners of the fragment's piece.
///   provoking: index of the corner whose value a flat attribute takes
float attribute_at(const PixelFragment& fragment, const CornerWeights& weights, const WindowTransform& window,
                   Interpolation how, const std::array<float, 3>& value, int provoking);

/// Texture coordinates at the sample, from u and v at the corners as submitted, and their derivatives along x and y,
/// per pixel; the derivatives of flat coordinates are 0. Coordinates are not wrapped into [0, 1].
TexturePoint texture_point(const PixelFragment& fragment, const CornerWeights& weights, const WindowTransform& window,
                           Interpolation how, const std::array<float, 3>& u, const std::array<float, 3>& v,
                           int provoking);

}  // namespace trueshade
