#include "cli/bench_ranks.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <utility>

#include "cli/bench.h"
#include "cli/commands.h"
#include "cli/notes.h"
#include "cli/preparation.h"
#include "cli/shared_render.h"
#include "cli/terminal.h"
#include "cli/written_files.h"
#include "core/error.h"
#include "core/image_files/image_io.h"
#include "core/threads/parallel_for.h"
#include "farm/lone_rank.h"
#include "farm/process_ranks.h"

namespace trueshade {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kMachines[] = {1, 4, 16, 64, 256, 1024};
constexpr int kAnyNumber = 1 << 20;

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

/// A folder that goes with all that is in it.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    const char* const folder = std::getenv("TMPDIR");
    std::string path = std::string(folder != nullptr ? folder : "/tmp") + "/trueshade-bench-XXXXXX";
    if (mkdtemp(path.data()) == nullptr)
      throw Error(ErrorKind::io, path, "cannot make a folder there", "set TMPDIR to one that can be written");
    path_ = path;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// Files are written, as their writing is measured, into a folder, whatever folder the rank that drew them has named;
/// of the rest hashes are kept.
class WrittenPictures : public PictureSink {
 public:
  explicit WrittenPictures(std::string folder) : folder_(std::move(folder)) {}
  void file(const std::string& path, EncodedFile file, const std::string&, bool) override {
    const std::string name = std::filesystem::path(path).filename().string();
    write_file(folder_ + '/' + name, FilePieces(file.begin(), file.end()));
  }
  void written(const std::string&, const std::string&) override {}
  void video(std::vector<uint8_t>) override {}
  void text(const std::string& text) override { hashes_ += text; }
  void timed_text(const std::string&) override {}
  void document(const std::string&) override {}
  void note(const std::string&) override {}
  const std::string& hashes() const { return hashes_; }

 private:
  const std::string folder_;
  std::string hashes_;
};

/// One scene, which all ranks draw: rank 0 alone task by task, then more and more of them together.
class RanksBench {
 public:
  RanksBench(const BenchOptions& options, const std::string& scene, Ranks& ranks) : ranks_(ranks) {
    static_cast<PipelineOptions&>(render_) = options;
    render_.scene = scene;
    render_.frames = options.frames;
    render_.simd = options.simd;
    render_.execution = options.execution;
    render_.hash = true;
    if (ranks.own() == 0) folder_ = std::make_unique<TemporaryFolder>();
    render_.outputs = {(folder_ ? folder_->path() + '/' : "") + "picture.png"};  // rank 0 writes
    result_.scene = scene;
  }

  RanksTime run() {
    std::vector<int> counts;
    for (int count = 1; count < ranks_.count(); count *= 2) counts.push_back(count);
    counts.push_back(ranks_.count());
    for (const int count : counts) measure(count);
    if (ranks_.own() == 0) make_table();
    return std::move(result_);
  }

 private:
  /// Every rank calls it; the first `count` draw. Rank 0 measures costs before the first time, while the others wait.
  void measure(int count) {
    SharingRules rules = render_.sharing;
    rules.ranks = count;
    rules.slow_after = std::chrono::hours(1 << 16);
    WrittenPictures pictures(folder_ ? folder_->path() : "");
    SharedRender render(render_, ranks_, pictures, count);
    Clock::time_point begin;
    share_tasks(ranks_, rules, [&] {
      if (ranks_.own() == 0 && result_.coarse.tasks.empty()) measure_costs();
      SharedTasks tasks = render.first_tasks();
      std::erase_if(tasks.identity, [](const auto& entry) { return entry.first == "output"; });  // another folder
      begin = Clock::now();
      return tasks;
    });
    render.finish(0);
    if (ranks_.own() != 0) return;
    const double seconds = seconds_since(begin);
    if (pictures.hashes() != result_.coarse.hash)
      throw std::runtime_error("bench --ranks: " + std::to_string(count) + " ranks drew another picture than one");
    result_.here.push_back({count, seconds, model_here(count)});
  }

  void measure_costs() {
    result_.coarse = costs(1);
    result_.fine = result_.by_bands ? costs(std::end(kMachines)[-1]) : result_.coarse;
    const double more_bands = double(result_.fine.tasks.size()) - double(result_.coarse.tasks.size());
    if (more_bands > 0) result_.band_s = std::max(0.0, (result_.fine.draw_s() - result_.coarse.draw_s()) / more_bands);
  }

  /// All tasks in turn, by all cores, in bands as that many ranks would have them.
  TaskCosts costs(int for_ranks) {
    TaskCosts costs;
    LoneRank alone;
    WrittenPictures pictures(folder_->path());
    Wanted wanted;
    auto begin = Clock::now();
    SharedRender render(render_, alone, pictures, for_ranks);
    const SharedTasks tasks = render.first_tasks();
    costs.start_s = seconds_since(begin);
    describe(render);
    for (int task = 0; task < tasks.count; ++task) {
      begin = Clock::now();
      std::vector<uint8_t> bytes = tasks.run(task, tasks.brief ? tasks.brief(task) : std::vector<uint8_t>(), wanted);
      TaskCost cost{seconds_since(begin), bytes.size(), 0.0};
      begin = Clock::now();
      tasks.take(task, std::move(bytes));
      cost.take_s = seconds_since(begin);
      costs.tasks.push_back(cost);
    }
    begin = Clock::now();
    render.finish(0);
    costs.finish_s = seconds_since(begin);
    costs.hash = pictures.hashes();
    return costs;
  }

