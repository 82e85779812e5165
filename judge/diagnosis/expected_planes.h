#pragma once
// What the planes of a G-buffer should hold, pixel by pixel: the surface that is nominally seen, and its values as real
// numbers with how far a legal renderer's may be off.
#include <array>
#include <cstdint>
#include <shared_mutex>
#include <unordered_map>

#include "judge/legal/surface_values.h"

namespace trueshade::oracle {

/// The numbers that all planes hold at one pixel, before their formats round them. All but the depth are 0 where
/// nothing is drawn.
struct PlaneValues {
  bool covered = false;
  double object = 0, material = 0;  ///< index + 1
  double depth = 1;
  std::array<double, 3> position{}, normal{};
  std::array<double, 4> albedo{};
  std::array<double, 2> uv{};
  std::array<double, 4> specular{}, emission{};  ///< with the shininess, and with the share of ambient light
};

/// The nominal numbers of a pixel, and the least and largest that are legal.
struct ExpectedPixel {
  PlaneValues value, low, high;
  uint32_t triangle = 0;  ///< of the object's mesh
};

/// What each pixel of a G-buffer should hold. A pixel is computed when it is first asked for, and kept.
class ExpectedPlanes {
 public:
  /// Finds the surfaces that each pixel may show. Borrows the scene.
  ///   drawn_at: the window pixel at the picture's lower left
  ExpectedPlanes(const Scene& scene, const Pipeline& pipeline, const Profile& profile, std::array<int, 2> drawn_at);
  /// What the pixel should hold; any thread may ask. Where nothing is drawn, 0 and the clear depth.
  ExpectedPixel at(int x, int y_top) const;
  /// Whether a surface is nominally seen at the pixel.
  bool covered(int x, int y_top) const;

 private:
  const PossibleSurface* seen(size_t pixel) const;
  ExpectedPixel made(int x, int y_top) const;

  const Pipeline pipeline_;
  Projector projector_;
  PossibleSurfaces possible_;
  mutable std::shared_mutex asked_;
  mutable std::unordered_map<uint64_t, ExpectedPixel> known_;  ///< pixels that were asked for
};

}  // namespace trueshade::oracle
