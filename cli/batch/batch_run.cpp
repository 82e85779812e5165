#include "cli/batch/batch_run.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "cli/batch/child.h"
#include "cli/batch/job_commands.h"
#include "core/error.h"
#include "core/image_files/image_io.h"
#include "core/memory_cap.h"
#include "core/sha256.h"
#include "core/threads/parallel_for.h"
#include "scenes/files/content/scene_files.h"

namespace trueshade::batch {
namespace {

std::vector<bool> jobs_to_run(const BatchOptions& options, const JobList& list) {
  std::vector<bool> chosen = chosen_jobs(list, options.only.value_or("*"));
  if (std::find(chosen.begin(), chosen.end(), true) == chosen.end())
    throw Error(ErrorKind::usage, "--only", "no job has a name like '" + *options.only + "'",
                "give a name, or a pattern of * and ?");
  return chosen;
}

std::vector<uint8_t> bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

JobResult result_of_bytes(std::span<const uint8_t> bytes) {
  return result_from_line({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, "result of a job").result;
}

}  // namespace

BatchRun::BatchRun(const BatchOptions& options, Ranks& ranks)
    : options_(options), ranks_(ranks), program_(program_identity()) {}

SharedTasks BatchRun::tasks() {
  read();
  grant();
  if (ranks_.own() == 0) {
    for (const auto& path : {options_.json_file, options_.junit, options_.report})
      if (path && *path != "-") check_writable(*path);
    journal_.emplace(options_.state.value_or(options_.file + ".state"), program_, options_.resumes);
    results_.resize(list_.jobs.size());
    bar_ = std::make_unique<ProgressBar>("running", "jobs");
  }
  SharedTasks tasks;
  tasks.count = count();
  tasks.identity = {
      {"program", program_}, {"list of jobs", list_hash_}, {"choice of jobs", options_.only.value_or("*")}};
  tasks.after = after();
  tasks.in_any_order = true;
  tasks.at_once = at_once_;
  if (options_.resumes) tasks.brief = [this](int task) { return line_before(task); };
  tasks.run = [this](int task, std::span<const uint8_t> before, const Wanted&) { return run(task, before); };
  tasks.stop = stop_children;
  tasks.take = [this](int task, const std::vector<uint8_t>& line) { take(task, line); };
  tasks.opens = [this](int task) { return result_of(task).state != JobState::failed; };
  tasks.leave_out = [this](int task, int because) {
    const bool failed = result_of(because).state == JobState::failed;
    result_of(task).reason = "it is after " + job_of(because).name + ", which " + (failed ? "failed" : "was skipped");
    count_one();
  };
  return tasks;
}

void BatchRun::read() {
  const SceneLimits limits;
  const std::vector<uint8_t> bytes = read_user_file(options_.file, limits.json_bytes, "");
  list_ = job_list_from_json({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, options_.file);
  check_commands(list_);
  Sha256 hash;
  hash.update(bytes.data(), bytes.size());
  list_hash_ = hash.hex();
  folder_ = std::filesystem::absolute(options_.file).parent_path().string();
  chosen_ = jobs_to_run(options_, list_);
  for (size_t i = 0; i < chosen_.size(); ++i)
    if (chosen_[i]) jobs_.push_back(int(i));
}

/// Cores and memory of a machine are shared evenly among its ranks, and of a rank among the jobs that it runs at once.
void BatchRun::grant() {
  const int ranks = ranks_.on_this_machine();
  const int cores = std::max(1, thread_count(0) / ranks);
  at_once_ = cores;
  if (options_.threads > 0) at_once_ = std::max(1, cores / options_.threads);
  if (options_.jobs > 0) at_once_ = options_.jobs;
  at_once_ = std::min(at_once_, count());
  place_.folder = folder_;
  place_.threads = options_.threads > 0 ? options_.threads : std::max(1, cores / at_once_);
  place_.memory = memory_cap() / uint64_t(ranks) / uint64_t(at_once_);
}

/// Of each task those that it is after, which are chosen too.
std::vector<std::vector<int>> BatchRun::after() const {
  std::vector<int> task_of(list_.jobs.size(), -1);
  for (size_t task = 0; task < jobs_.size(); ++task) task_of[size_t(jobs_[task])] = int(task);
  std::vector<std::vector<int>> after(jobs_.size());
  for (size_t task = 0; task < jobs_.size(); ++task)
    for (const int job : job_of(int(task)).after) after[task].push_back(task_of[size_t(job)]);
  return after;
}

/// What became of the job in an earlier run, if it passed; whoever does the task looks whether its files are as they
/// were.
std::vector<uint8_t> BatchRun::line_before(int task) const {
  const JobResult* const before = journal_->result_of(job_of(task));
  if (before == nullptr || !before->passed()) return {};
  return bytes_of(line_of(job_of(task), *before, program_));
}

std::vector<uint8_t> BatchRun::run(int task, std::span<const uint8_t> line_before) {
  const Job& job = job_of(task);
  JobResult result;  // skipped, where a signal has stopped the jobs of this process
  if (!line_before.empty() && !children_stopped()) result = result_of_bytes(line_before);
  if (result.passed() && hashes_.are_those_of(result, folder_)) {
    result.state = JobState::unchanged;
  } else {
    result = run_job(job, place_);
    result.host = ranks_.host(ranks_.own());
  }
  if (result.state == JobState::skipped && ranks_.own() != 0)
    throw Error(ErrorKind::io, "batch", "a signal has ended its jobs", "--resume goes on with what is not done");
  return bytes_of(line_of(job, result, program_));
}

void BatchRun::take(int task, const std::vector<uint8_t>& line) {
  JobResult result = result_of_bytes(line);
  if (result.state == JobState::skipped) return;  // a signal ended it, and will end the run
  if (result.state != JobState::unchanged) journal_->add(job_of(task), result);
  result_of(task) = std::move(result);
  count_one();
}

void BatchRun::count_one() { bar_->show(++done_, count()); }

}  // namespace trueshade::batch
