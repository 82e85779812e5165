#include <chrono>

#include "bench/peers.h"
#include "core/error.h"
#include "core/threads/parallel_for.h"
#include "oracle/embree_peer.h"

namespace trueshade {
namespace {

class EmbreePeers final : public Peers {
 public:
  EmbreePeers(const Scene& scene, const Pipeline& pipeline, int threads) : peer_(scene, pipeline), threads_(threads) {}

  std::vector<Contender> contenders() override {
    return {{"embree", "primary-rays", [this] { return frame_ms(); }}};
  }
  std::string about() const override { return "Embree, coherent packets of 16 primary rays, nothing shaded"; }

 private:
  double frame_ms() const {
    using Clock = std::chrono::steady_clock;
    const auto start = Clock::now();
    parallel_for(peer_.rows(), threads_, [&](int row) { peer_.trace_row(row); });
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
  }

  oracle::EmbreePeer peer_;
  int threads_;
};

}  // namespace

std::unique_ptr<Peers> embree_peers(const Scene& scene, const Pipeline& pipeline, int threads) {
  return std::make_unique<EmbreePeers>(scene, pipeline, threads);
}

}  // namespace trueshade
