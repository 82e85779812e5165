#pragma once
#include <optional>
#include <string>
#include <vector>

#include "bench/contest.h"
#include "bench/floor.h"
#include "bench/machine.h"
#include "bench/picture_check.h"
#include "scenes/pipeline.h"
#include "shading/frame.h"

namespace trueshade {

/// Somebody else's time for the same frame in the same run.
struct PeerTime {
  std::string name, strategy;
  Timing timing;
  std::optional<PictureCheck> picture;  ///< of peers that draw one
};

/// One scene, drawn by us and by the peers in turn.
struct SceneTime {
  std::string scene;
  Pipeline pipeline;
  std::string hash;  ///< of every frame that was timed; 64 hex digits
  Timing timing;
  FrameStats stats;  ///< of the frame of median time
  FrameFloor floor;
  double peak_mib = 0;  ///< most memory the process had while preparing and drawing, before any peer
  std::vector<PeerTime> peers;
  std::vector<std::string> peers_about;

  double ratio(const PeerTime& peer) const { return peer.timing.median() / timing.median(); }
};

/// How one quantity changes the time: what was varied, and a time at each value.
struct ScalingCurve {
  std::string title, axis;
  bool log_axis = false;
  struct Point {
    std::string label;
    double x, ms;
  };
  std::vector<Point> points;
};

struct BenchResult {
  Machine machine;
  Execution execution;
  int threads = 0;   ///< as resolved
  std::string simd;  ///< as resolved
  std::vector<SceneTime> scenes;
  std::vector<ScalingCurve> scaling;  ///< empty unless a report was asked for
};

std::string bench_heading(const BenchResult& bench);  ///< the machine and the execution, a line each
std::string bench_text(const SceneTime& scene, const BenchResult& bench);  ///< one scene's lines
std::string bench_json(const BenchResult& bench);
std::string bench_page(const BenchResult& bench);

}  // namespace trueshade
