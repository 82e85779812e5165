#pragma once
// What the planes of a G-buffer should hold, pixel by pixel: the surface that is nominally seen, and its values as real
// numbers with how far a legal renderer's may be off.
#include <array>
#include <cstdint>
#include <shared_mutex>
#include <unordered_map>

#include "judge/legal/surface_values.h"

namespace trueshade::oracle {

/// The numbers of one pixel, before any plane's format rounds them. Where nothing is drawn all but the depth are 0.
struct PlaneValues {
  bool covered = false;
  double object = 0, material = 0;  ///< index + 1
  double depth = 1;
  std::array<double, 3> position{}, normal{};
  std::array<double, 4> albedo{};
  std::array<double, 2> uv{};
  std::array<double, 4> specular{}, emission{};  ///< with the shininess, and with the share of ambient light
};

/// The likeliest values, and both ends of what is legal.
struct ExpectedPixel {
  PlaneValues value, low, high;
  uint32_t triangle = 0;  ///< of the object's mesh
};

/// What each pixel of a G-buffer should hold. A pixel is made when it is first asked for, and kept.
class ExpectedPlanes {
 public:
  /// Finds the possible surfaces of all pixels. Borrows the scene.
  ///   drawn_at: the window pixel that the picture's lower left one was
  ExpectedPlanes(const Scene& scene, const Pipeline& pipeline, const Profile& profile, std::array<int, 2> drawn_at);
  /// The pixel's numbers; from any thread. Where nothing is drawn, they are 0, and the depth is the clear depth.
  ExpectedPixel at(int x, int y_top) const;
  /// Whether a surface is nominally seen.
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
