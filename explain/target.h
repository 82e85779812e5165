#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "explain/blended_pixel.h"
#include "explain/light.h"
#include "explain/program_at_surface.h"

namespace trueshade {

/// The surfaces that a pixel's light comes from.
struct PixelSurfaces {
  WindowPixel pixel{};
  bool covered = false;              ///< an opaque surface is visible
  SurfacePlanes visible;             ///< the visible surface, as lights read it
  std::vector<SurfacePlanes> tied;   ///< forward-multipass: all fragments at the stored depth, in order of submission,
                                     ///< where these are not the visible one alone
  std::vector<SurfacePlanes> glass;  ///< transparent ones that are blended after the lights, in order of submission
};

/// What all lights give one surface.
struct LightTotal {
  SurfacePlanes surface;
  const LightTable* table = nullptr;                          ///< whose rows the lights are
  std::vector<LightAtPixel> lights;                           ///< by index in the scene
  std::array<float, 3> start{};                               ///< what the sum starts from
  std::array<float, 4> sum{};                                 ///< of all, as the target receives it
  std::shared_ptr<const ProgramAtSurface> program = nullptr;  ///< what lights add, as a program
  bool takes_albedo_alpha = false;                            ///< of a program that does not say what alpha is
};

/// What all lights give each surface of a pixel.
struct LitSurfaces {
  bool covered = false;
  LightTotal visible;
  std::vector<LightTotal> tied, glass;  ///< as PixelSurfaces has them
  std::vector<uint32_t> geometry;       ///< deferred-volumes: how often each light's geometry covers the pixel
};

/// How often each light's geometry covers a pixel under deferred-volumes, by index in the scene: a quad covers every
/// pixel once, a mesh once for each of its triangles that covers the sample and is not culled. Empty under other
/// strategies.
std::vector<uint32_t> geometry_at(const ExplainedFrame& frame, WindowPixel pixel);

/// Lights each surface by every light (docs/arithmetic.md sections 8, 9 and 15); an unlit surface by none. The result
/// borrows the frame.
///   geometry: as geometry_at() returns it; a light with 0 becomes not_drawn on the visible surface
LitSurfaces lit_surfaces(const ExplainedFrame& frame, const PixelSurfaces& surfaces, std::vector<uint32_t> geometry);

/// The same surfaces under the same lights by an edited program of theirs. A light that adds nothing then has the fate
/// gives_nothing, whatever the reason.
LitSurfaces relit(const LitSurfaces& lit, const programs::Program& edited);

/// One draw into the target: its source colour, and the pixel before and after.
struct TargetDraw {
  std::string what;
  int64_t light = -1;   ///< index of the light that is drawn; -1: none, or many
  bool blends = false;  ///< false: it replaces what is there
  std::array<float, 4> source{};
  StoredPixel before{}, after{};
};

/// Draws lit surfaces into one pixel as the pipeline's strategy does, and returns what the target then holds
/// (docs/arithmetic.md sections 7, 10, 14 and 15): the clear colour where no surface is drawn.
///   times: how often each light counts, for "what if" questions; empty: each once
///   draws: if not null, every draw is appended in order; the first is the clear
StoredPixel drawn_target(const ExplainedFrame& frame, const LitSurfaces& lit, std::span<const uint8_t> times = {},
                         std::vector<TargetDraw>* draws = nullptr);

}  // namespace trueshade
