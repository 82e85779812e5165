#include "cli/bench.h"

#include <malloc.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <utility>

#include "bench/peers.h"
#include "cli/commands.h"
#include "cli/own_frames.h"
#include "cli/preparation.h"
#include "cli/progress_bar.h"
#include "cli/written_files.h"
#include "core/error.h"
#include "core/image_files/image_io.h"
#include "core/threads/parallel_for.h"
#include "scenes/scene.h"

namespace trueshade {
namespace {

double memory_mib(const char* which) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with(which)) return double(std::stoull(line.substr(std::string_view(which).size()))) / 1024.0;
  return 0.0;
}

/// The most memory that a scene takes of this process: what others before it left behind is theirs, and so is threads'
/// scratch.
class PeakMemory {
 public:
  PeakMemory() {
    static const double first = memory_mib("VmRSS:");
    malloc_trim(0);
    left_behind_ = std::max(0.0, memory_mib("VmRSS:") - first);
    std::ofstream("/proc/self/clear_refs") << 5;  // the kernel forgets what it saw before
  }
  double mib() const { return memory_mib("VmHWM:") - left_behind_; }

 private:
  double left_behind_;
};

bool is_gl(const std::string& peer) { return peer == "gl" || peer.starts_with("gl="); }
/// The designs of the peer gl=DESIGN+DESIGN; none for gl, which is every design. Error(usage) for a name of none.
std::vector<std::string> designs_from_text(const std::string& peer) {
  std::vector<std::string> designs;
  if (peer == "gl") return designs;
  const std::span<const std::string_view> known = gl_design_names();
  for (size_t begin = peer.find('=') + 1; begin <= peer.size();) {
    const size_t end = std::min(peer.find('+', begin), peer.size());
    designs.push_back(peer.substr(begin, end - begin));
    if (!known.empty() && std::find(known.begin(), known.end(), designs.back()) == known.end())
      throw usage("--against gl", "OpenGL is not drawn by '" + designs.back() + "'", "one of: " + joined(known));
    begin = end + 1;
  }
  return designs;
}

bool is_variant(const std::string& peer) { return !is_gl(peer) && peer.find('=') != std::string::npos; }

std::vector<std::unique_ptr<Peers>> peers_of(const BenchOptions& options, const Scene& scene,
                                             const Pipeline& pipeline) {
  std::vector<std::unique_ptr<Peers>> peers;
  for (const std::string& name : options.against) {
    if (is_variant(name)) continue;
    if (!is_gl(name) && draws_transparent(scene, pipeline))
      throw Error(ErrorKind::usage, "--against", name + " does not see through transparent surfaces",
                  "gl, a scene without, or a pipeline with transparency none");
    peers.push_back(is_gl(name) ? gl_peers(scene, pipeline, designs_from_text(name))
                                : embree_peers(scene, pipeline, options.execution.threads));
  }
  return peers;
}

/// Ours drawn otherwise, each with the hash that it must have.
std::vector<std::pair<std::string, std::unique_ptr<OwnFrames>>> variants_of(const BenchOptions& options,
                                                                            const OwnFrames& frames) {
  std::vector<std::pair<std::string, std::unique_ptr<OwnFrames>>> variants;
  for (const std::string& name : options.against) {
    if (!is_variant(name)) continue;
    variants.emplace_back(name, std::make_unique<OwnFrames>(frames, variant_from_text(name)));
    OwnFrames& variant = *variants.back().second;
    if (variant.same_picture(frames))
      variant.expect(frames.hash());
    else
      variant.checked_hash(simd_targets().back());
  }
  return variants;
}

std::vector<double> sums(const std::vector<StageTimes>& tiles) {
  std::vector<double> ms;
  for (const StageTimes& tile : tiles) ms.push_back(tile.sum());
  return ms;
}

