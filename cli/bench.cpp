#include "cli/bench.h"

#include <algorithm>
#include <chrono>
#include <fstream>
#include <memory>
#include <optional>
#include <utility>

#include "bench/peers.h"
#include "cli/commands.h"
#include "cli/preparation.h"
#include "cli/progress_bar.h"
#include "core/error.h"
#include "core/fp_env.h"
#include "core/image_io.h"
#include "scenes/scene.h"

namespace trueshade {
namespace {

/// The kernel forgets the most memory that this process had, so that the next scene's is its own.
void reset_peak_memory() { std::ofstream("/proc/self/clear_refs") << 5; }

double peak_memory_mib() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmHWM:")) return double(std::stoull(line.substr(6))) / 1024.0;
  return 0.0;
}

/// A frame drawn and timed from outside; the image checked against the hash that all frames must have.
class OwnFrames {
 public:
  OwnFrames(const PreparedScene& prepared, const Pipeline& pipeline, const Execution& execution)
      : prepared_(prepared), pipeline_(pipeline), execution_(execution) {}

  /// Hash of the frame drawn in another way: one thread, other tiles, another SIMD target where there is one.
  std::string checked_hash() {
    Execution other = execution_;
    other.threads = 1;
    other.tile = execution_.tile == 32 ? 64 : 32;
    other.simd = simd_targets().back();
    const std::string expected = image_hash(render_frame(prepared_, pipeline_, other).color);
    hash_ = image_hash(render_frame(prepared_, pipeline_, execution_).color);
    if (hash_ != expected)
      throw std::runtime_error("two ways to draw " + prepared_.scene().spec + " give two images: nothing is timed");
    return hash_;
  }

  double draw() {
    const auto start = std::chrono::steady_clock::now();
    const Frame frame = render_frame(prepared_, pipeline_, execution_);
    const double ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    if (!hash_.empty() && image_hash(frame.color) != hash_)
      throw std::runtime_error("a timed frame came out otherwise");
    frames_.emplace_back(ms, frame.stats);
    return ms;
  }

  FrameStats stats_of_median() const {
    std::vector<std::pair<double, FrameStats>> sorted = frames_;
    std::sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    return sorted[sorted.size() / 2].second;
  }

