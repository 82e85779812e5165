#include "bench/floor.h"

namespace trueshade {
namespace {

// Cycles.
constexpr double kCluster = 30.0, kTriangle = 2.6, kFragment = 8.0;
constexpr double kSmallSurface = 26.0,
                 kLargeSurface = 10.0;  // a pixel whose neighbours see other triangles, or the same
constexpr double kPixelLight = 58.0 / 16, kLitPixel = 3.75, kStoredPixel = 0.5;

}  // namespace

FrameBytes frame_bytes(const FrameStats& s, Format target) {
  // 64 positions, 126 triangles of three bytes, the header: what visibility reads of a full one.
  constexpr uint64_t kClusterBytes = 64 * 3 * sizeof(float) + 126 * 3 + 64;
  return {s.pixels * uint64_t(info(target).bytes_per_texel()), s.clusters_drawn * kClusterBytes};
}

FrameFloor frame_floor(const FrameStats& s) {
  const bool small = s.triangles_tested > s.covered_pixels;
  FrameFloor floor;
  floor.geometry_cycles = kCluster * double(s.clusters_drawn) + kTriangle * double(s.triangles_tested) +
                          kFragment * double(small ? s.fragments : s.fragments / 16) +
                          (small ? kSmallSurface : kLargeSurface) * double(s.covered_pixels);
  floor.light_cycles = kPixelLight * double(s.evaluated_pixel_lights) + kLitPixel * double(s.covered_pixels) +
                       kStoredPixel * double(s.pixels);
  return floor;
}

}  // namespace trueshade