/// What tiles cost by the sides that more cores would draw with.
std::map<int, std::vector<double>> tile_costs(const OwnFrames& frames, const FrameStats& drawn, const Pipeline& p,
                                              const Execution& execution) {
  constexpr int kRounds = 5;
  std::map<int, std::vector<double>> costs{{drawn.tile, sums(drawn.tile_ms)}};
  if (execution.tile != 0) return costs;
  for (const int cores : kMoreCores) {
    const int tile = tile_for(p.width, p.height, cores);
    if (costs.contains(tile)) continue;
    Variant smaller;
    smaller.tile = tile;
    OwnFrames others(frames, smaller);
    others.expect(frames.hash());
    for (int round = 0; round < kRounds; ++round) others.draw();
    costs[tile] = sums(others.stats().tile_ms);
  }
  return costs;
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

PipelineOptions options_of(const BenchOptions& row) {
  PipelineOptions own = row;
  own.scene = row.scenes.front();
  return own;
}

/// Options of one scene each.
std::vector<BenchOptions> rows_of(const BenchOptions& options) {
  if (options.standard) return standard_rows(options);
  std::vector<BenchOptions> rows;
  for (const std::string& spec : options.scenes) (rows.emplace_back(options)).scenes = {spec};
  return rows;
}

/// Why the times of a scene are not to be quoted.
std::vector<std::string> reasons_of(const SceneTime& scene, const Execution& execution, int cores) {
  std::vector<NamedTiming> rows{{"trueshade", &scene.timing, thread_count(execution.threads)}};
  for (const PeerTime& peer : scene.peers) {
    const bool by_threads = peer.name == "trueshade" && peer.strategy.starts_with("threads=");
    rows.push_back({peer.name + ' ' + peer.strategy, &peer.timing,
                    by_threads ? thread_count(*variant_from_text(peer.strategy).threads) : 0});
  }
  std::vector<std::string> reasons = load_reasons(scene.load, "while this ran");
  for (const std::string& reason : {frames_reason(rows), spread_reason(rows), threads_reason(rows, cores)})
    if (!reason.empty()) reasons.push_back(reason);
  return reasons;
}

SceneTime measured(const BenchOptions& options, const Execution& execution, Machine& machine) {
  const std::string& spec = options.scenes.front();
  const LoadSample before = load_sample();
  const PeakMemory memory;
  Scene scene = scene_of_options(spec, options.limits, options.parts);
  SceneTime result;
  result.scene = scene.spec;
  result.pipeline = pipeline_of(options_of(options), scene);
  show(scene, options.camera, result.pipeline, 0.0);
  result.notes = notes_of(scene, result.pipeline);
  check_memory(scene, result.pipeline, execution, {});
  const PreparedScene prepared(scene);
  OwnFrames frames(prepared, result.pipeline, execution);
  frames.draw();
  result.peak_mib = memory.mib();
  result.hash = frames.checked_hash(simd_targets().back());
  const auto variants = variants_of(options, frames);
  const auto peers = peers_of(options, scene, result.pipeline);
  std::vector<Contender> contenders{{"trueshade", "", [&frames] { return frames.draw(); }}};
  for (const auto& peer : peers) {
    for (Contender& c : peer->contenders()) contenders.push_back(std::move(c));
    result.peers_about.push_back(peer->about());
    if (!peer->driver().empty()) machine.opengl = peer->driver();
  }
  for (const auto& [name, variant] : variants)
    contenders.push_back({"trueshade", name, [&ours = *variant] { return ours.draw(); }});
  ProgressBar bar("timing " + spec, "frames");
  std::vector<Timing> timings =
      contest(contenders, contest_rules(options), [&bar](int done, int most) { bar.show(done, most); });
  result.timing = std::move(timings[0]);
  for (size_t i = 1; i < contenders.size(); ++i)
    result.peers.push_back({contenders[i].name, contenders[i].strategy, std::move(timings[i]), {}});
  result.load = load_between(before, load_sample());
  result.clock_ghz = measured_clock_ghz();
  result.reasons = reasons_of(result, execution, machine.cores);
  check_pictures(prepared, result.pipeline, execution, peers, result.peers);
  result.stats = frames.stats();
  result.floor = frame_floor(result.stats);
  result.bytes = frame_bytes(result.stats, result.pipeline.target);
  if (options.moving) result.moving = moving_time(scene, prepared, result.pipeline, execution);
  result.tile_costs = tile_costs(frames, result.stats, result.pipeline, execution);
  return result;
}

}  // namespace

