#pragma once
#include <optional>
#include <vector>

#include "explain/account.h"
#include "explain/explained_frame.h"
#include "explain/fragments.h"
#include "explain/surface.h"
#include "explain/target.h"

namespace trueshade {

/// What the depth test and the alpha test did with a fragment that covers the pixel's sample.
struct DepthOutcome {
  float there = 0;             ///< the depth that the fragment's is compared with
  bool passes = false;         ///< the depth test
  std::optional<float> alpha;  ///< the alpha that the cutoff is compared with; nothing where there is no such test, or
                               ///< it was not reached
  bool drawn = false;          ///< it passes both tests
};

/// Everything that happened at one pixel, as numbers.
struct PixelHistory {
  WindowPixel pixel{};
  PixelTriangles opaque, transparent;
  std::vector<DepthOutcome> of_opaque, of_transparent;  ///< of each covering fragment
  std::optional<size_t> visible;                        ///< index into opaque.covering
  std::vector<size_t> tied_at, glass_at;                ///< of `tied` and `glass`: indices into the covering triangles
  float depth = 0;                                      ///< stored, or the clear depth
  PixelSurface surface;                                 ///< the visible one
  std::vector<PixelSurface> tied, glass;                ///< of forward-multipass; of transparent fragments drawn
  std::vector<TargetDraw> albedo_draws;                 ///< transparent fragments blended into the albedo plane
  LitSurfaces lit;
  std::vector<TargetDraw> draws;  ///< into the target, in their order; the first is the clear
  StoredPixel stored{};           ///< what the target holds at last
};

/// Draws one pixel with all its steps kept; (x, y) counts from the top left of the picture. Visits every triangle of
/// the scene, and every light. Error(usage) for a pixel that is not in the picture. The stored pixel is what
/// render_frame() stores, bit for bit (tests/explain).
PixelHistory history_of(const ExplainedFrame& frame, int x, int y);

/// The surfaces of a history in the form that lit_surfaces() takes: the visible one, tied ones, and transparent ones
/// (glass) only where they are blended after the lights.
PixelSurfaces surfaces_to_light(const ExplainedFrame& frame, const PixelHistory& history);

/// The channels of a stored pixel that its format has: unorm codes as integers, others as floats.
std::vector<AccountValue> values_in_format(Format format, const StoredPixel& stored);

/// How much of a history goes into its account.
enum class Detail : uint8_t {
  brief,  ///< what is seen, how many lights add to it, the stored pixel: no step on the way there
  usual,  ///< the 64 lights that add most, the 64 covering triangles drawn last; draws that change something
  all     ///< every covering triangle, every light and every draw
};
/// A history in words, for people and programs: triangles, surface, lights, draws. The last quantity is the stored
/// pixel. What `detail` leaves out is only counted.
Account account_of(const ExplainedFrame& frame, const PixelHistory& history, Detail detail = Detail::usual);

}  // namespace trueshade
