#include <algorithm>
#include <utility>

#include "bench/peers.h"
#include "core/error.h"
#include "gl/driver/designs.h"

namespace trueshade {
namespace {

using oracle::GlDesign;
using oracle::GlPeer;

constexpr int kPixelsPerChange = 50000;

bool is_fast(GlDesign design) { return design != GlDesign::forward_loop && design != GlDesign::forward_multipass; }

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

/// A design at work, and what it drew first.
struct Work {
  GlDesign design;
  GlPeer peer;
  Image first;

  Work(oracle::GlRenderer& renderer, const Pipeline& pipeline, GlDesign d) : design(d), peer(renderer, pipeline, d) {}

  double frame_ms() {
    oracle::GlFrame frame = peer.draw(first.texels.empty());
    if (first.texels.empty()) first = std::move(frame.capture.color);
    double ms = 0.0;
    for (const oracle::GlPass& pass : frame.passes) ms += pass.ms;
    return ms;
  }
};

class GlPeers final : public Peers {
 public:
  GlPeers(const Scene& scene, const Pipeline& pipeline, std::span<const std::string> designs)
      : context_(oracle::GlDriver::any), renderer_(context_, scene), pipeline_(pipeline) {
    const int changed = pixels_culling_changes(renderer_, pipeline);
    culled_ = changed <= pipeline.width * pipeline.height / kPixelsPerChange;
    for (const GlDesign design : oracle::kGlDesigns) {
      if (!designs.empty() && std::find(designs.begin(), designs.end(), name_of(design)) == designs.end()) continue;
      if (draws_transparent(scene, pipeline) && !draws_glass(design, pipeline.transparency.mode)) {
        without_glass_ = true;
        continue;
      }
      Pipeline p = pipeline;
      if (culled_ && is_fast(design)) p.geometry.cull_face = CullFace::back;
      peers_.push_back(std::make_unique<Work>(renderer_, p, design));
    }
  }

  std::vector<Contender> contenders() override {
    std::vector<Contender> all;
    for (const auto& work : peers_)
      all.push_back({"gl", std::string(name_of(work->design)), [&peer = *work] { return peer.frame_ms(); }});
    return all;
  }

  std::vector<PeerPicture> pictures() override {
    std::vector<PeerPicture> all;
    for (const auto& work : peers_) {
      all.push_back({work->first, design_pipeline(pipeline_, work->design)});
      all.back().as.post = {};
    }
    return all;
  }

  std::string driver() const override { return context_.info().line(); }

  std::string about() const override {
    return context_.info().line() +
           (culled_ ? "; its fast designs cull back faces" : "; both faces drawn, as the pictures differ without") +
           (without_glass_ ? "; no forward design, which has no colour plane to blend glass into" : "");
  }

 private:
  oracle::GlContext context_;
  oracle::GlRenderer renderer_;
  Pipeline pipeline_;
  std::vector<std::unique_ptr<Work>> peers_;
  bool culled_ = false, without_glass_ = false;
};

}  // namespace

std::span<const std::string_view> gl_design_names() {
  static const auto names = [] {
    std::array<std::string_view, oracle::kGlDesigns.size()> all;
    std::transform(oracle::kGlDesigns.begin(), oracle::kGlDesigns.end(), all.begin(),
                   [](GlDesign design) { return name_of(design); });
    return all;
  }();
  return names;
}

std::string gl_driver_here() {
  try {
    return oracle::GlContext().info().line();
  } catch (const Error&) {
    return {};
  }
}

std::unique_ptr<Peers> gl_peers(const Scene& scene, const Pipeline& pipeline, std::span<const std::string> designs) {
  return std::make_unique<GlPeers>(scene, pipeline, designs);
}

}  // namespace trueshade