 private:
  const PreparedScene& prepared_;
  Pipeline pipeline_;
  Execution execution_;
  std::string hash_;
  std::vector<std::pair<double, FrameStats>> frames_;
};

std::vector<std::unique_ptr<Peers>> peers_of(const BenchOptions& options, const Scene& scene,
                                             const Pipeline& pipeline) {
  std::vector<std::unique_ptr<Peers>> peers;
  for (const std::string& name : options.against) {
    if (name != "gl" && draws_transparent(scene, pipeline))
      throw Error(ErrorKind::usage, "--against", name + " does not see through transparent surfaces",
                  "gl, a scene without, or a pipeline with transparency none");
    peers.push_back(name == "gl" ? gl_peers(scene, pipeline)
                                 : embree_peers(scene, pipeline, options.execution.threads));
  }
  return peers;
}

/// Whether the peers drew this frame, or what else.
void check_pictures(const PreparedScene& prepared, const Pipeline& pipeline, const Execution& execution,
                    const std::vector<std::unique_ptr<Peers>>& peers, std::vector<PeerTime>& times) {
  Image timed;
  size_t next = 0;
  for (const auto& peer : peers) {
    const size_t first = next;
    next += peer->contenders().size();
    std::vector<PeerPicture> pictures = peer->pictures();
    for (size_t i = 0; i < pictures.size(); ++i) {
      if (timed.texels.empty()) timed = render_frame(prepared, pipeline, execution).color;
      times[first + i].picture = picture_check(prepared, execution, pipeline, timed, pictures[i]);
    }
  }
}

SceneTime measured(const BenchOptions& options, const std::string& spec, const Execution& execution) {
  PipelineOptions own = options;
  own.scene = spec;
  reset_peak_memory();
  const Scene scene = load_scene(spec, {}, decode_image);
  SceneTime result;
  result.scene = scene.spec;
  result.pipeline = pipeline_of(own, scene);
  const PreparedScene prepared(scene);
  OwnFrames frames(prepared, result.pipeline, execution);
  frames.draw();
  result.peak_mib = peak_memory_mib();
  result.hash = frames.checked_hash();
  const auto peers = peers_of(options, scene, result.pipeline);
  std::vector<Contender> contenders{{"trueshade", "", [&frames] { return frames.draw(); }}};
  for (const auto& peer : peers) {
    for (Contender& c : peer->contenders()) contenders.push_back(std::move(c));
    result.peers_about.push_back(peer->about());
  }
  ProgressBar bar("timing " + spec, "frames");
  std::vector<Timing> timings = contest(contenders, {}, [&bar](int done, int most) { bar.show(done, most); });
  result.timing = std::move(timings[0]);
  for (size_t i = 1; i < contenders.size(); ++i)
    result.peers.push_back({contenders[i].name, contenders[i].strategy, std::move(timings[i]), {}});
  check_pictures(prepared, result.pipeline, execution, peers, result.peers);
  result.stats = frames.stats_of_median();
  result.floor = frame_floor(result.stats);
  return result;
}

// --- Scaling -------------------------------------------------------------------------------------------------------

/// Median time of a scene by us alone.
double median_ms(const BenchOptions& options, const std::string& spec, const Execution& execution,
                 std::optional<Size> size = {}) {
  PipelineOptions own = options;
  own.scene = spec;
  if (size) own.size = size;
  const Scene scene = load_scene(spec, {}, decode_image);
  const PreparedScene prepared(scene);
  OwnFrames frames(prepared, pipeline_of(own, scene), execution);
  const std::vector<Contender> alone{{"trueshade", "", [&frames] { return frames.draw(); }}};
  return contest(alone, {7, 1000.0})[0].median();
}

std::vector<ScalingCurve> scaling_curves(const BenchOptions& options, const Execution& execution) {
  ProgressBar bar("scaling", "curves");
  std::vector<ScalingCurve> curves;
  ScalingCurve lights{"Lights, city", "lights", true, {}};
  for (const char* count : {"1", "10", "100", "757", "10000", "100000"})
    lights.points.push_back(
        {count, std::stod(count), median_ms(options, std::string("builtin:city,lights=") + count, execution)});
  bar.show(1, 5), curves.push_back(lights);
  ScalingCurve triangles{"Triangles, city", "million triangles", true, {}};
  for (const char* objects : {"100", "1000", "10000", "100000"})
    triangles.points.push_back({objects, std::stod(objects) * 12e-6,
                                median_ms(options, std::string("builtin:city,objects=") + objects, execution)});
  bar.show(2, 5), curves.push_back(triangles);
  ScalingCurve pixels{"Pixels, city", "megapixels", true, {}};
  for (const int side : {200, 400, 800, 1600})
    pixels.points.push_back({std::to_string(side) + "x" + std::to_string(side), side * side * 1e-6,
                             median_ms(options, "builtin:city", execution, Size{side, side})});
  bar.show(3, 5), curves.push_back(pixels);
  ScalingCurve threads{"Threads, city", "threads", false, {}};
  for (int n = 1; n <= thread_count(0); n = std::max(n + 1, std::min(2 * n, thread_count(0)))) {
    Execution e = execution;
    e.threads = n;
    threads.points.push_back({std::to_string(n), double(n), median_ms(options, "builtin:city", e)});
  }
  bar.show(4, 5), curves.push_back(threads);
  ScalingCurve simd{"SIMD targets, city", "", false, {}};
  for (const std::string_view target : simd_targets()) {
    Execution e = execution;
    e.simd = target;
    simd.points.push_back({std::string(target), double(simd.points.size()), median_ms(options, "builtin:city", e)});
  }
  bar.show(5, 5), curves.push_back(simd);
  return curves;
}

}  // namespace

void bench(const BenchOptions& options) {
  std::vector<std::string> files;
  for (const auto& file : {options.json_file, options.report})
    if (file) files.push_back(*file);
  check_folders(files);
  BenchResult result;
  result.machine = this_machine();
  result.execution = options.execution;
  result.execution.simd = options.simd;
  result.threads = thread_count(options.execution.threads);
  result.simd = options.simd == "best" ? simd_targets().front() : options.simd;
  for (const std::string& spec : options.scenes) {
    result.scenes.push_back(measured(options, spec, result.execution));
    print((result.scenes.size() == 1 ? bench_heading(result) : "") + bench_text(result.scenes.back(), result));
  }
  if (options.report) result.scaling = scaling_curves(options, result.execution);
  const auto write = [](const std::string& path, const std::string& text) {
    write_file(path, {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
  };
  if (options.json_file) write(*options.json_file, bench_json(result));
  if (options.report) write(*options.report, bench_page(result));
}

}  // namespace trueshade
