// The command `batch`.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "cli/batch/batch_results.h"
#include "cli/batch/child.h"
#include "cli/batch/job_commands.h"
#include "cli/batch/journal.h"
#include "cli/batch/schedule.h"
#include "cli/commands.h"
#include "cli/progress_bar.h"
#include "cli/written_files.h"
#include "core/error.h"
#include "core/image_files/image_io.h"
#include "core/memory_cap.h"
#include "core/threads/parallel_for.h"
#include "scenes/files/content/scene_files.h"

namespace trueshade::batch {
namespace {

constexpr int kSignals[] = {SIGINT, SIGTERM, SIGHUP};
volatile std::sig_atomic_t ended_by = 0;

void end_jobs(int signal) {
  ended_by = signal;
  stop_children();
}

/// For its lifetime signals that end this process end its jobs first.
class EndsJobs {
 public:
  EndsJobs() {
    prepare_to_stop();
    for (size_t i = 0; i < std::size(kSignals); ++i) {
      struct sigaction action {};
      action.sa_handler = end_jobs;
      sigemptyset(&action.sa_mask);
      action.sa_flags = SA_RESTART;
      sigaction(kSignals[i], &action, &before_[i]);
      if (before_[i].sa_handler == SIG_IGN) sigaction(kSignals[i], &before_[i], nullptr);  // as nohup has it
    }
  }
  ~EndsJobs() {
    for (size_t i = 0; i < std::size(kSignals); ++i) sigaction(kSignals[i], &before_[i], nullptr);
  }
  EndsJobs(const EndsJobs&) = delete;
  EndsJobs& operator=(const EndsJobs&) = delete;

 private:
  struct sigaction before_[std::size(kSignals)];
};

JobList read_jobs(const std::string& file) {
  const SceneLimits limits;
  const std::vector<uint8_t> bytes = read_user_file(file, limits.json_bytes, "");
  JobList list = job_list_from_json({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, file);
  check_commands(list);
  return list;
}

std::vector<bool> jobs_to_run(const BatchOptions& options, const JobList& list) {
  const std::vector<bool> chosen = chosen_jobs(list, options.only.value_or("*"));
  if (std::find(chosen.begin(), chosen.end(), true) == chosen.end())
    throw Error(ErrorKind::usage, "--only", "no job has a name like '" + *options.only + "'",
                "give a name, or a pattern of * and ?");
  return chosen;
}

/// Cores and memory are shared evenly among the jobs that run at once.
RunRules rules_of(const BatchOptions& options, const std::string& folder, int jobs) {
  const int cores = thread_count(0);
  RunRules rules;
  rules.resumes = options.resumes;
  rules.at_once = options.jobs > 0 ? options.jobs : options.threads > 0 ? std::max(1, cores / options.threads) : cores;
  rules.at_once = std::min(rules.at_once, jobs);
  rules.place.folder = folder;
  rules.place.threads = options.threads > 0 ? options.threads : std::max(1, cores / rules.at_once);
  rules.place.memory = memory_cap() / uint64_t(rules.at_once);
  return rules;
}

void write_report(const std::string& path, const std::string& text) {
  write_file(path, {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
}

bool prints_json(const BatchOptions& options) { return options.json_file == "-"; }

void write_reports(const BatchOptions& options, const BatchResults& results) {
  const auto to = prints_json(options) ? StandardOutput::answer : StandardOutput::files;
  print(prints_json(options) ? results_json(results) : shown_report(results_text(results)));
  if (options.json_file && !prints_json(options)) {
    write_report(*options.json_file, results_json(results));
    say_written(*options.json_file, "JSON", to);
  }
  if (options.junit) {
    write_report(*options.junit, results_junit(results));
    say_written(*options.junit, "JUnit", to);
  }
  if (options.report) {
    write_report(*options.report, results_page(results));
    say_written(*options.report, "HTML report", to);
  }
}

/// Ends this process as the signal would have done.
[[noreturn]] void end_by_signal(int done, int count) {
  say("ended by a signal: " + std::to_string(done) + " of " + std::to_string(count) +
          " jobs are done, and --resume goes on with the others",
      SaidAs::note);
  std::signal(ended_by, SIG_DFL);
  std::raise(ended_by);
  std::abort();  // not reached: the default of these signals ends the process
}

}  // namespace
}  // namespace trueshade::batch

namespace trueshade {

int run_batch(const BatchOptions& options) {
  using namespace batch;
  const auto begin = std::chrono::steady_clock::now();
  const JobList list = read_jobs(options.file);
  const std::vector<bool> chosen = jobs_to_run(options, list);
  const int count = int(std::count(chosen.begin(), chosen.end(), true));
  for (const auto& path : {options.json_file, options.junit, options.report})
    if (path && *path != "-") check_writable(*path);
  const std::string folder = std::filesystem::absolute(options.file).parent_path().string();
  Journal journal(options.state.value_or(options.file + ".state"), program_identity(), options.resumes);
  std::vector<JobResult> results;
  {
    const EndsJobs ends_jobs;
    ProgressBar bar("running", "jobs");
    int done = 0;
    results = run_jobs(list, chosen, rules_of(options, folder, count), journal, [&](int now, int all) {
      done = now;
      bar.show(now, all);
    });
    if (ended_by != 0) end_by_signal(done, count);
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const BatchResults all{list, results, chosen, folder, seconds, "trueshade" + options.command_line};
  write_reports(options, all);
  return all.passed() ? 0 : 1;
}

}  // namespace trueshade
