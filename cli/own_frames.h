#pragma once
#include <string>
#include <utility>
#include <vector>

#include "cli/option_values.h"
#include "scenes/pipeline/pipeline.h"
#include "shading/frame.h"

namespace trueshade {

/// One way of ours to draw a scene, timed from outside, every image checked against the hash that all must have.
class OwnFrames {
 public:
  OwnFrames(const PreparedScene& prepared, const Pipeline& pipeline, const Execution& execution)
      : prepared_(prepared), pipeline_(pipeline), execution_(execution) {}
  /// The same, drawn otherwise.
  OwnFrames(const OwnFrames& as, const Variant& variant);
  OwnFrames(const OwnFrames&) = delete;

  /// Hash of the frame and its planes, drawn in another way too: one thread, other tiles, the SIMD target `simd`. What
  /// is drawn from then on must have it. Throws std::runtime_error where the two differ.
  std::string checked_hash(std::string_view simd);
  const std::string& hash() const { return hash_; }
  void expect(const std::string& hash) { hash_ = hash; }
  bool same_picture(const OwnFrames& other) const;  ///< by its pipeline and its planes

  /// Draws a frame and returns its time, ms. Throws std::runtime_error for any other image.
  double draw();

  /// Of the frame of median time; core_ms and tile_ms: the least of each stage of each tile in any frame, so that what
  /// else the machine does falls out.
  FrameStats stats() const;

 private:
  const PreparedScene& prepared_;
  Pipeline pipeline_;
  std::string simd_;  ///< stays alive for the execution
  Execution execution_;
  std::vector<std::string> aovs_;
  std::string hash_;
  std::vector<std::pair<double, FrameStats>> frames_;
};

}  // namespace trueshade
