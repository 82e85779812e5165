#pragma once
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench/contest.h"
#include "bench/picture_check.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade {

/// Others that draw the same frame, on this machine. Owns what they need; contenders() borrow from it.
class Peers {
 public:
  virtual ~Peers() = default;
  virtual std::vector<Contender> contenders() = 0;
  virtual std::string about() const = 0;             ///< which driver or library, and what it was allowed
  virtual std::string driver() const { return {}; }  ///< vendor, renderer and version; empty where none was opened
  /// What each contender drew in its first frame, in their order; empty of peers that draw no picture.
  virtual std::vector<PeerPicture> pictures() { return {}; }
};

/// Names of the designs of gl/driver/designs.h; none where OpenGL was not built in.
std::span<const std::string_view> gl_design_names();

/// Vendor, renderer and version of the OpenGL driver at hand, which is opened for it; empty where there is none.
std::string gl_driver_here();

/// OpenGL in these designs, in all of them where none is named, on the driver at hand. Designs that a user picks for
/// speed cull back faces where that changes at most one pixel in 50,000. Throws Error(no_gl_driver), Error(usage) for
/// lights whose extents one shader cannot tell apart.
std::unique_ptr<Peers> gl_peers(const Scene& scene, const Pipeline& pipeline, std::span<const std::string> designs);

/// Embree's primary rays, nothing shaded. `threads`: 0 for one a core.
std::unique_ptr<Peers> embree_peers(const Scene& scene, const Pipeline& pipeline, int threads);

}  // namespace trueshade