std::vector<std::string> BenchResult::all_reasons() const {
  std::vector<std::string> all = reasons;
  for (const SceneTime& scene : scenes)
    for (const std::string& reason : scene.reasons)
      all.push_back((scenes.size() > 1 ? scene.scene + ": " : "") + reason);
  return all;
}

ContestRules contest_rules(const BenchOptions& options) {
  if (options.quick) return {5, 400.0};
  if (options.standard) return {100, 4000.0};
  return {};
}

void bench(const BenchOptions& options) {
  if (options.ranks) return bench_ranks(options);
  if (compared_results(options)) return;
  for (const std::string& peer : options.against)
    if (is_gl(peer)) designs_from_text(peer);
  const bool json_printed = options.json_file == "-";
  const std::vector<BenchOptions> rows = rows_of(options);
  for (const BenchOptions& row : rows) check_pipeline(options_of(row));
  for (const BenchOptions& row : rows)  // files that are missing are told before the first scene is timed
    for (const std::string& scene : row.scenes)
      if (std::error_code unknown; !scene.starts_with("builtin:") && scene.find('.') != std::string::npos &&
                                   !std::filesystem::exists(scene, unknown) && !unknown)
        throw Error(ErrorKind::io, scene, "No such file or directory", "name a scene");
  for (const auto& file : {options.json_file, options.report})
    if (file && *file != "-") check_writable(*file);
  BenchResult result;
  result.machine = this_machine();
  result.execution = options.execution;
  result.execution.simd = options.simd;
  result.threads = thread_count(options.execution.threads);
  result.command = "trueshade" + options.command_line;
  result.simd = options.simd == "best" ? simd_targets().front() : options.simd;
  result.standard = options.standard, result.quick = options.quick;
  result.reasons = load_reasons(result.machine.load_before, "before this ran");
  if (options.quick) result.reasons.push_back("--quick draws few frames");
  std::vector<double> clocks{result.machine.clock_ghz};
  for (const BenchOptions& row : rows) {
    result.scenes.push_back(measured(row, result.execution, result.machine));
    clocks.push_back(result.scenes.back().clock_ghz);
    say_notes(result.scenes.back().notes.lines);
    if (!json_printed)
      print((result.scenes.size() == 1
                 ? bench_heading(result.machine, result.simd, result.threads) + machine_text(result.machine)
                 : "") +
            bench_text(result.scenes.back(), result, options.quiet));
  }
  if (const std::string reason = clock_reason(clocks); !reason.empty()) result.reasons.push_back(reason);
  if (options.report) {
    const SceneTime& first = result.scenes.front();
    result.scaling = scaling_curves(rows.front(), first.scene, first.stats.lights, result.execution);
    const std::vector<std::string> reasons = scaling_reasons(result.scaling, result.machine.cores);
    result.reasons.insert(result.reasons.end(), reasons.begin(), reasons.end());
  }
  if (!json_printed) print((options.standard ? scores_text(result) : "") + reasons_text(result.reasons, ""));
  const auto write = [&](const std::string& path, const char* about, const std::string& text) {
    write_file(path, {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
    say_written(path, about, json_printed ? StandardOutput::answer : StandardOutput::files);
  };
  if (options.json_file && result.machine.opengl.empty()) result.machine.opengl = gl_driver_here();
  if (options.json_file && !json_printed) write(*options.json_file, "JSON", bench_json(result));
  if (options.report) write(*options.report, "HTML report", bench_page(result));
  if (json_printed) print(bench_json(result));
}

}  // namespace trueshade