  void describe(const SharedRender& render) {
    const Pipeline& p = render.pipeline();
    result_.by_bands = render.by_bands();
    if (result_.by_bands && render_.frames)
      throw usage("--frames", "a large picture is shared by its bands, and so is each of a sequence of them",
                  "leave --frames out, or --size");
    result_.picture = std::to_string(p.width) + 'x' + std::to_string(p.height);
    if (render_.frames)
      result_.picture +=
          ", frames " + std::to_string(render_.frames->first) + '-' + std::to_string(render_.frames->last);
    result_.picture += ", " + std::string(name_of(p.strategy)) + ", PNG and hash";
  }

  int threads() const { return thread_count(render_.execution.threads); }

  std::vector<TaskCost> tasks_for(int machines) const {
    if (!result_.by_bands) return result_.coarse.tasks;
    // As many bands as that many ranks would have, and no fewer than one rank has.
    const size_t least = result_.coarse.tasks.size(), most = result_.fine.tasks.size();
    const size_t wanted = std::clamp(size_t(machines) * 4, least, most);
    return grouped(result_.fine.tasks, int(most / wanted), result_.band_s);
  }

  /// Ranks share the cores of their machine: each draws slower by the threads that it lacks, and by the cores that
  /// threads lack. Where a core is left, taking results costs drawing nothing.
  double model_here(int count) {
    const int cores = thread_count(0), together = std::min(count, ranks_.on_this_machine());
    int& own_threads = result_.threads_of_rank;
    own_threads = render_.execution.threads > 0 ? threads() : std::max(1, cores / ranks_.on_this_machine());
    std::vector<TaskCost> tasks = tasks_for(count);
    const double slower = double(threads()) / own_threads * std::max(1.0, double(together) * own_threads / cores);
    for (TaskCost& task : tasks) task.draw_s *= slower;
    const int shared_with_drawing = together * own_threads < cores ? kAnyNumber : own_threads;
    return farm_estimate(tasks, count, shared_with_drawing, {}).seconds + result_.coarse.finish_s;
  }

  void make_table() {
    for (const int machines : kMachines) {
      const std::vector<TaskCost> tasks = tasks_for(machines);
      RanksTime::Row row{machines, int(tasks.size()), farm_estimate(tasks, machines, threads(), {}), 0.0, 0.0};
      const double once = result_.coarse.start_s + result_.coarse.finish_s;
      row.seconds = once + row.estimate.seconds;
      row.serial_s = once + row.estimate.taking_s;
      result_.table.push_back(row);
    }
  }

  Ranks& ranks_;
  RenderOptions render_;
  std::unique_ptr<TemporaryFolder> folder_;
  RanksTime result_;
};

}  // namespace

double TaskCosts::draw_s() const {
  return std::accumulate(tasks.begin(), tasks.end(), 0.0,
                         [](double sum, const TaskCost& task) { return sum + task.draw_s; });
}

double TaskCosts::take_s() const {
  return std::accumulate(tasks.begin(), tasks.end(), 0.0,
                         [](double sum, const TaskCost& task) { return sum + task.take_s; });
}

std::vector<TaskCost> grouped(const std::vector<TaskCost>& bands, int group, double band_s) {
  std::vector<TaskCost> tasks;
  for (size_t begin = 0; begin < bands.size(); begin += size_t(group)) {
    TaskCost task = bands[begin];
    for (size_t i = begin + 1; i < std::min(begin + size_t(group), bands.size()); ++i) {
      task.draw_s += std::max(0.0, bands[i].draw_s - band_s);
      task.bytes += bands[i].bytes;
      task.take_s += bands[i].take_s;
    }
    tasks.push_back(task);
  }
  return tasks;
}

void bench_ranks(const BenchOptions& options) {
  LoneRank alone;
  Ranks* const joined = process_ranks();
  Ranks& ranks = joined != nullptr ? *joined : alone;
  if (ranks.own() != 0) be_quiet();
  if (ranks.own() == 0 && options.json_file && *options.json_file != "-") check_writable(*options.json_file);
  RanksResult result;
  result.machine = this_machine();
  result.threads = thread_count(options.execution.threads);
  result.simd = options.simd == "best" ? simd_targets().front() : options.simd;
  for (const std::string& scene : options.scenes) result.scenes.push_back(RanksBench(options, scene, ranks).run());
  if (ranks.own() != 0) return;
  if (options.json_file != "-") print(ranks_text(result));
  if (!options.json_file) return;
  const std::string json = ranks_json(result);
  if (*options.json_file == "-") return print(json);
  write_file(*options.json_file, {reinterpret_cast<const uint8_t*>(json.data()), json.size()});
  say_written(*options.json_file, "JSON", StandardOutput::files);
}

}  // namespace trueshade
