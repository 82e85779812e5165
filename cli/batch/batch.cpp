// The command `batch`.
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <optional>

#include "cli/batch/batch_results.h"
#include "cli/batch/batch_run.h"
#include "cli/batch/child.h"
#include "cli/commands.h"
#include "cli/junit.h"
#include "cli/notes.h"
#include "cli/terminal.h"
#include "cli/written_files.h"
#include "core/error.h"
#include "core/image_files/image_io.h"
#include "farm/hand_out.h"
#include "farm/lone_rank.h"
#include "farm/process_ranks.h"

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

/// Runs the jobs; the ranks that were lost meanwhile.
std::vector<std::string> shared(BatchRun& run, const BatchOptions& options, Ranks& ranks) {
  SharingRules rules = options.sharing;
  rules.ahead = 0;                     // a job that waits at a rank may be free to run at another
  rules.slow_after = HandOut::kNever;  // two processes would write the same files
  std::optional<EndsJobs> ends_jobs;   // from when the list is read
  std::vector<std::string> lost;
  try {
    const auto tasks_of_list = [&] {
      SharedTasks tasks = run.tasks();
      ends_jobs.emplace();
      tasks.check = [] {
        if (ended_by != 0) throw Error(ErrorKind::io, "batch", "a signal has ended it", "--resume goes on");
      };
      return tasks;
    };
    lost = share_tasks(ranks, rules, tasks_of_list).lost;
  } catch (...) {
    if (ended_by == 0 || ranks.own() != 0) throw;
  }
  if (ended_by != 0 && ranks.own() == 0) end_by_signal(run.done(), run.count());
  return lost;
}

}  // namespace
}  // namespace trueshade::batch

namespace trueshade {

int run_batch(const BatchOptions& options) {
  using namespace batch;
  const auto begin = std::chrono::steady_clock::now();
  LoneRank alone;
  Ranks* const joined = process_ranks();
  Ranks& ranks = joined != nullptr ? *joined : alone;
  if (ranks.own() != 0) be_quiet();
  BatchRun run(options, ranks);
  std::vector<std::string> lost;
  try {
    lost = shared(run, options, ranks);
  } catch (const Error& error) {
    if (options.junit && ranks.own() == 0) report_error(*options.junit, "trueshade batch", options.file, error);
    throw;
  }
  if (ranks.own() != 0) return 0;
  for (const std::string& rank : lost) say_notes({rank + "; its jobs were done by others"});
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const BatchResults all{run.list(),   run.results(), run.chosen(),
                         run.folder(), seconds,       "trueshade" + options.command_line};
  write_reports(options, all);
  return all.passed() ? 0 : 1;
}

}  // namespace trueshade
