#include "cli/own_frames.h"

#include <algorithm>
#include <chrono>
#include <stdexcept>

namespace trueshade {
namespace {

/// Of the image, and of each plane behind it.
std::string frame_hash(const Frame& frame) {
  std::string hash = image_hash(frame.color);
  for (const NamedImage& plane : frame.aovs) hash += ' ' + image_hash(plane.image);
  return hash;
}

}  // namespace

OwnFrames::OwnFrames(const OwnFrames& as, const Variant& v)
    : prepared_(as.prepared_), pipeline_(as.pipeline_), simd_(v.simd), execution_(as.execution_), aovs_(v.aovs) {
  if (v.strategy) pipeline_.strategy = *v.strategy;
  if (v.target) pipeline_.target = *v.target;
  if (v.view) pipeline_.view = *v.view;
  if (v.threads) execution_.threads = *v.threads;
  if (v.tile) execution_.tile = *v.tile;
  if (!simd_.empty()) execution_.simd = simd_;
  validate(pipeline_);
}

std::string OwnFrames::checked_hash(std::string_view simd) {
  Execution other = execution_;
  other.threads = 1;
  other.tile = execution_.tile == 32 ? 64 : 32;
  other.simd = simd;
  const std::string expected = frame_hash(render_frame(prepared_, pipeline_, other, aovs_));
  hash_ = frame_hash(render_frame(prepared_, pipeline_, execution_, aovs_));
  if (hash_ != expected)
    throw std::runtime_error("two ways to draw " + prepared_.scene().spec + " give two images: nothing is timed");
  return hash_;
}

bool OwnFrames::same_picture(const OwnFrames& other) const {
  return pipeline_json(pipeline_) == pipeline_json(other.pipeline_) && aovs_ == other.aovs_;
}

double OwnFrames::draw() {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  const Frame frame = render_frame(prepared_, pipeline_, execution_, aovs_);
  const double ms = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
  if (!hash_.empty() && frame_hash(frame) != hash_) throw std::runtime_error("a timed frame came out otherwise");
  frames_.emplace_back(ms, frame.stats);
  return ms;
}

FrameStats OwnFrames::stats() const {
  std::vector<size_t> order(frames_.size());
  for (size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](size_t a, size_t b) { return frames_[a].first < frames_[b].first; });
  FrameStats stats = frames_[order[order.size() / 2]].second;
  stats.core_ms = {};
  for (size_t i = 0; i < stats.tile_ms.size(); ++i) {  // tiles are started in one order, frame after frame
    for (const auto& [ms, other] : frames_) {
      StageTimes& least = stats.tile_ms[i];
      const StageTimes& tile = other.tile_ms[i];
      least = {std::min(least.visibility, tile.visibility), std::min(least.surfaces, tile.surfaces),
               std::min(least.light, tile.light), std::min(least.store, tile.store)};
    }
    stats.core_ms += stats.tile_ms[i];
  }
  return stats;
}

}  // namespace trueshade
