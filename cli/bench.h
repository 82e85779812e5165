#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bench/contest.h"
#include "bench/floor.h"
#include "bench/load.h"
#include "bench/machine.h"
#include "bench/picture_check.h"
#include "cli/moving_frames.h"
#include "cli/notes.h"
#include "cli/options.h"
#include "scenes/pipeline/pipeline.h"
#include "shading/frame.h"

namespace trueshade {

inline constexpr int kMoreCores[] = {2, 4, 8, 16, 32, 64};  ///< that frames are scheduled on

/// Somebody else's time for the same frame in the same run, or ours when it is drawn otherwise.
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
  FrameStats stats;  ///< of the frame of median time, stages and tiles by their least
  FrameFloor floor;
  FrameBytes bytes;
  std::map<int, std::vector<double>> tile_costs;  ///< ms of each tile in the order they are started, by the tiles' side
  double peak_mib = 0;  ///< most memory the process had while preparing and drawing, before any peer
  std::vector<PeerTime> peers;
  std::vector<std::string> peers_about;
  std::optional<MovingTime> moving;
  Notes notes;
  Load load;                         ///< until the last timed frame
  double clock_ghz = 0;              ///< after it
  std::vector<std::string> reasons;  ///< why these times are not to be quoted

  /// How much faster than on one core the frame would be on `cores`, by these costs and the tiles that it would have.
  double scheduled_speedup(int cores) const;
  int scheduled_tile(int cores) const;

  double ratio(const PeerTime& peer) const { return peer.timing.median() / timing.median(); }
};

/// How one quantity changes the time: what was varied, and a time at each value.
struct ScalingCurve {
  std::string title, about;  ///< about: a sentence on what was varied
  std::string axis;          ///< what the values along it are; empty for bars
  bool log_axis = false;
  struct Point {
    std::string label;
    double x;
    Timing timing;
    int threads = 0;  ///< where they are what is varied
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
  std::string command;                ///< as it was given
  bool standard = false, quick = false;
  std::vector<std::string> reasons;  ///< why nothing of it is to be quoted

  std::vector<std::string> all_reasons() const;  ///< those of scenes too, behind their names
};

inline constexpr int kStandard = 2;  ///< counts up where standard_rows() or scores() change

/// What --standard times, a scene each, on the best SIMD target and against the others.
std::vector<BenchOptions> standard_rows(const BenchOptions& options);
struct Score {
  std::string simd;
  double value;
};
/// The geometric mean of frames a second over standard_rows(), by the least time of each. A score for each SIMD target,
/// the best first.
std::vector<Score> scores(const BenchResult& bench);
std::string scores_text(const BenchResult& bench);
std::string scores_json(const BenchResult& bench);

/// How often frames are drawn: up to 100 times within 2.5 s a contender, unless options say otherwise.
ContestRules contest_rules(const BenchOptions& options);

/// Compares the results in options.scenes, if they are results: whether they are.
bool compared_results(const BenchOptions& options);

/// How frames of a scene scale with its lights, triangles, pixels, threads and SIMD targets, each curve's drawn in
/// turn. `lights`: how many the scene has, which is among the numbers that are drawn.
std::vector<ScalingCurve> scaling_curves(const BenchOptions& options, const std::string& scene, uint64_t lights,
                                         const Execution& execution);
/// Why these are not to be quoted.
std::vector<std::string> scaling_reasons(const std::vector<ScalingCurve>& curves, int cores);

std::string formatted(double value, const char* format);  ///< by printf's format for one double

double ns_per_pixel_light(const SceneTime& scene);  ///< of one core, per pixel-light computed
double million_triangles_per_s(const SceneTime& scene);
double million_pixels_per_s(const SceneTime& scene);
/// A scene of small triangles is as fast as its triangles are, one of large ones as its pixels are: both rates.
std::string rate_text(const SceneTime& scene);

/// The machine, and what draws on it, in a line.
std::string bench_heading(const Machine& machine, const std::string& simd, int threads);
std::string machine_text(const Machine& machine);  ///< the line behind it: what the machine is, and how busy
std::string machine_json(const Machine& machine);
std::string load_json(const Load& load);
std::string reasons_json(const std::vector<std::string>& reasons);
std::string reasons_text(const std::vector<std::string>& reasons, const std::string& indent);
/// One scene's lines; of a short text its times alone.
std::string bench_text(const SceneTime& scene, const BenchResult& bench, bool is_short);
std::string bench_json(const BenchResult& bench);
std::string bench_page(const BenchResult& bench);

}  // namespace trueshade
