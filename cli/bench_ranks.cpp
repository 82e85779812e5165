#include "cli/bench_ranks.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <map>
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
#include "farm/hand_out.h"
#include "farm/lone_rank.h"
#include "farm/messages.h"
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

  /// Nothing where rank 0 has ended the run, which it alone says.
  std::optional<RanksTime> run() {
    const SharingReport measured = share_tasks(ranks_, rules_of(1), [&] {  // the others load nothing meanwhile
      if (ranks_.own() == 0) measure_costs();
      SharedTasks none;
      none.is_last = false;
      return none;
    });
    if (!measured.goes_on) return {};
    for (const int count : counts())
      if (!measure(count)) return {};
    if (ranks_.own() == 0) make_table();
    return std::move(result_);
  }

 private:
  /// Of ranks that draw together: 1, 2, 4 and so on, and all.
  std::vector<int> counts() const {
    std::vector<int> counts;
    for (int count = 1; count < ranks_.count(); count *= 2) counts.push_back(count);
    counts.push_back(ranks_.count());
    return counts;
  }

  static SharingRules rules_of(int count) {
    SharingRules rules;
    rules.ranks = count;
    rules.slow_after = HandOut::kNever;
    return rules;
  }

  /// Every rank calls it; the first `count` draw. Returns whether all is well.
  bool measure(int count) {
    WrittenPictures pictures(folder_ ? folder_->path() : "");
    SharedRender render(render_, ranks_, pictures, count);
    std::optional<Clock::time_point> begin;
    bool is_last = false;
    while (!is_last) {
      const SharingReport report = share_tasks(ranks_, rules_of(count), [&] {
        SharedTasks tasks = render.next_tasks();
        is_last = tasks.is_last;
        tasks.is_last = false;  // other counts, other scenes
        std::erase_if(tasks.identity, [](const auto& entry) { return entry.first == "output"; });  // another folder
        if (!begin) begin = Clock::now();
        return tasks;
      });
      if (!report.goes_on) return false;
      render.end_round();
    }
    if (ranks_.own() != 0) return true;
    const double seconds = seconds_since(*begin);
    if (pictures.hashes() != result_.coarse.hash)
      throw std::runtime_error("bench --ranks: " + std::to_string(count) + " ranks drew another picture than one");
    result_.here.push_back({count, seconds, model_here(count)});
    return true;
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
    auto begin = Clock::now();
    SharedRender render(render_, alone, pictures, for_ranks);
    for (bool is_first = true, is_last = false; !is_last; is_first = false) {
      const SharedTasks tasks = render.next_tasks();
      if (is_first) costs.start_s = seconds_since(begin);
      is_last = tasks.is_last;
      describe(render);
      do_in_turn(tasks, costs.tasks);
      begin = Clock::now();
      render.end_round();
      costs.finish_s = seconds_since(begin);
    }
    if (result_.by_bands) keep_rows(render);
    costs.hash = pictures.hashes();
    return costs;
  }

  void keep_rows(const SharedRender& render) {
    for (const int machines : kMachines) rows_for_[machines] = render.band_rows(machines);
    for (const int count : counts()) rows_for_[count] = render.band_rows(count);
  }

  static void do_in_turn(const SharedTasks& tasks, std::vector<TaskCost>& costs) {
    const Wanted wanted;
    const auto run = [&](int task) {
      return tasks.run(task, tasks.brief ? tasks.brief(task) : std::vector<uint8_t>(), wanted);
    };
    if (tasks.count > 0) run(0);  // caches and pages are cold
    for (int task = 0; task < tasks.count; ++task) {
      auto begin = Clock::now();
      const std::vector<uint8_t> message = packed({.what = RankSays::What::result, .number = task, .bytes = run(task)});
      TaskCost cost{seconds_since(begin), message.size(), 0.0};
      begin = Clock::now();
      tasks.take(task, std::move(unpacked(message)->bytes));
      cost.take_s = seconds_since(begin);
      costs.push_back(cost);
    }
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

  /// In bands as that many ranks would have them.
  std::vector<TaskCost> tasks_for(int machines) const {
    if (!result_.by_bands) return result_.coarse.tasks;
    const int finest = rows_for_.at(std::end(kMachines)[-1]);
    return grouped(result_.fine.tasks, std::max(1, rows_for_.at(machines) / finest), result_.band_s);
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
      row.serial_s = row.estimate.taking_s + result_.coarse.finish_s;
      row.seconds = result_.start_s() + row.estimate.seconds + result_.coarse.finish_s;
      result_.table.push_back(row);
    }
  }

  Ranks& ranks_;
  RenderOptions render_;
  std::unique_ptr<TemporaryFolder> folder_;
  std::map<int, int> rows_for_;  // of a band, by ranks
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
  if (options.json_file && *options.json_file != "-" && mpi_start().rank == 0) check_writable(*options.json_file);
  LoneRank alone;
  Ranks* const joined = process_ranks();
  Ranks& ranks = joined != nullptr ? *joined : alone;
  if (ranks.own() != 0) be_quiet();
  RanksResult result;
  result.machine = this_machine();
  result.threads = thread_count(options.execution.threads);
  result.simd = options.simd == "best" ? simd_targets().front() : options.simd;
  for (const std::string& scene : options.scenes) {
    std::optional<RanksTime> time = RanksBench(options, scene, ranks).run();
    if (!time) break;
    result.scenes.push_back(std::move(*time));
  }
  if (ranks.own() != 0) return;
  if (options.json_file != "-") print(ranks_text(result));
  if (!options.json_file) return;
  const std::string json = ranks_json(result);
  if (*options.json_file == "-") return print(json);
  write_file(*options.json_file, {reinterpret_cast<const uint8_t*>(json.data()), json.size()});
  say_written(*options.json_file, "JSON", StandardOutput::files);
}

}  // namespace trueshade
