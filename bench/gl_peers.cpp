#include <utility>

#include "bench/peers.h"
#include "core/error.h"
#include "oracle/gl/designs.h"

namespace trueshade {
namespace {

using oracle::GlDesign;
using oracle::GlPeer;

constexpr int kPixelsPerChange = 50000;

bool is_fast(GlDesign design) {
  return design == GlDesign::tiled || design == GlDesign::forward_plus || design == GlDesign::deferred_volumes;
}

/// Pixels that are not the same without back faces: none inside closed meshes, a few where a silhouette's edges round,
/// many where faces of two objects coincide.
int pixels_culling_changes(oracle::GlRenderer& renderer, Pipeline pipeline) {
  const Image all = GlPeer(renderer, pipeline, GlDesign::tiled).draw(true).capture.color;
  pipeline.geometry.cull_face = CullFace::back;
  const Image front = GlPeer(renderer, pipeline, GlDesign::tiled).draw(true).capture.color;
  int count = 0;
  for (int y = 0; y < all.height; ++y)
    for (int x = 0; x < all.width; ++x) {
      bool same = true;
      for (int k = 0; k < 4; ++k) same = same && all.value(x, y, k) == front.value(x, y, k);
      count += same ? 0 : 1;
    }
  return count;
}

double frame_ms(GlPeer& peer) {
  double ms = 0.0;
  for (const oracle::GlPass& pass : peer.draw(false).passes) ms += pass.ms;
  return ms;
}

class GlPeers final : public Peers {
 public:
  GlPeers(const Scene& scene, const Pipeline& pipeline) : context_(oracle::GlDriver::any), renderer_(context_, scene) {
    const int changed = pixels_culling_changes(renderer_, pipeline);
    culled_ = changed <= pipeline.width * pipeline.height / kPixelsPerChange;
    for (const GlDesign design : oracle::kGlDesigns) {
      Pipeline p = pipeline;
      if (culled_ && is_fast(design)) p.geometry.cull_face = CullFace::back;
      peers_.emplace_back(design, std::make_unique<GlPeer>(renderer_, p, design));
    }
  }

  std::vector<Contender> contenders() override {
    std::vector<Contender> all;
    for (auto& [design, peer] : peers_)
      all.push_back({"gl", std::string(name_of(design)), [&peer = *peer] { return frame_ms(peer); }});
    return all;
  }

  std::string about() const override {
    return context_.info().line() +
           (culled_ ? "; its fast designs cull back faces" : "; both faces drawn, as the pictures differ without");
  }

 private:
  oracle::GlContext context_;
  oracle::GlRenderer renderer_;
  std::vector<std::pair<GlDesign, std::unique_ptr<GlPeer>>> peers_;
  bool culled_ = false;
};

}  // namespace

std::unique_ptr<Peers> gl_peers(const Scene& scene, const Pipeline& pipeline) {
  if (pipeline.strategy != Strategy::deferred_loop)
    throw Error(ErrorKind::usage, "--against gl", "its designs do not draw lights as geometry, so not this picture",
                "a preset of strategy deferred-loop");
  return std::make_unique<GlPeers>(scene, pipeline);
}

}  // namespace trueshade
