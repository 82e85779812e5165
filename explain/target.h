#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "explain/blended_pixel.h"
#include "explain/light.h"

namespace trueshade {

/// The surfaces of a pixel that light comes from.
struct PixelSurfaces {
  bool covered = false;              ///< an opaque surface is visible
  SurfacePlanes visible;             ///< it, as lights read it
  std::vector<SurfacePlanes> tied;   ///< forward-multipass: all fragments at the stored depth, in order of submission,
                                     ///< where these are not the visible one alone
  std::vector<SurfacePlanes> glass;  ///< transparent ones that are blended after the lights, in order of submission
};

/// One draw into the target.
struct TargetDraw {
  std::string what;
  int64_t light = -1;  ///< index of the light that is drawn; -1: none, or many
  std::array<float, 4> source{};
  StoredPixel before{}, after{};
};

/// A sum of lights over one surface.
struct LightTotal {
  LitPixel pixel;
  std::vector<LightAtPixel> lights;  ///< by index in the scene
  std::array<float, 4> sum{};        ///< as the target receives it
};

/// How the target's pixel came about.
struct PixelTarget {
  LightTotal visible;              ///< of the visible surface; `sum` means nothing where lights are blended one by one
  std::vector<LightTotal> glass;   ///< of each transparent fragment
  std::vector<uint32_t> geometry;  ///< deferred-volumes: how often each light's geometry covers the pixel
  std::vector<TargetDraw> draws;   ///< in their order; the first is the clear
  StoredPixel stored{};
};

/// Lights the surfaces and stores them as the pipeline's strategy does. docs/arithmetic.md sections 8, 10, 14 and 15.
///   times: for questions of the kind "what if": how often each light counts; empty: each once
PixelTarget target_of(const ExplainedFrame& frame, const PixelSurfaces& surfaces, WindowPixel pixel,
                      std::span<const uint8_t> times = {});

}  // namespace trueshade
