#include "cli/batch/child.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <string_view>
#include <thread>
#include <utility>

#include "cli/job_process.h"
#include "core/error.h"

extern char** environ;

namespace trueshade::batch {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kNotes = 3;  // the descriptor of notes in the child
constexpr size_t kMostNotes = size_t(256) << 20;

// A pipe that is written to once, when all is to stop: whoever polls it wakes.
int stop_pipe[2] = {-1, -1};
std::atomic<bool> stopped{false};

Error cannot_start(const char* step, int error) {
  const bool none_left = error == EAGAIN || error == ENOMEM;
  return {none_left ? ErrorKind::out_of_memory : ErrorKind::io, "batch",
          std::string("cannot ") + step + ": " + std::strerror(error),
          "fewer --jobs at once, or a higher limit on processes and files"};
}

class Pipe {
 public:
  Pipe() {
    if (pipe2(ends_.data(), O_CLOEXEC) != 0) throw cannot_start("open a pipe", errno);
  }
  ~Pipe() {
    close_end(0);
    close_end(1);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  int reading() const { return ends_[0]; }
  int writing() const { return ends_[1]; }
  void close_end(size_t end) {
    if (ends_[end] >= 0) close(ends_[end]);
    ends_[end] = -1;
  }

 private:
  std::array<int, 2> ends_;
};

bool tells_of_mpi(std::string_view variable) {
  constexpr std::string_view kBegins[] = {"OMPI_", "PMIX_", "PMI_", "PRTE_"};
  return std::any_of(std::begin(kBegins), std::end(kBegins),
                     [variable](std::string_view begin) { return variable.starts_with(begin); });
}

/// The environment without MPI, and with what the job has to know.
std::vector<std::string> child_environment(const ChildStart& start) {
  std::vector<std::string> variables;
  for (char** variable = environ; *variable != nullptr; ++variable)
    if (!tells_of_mpi(*variable)) variables.emplace_back(*variable);
  const JobProcess job{int(getpid()), kNotes, start.threads, start.memory};
  variables.push_back(std::string(kJobVariable) + '=' + job.text());
  return variables;
}

std::vector<char*> pointers_to(std::vector<std::string>& words) {
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  return pointers;
}

/// The pipes of a child, and what came out of them.
struct ChildPipes {
  Pipe out, err, notes;
};

class SpawnSettings {
 public:
  SpawnSettings() {
    posix_spawn_file_actions_init(&actions);
    posix_spawnattr_init(&attributes);
  }
  ~SpawnSettings() {
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
  }
  SpawnSettings(const SpawnSettings&) = delete;
  SpawnSettings& operator=(const SpawnSettings&) = delete;
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
};

/// The child has a process group of its own. Ctrl-C does not reach that group, so run_child() ends the child.
pid_t spawn(const ChildStart& start, const ChildPipes& pipes) {
  SpawnSettings settings;
  posix_spawn_file_actions_addopen(&settings.actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&settings.actions, pipes.out.writing(), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&settings.actions, pipes.err.writing(), STDERR_FILENO);
  posix_spawn_file_actions_adddup2(&settings.actions, pipes.notes.writing(), kNotes);
  posix_spawn_file_actions_addchdir_np(&settings.actions, start.folder.c_str());
  sigset_t none, defaults;
  sigemptyset(&none);
  sigemptyset(&defaults);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGXFSZ}) sigaddset(&defaults, signal);
  posix_spawnattr_setsigmask(&settings.attributes, &none);
  posix_spawnattr_setsigdefault(&settings.attributes, &defaults);
  posix_spawnattr_setpgroup(&settings.attributes, 0);
  posix_spawnattr_setflags(&settings.attributes,
                           POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
  std::vector<std::string> words{"trueshade"}, variables = child_environment(start);
  words.insert(words.end(), start.words.begin(), start.words.end());
  pid_t child = -1;
  const int error = posix_spawn(&child, "/proc/self/exe", &settings.actions, &settings.attributes,
                                pointers_to(words).data(), pointers_to(variables).data());
  if (error != 0) throw cannot_start("start a job", error);
  return child;
}

/// Takes the hashes from what a command prints, a line at a time.
class HashFinder {
 public:
  void see(const char* bytes, size_t count, std::vector<std::string>& hashes) {
    constexpr size_t kHash = 7 + 64, kMost = 1000000;
    for (size_t i = 0; i < count; ++i) {
      if (bytes[i] != '\n') {
        if (line_.size() < kHash) line_ += bytes[i];
        continue;
      }
      if (line_.size() == kHash && line_.starts_with("sha256:") && hashes.size() < kMost) hashes.push_back(line_);
      line_.clear();
    }
  }

 private:
  std::string line_;
};

/// Reads all that comes until the child has closed its pipes, and ends it where its time is over.
class ChildReader {
 public:
  ChildReader(pid_t child, ChildPipes& pipes, std::optional<double> timeout, Clock::time_point begin)
      : child_(child), pipes_(pipes) {
    if (timeout)
      deadline_ = begin + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(*timeout));
  }

  void read_all(ChildEnd& end) {
    std::array<pollfd, 4> waited{{{pipes_.out.reading(), POLLIN, 0},
                                  {pipes_.err.reading(), POLLIN, 0},
                                  {pipes_.notes.reading(), POLLIN, 0},
                                  {stop_pipe[0], POLLIN, 0}}};
    while (std::any_of(waited.begin(), waited.begin() + 3, [](const pollfd& pipe) { return pipe.fd >= 0; })) {
      const int ready = poll(waited.data(), waited.size(), milliseconds_left());
      if (stopped && !std::exchange(end.interrupted, true)) end_it();
      if (stopped) waited[3].fd = -1;
      if (time_is_over() && !std::exchange(end.timed_out, true)) end_it();
      if (ready <= 0) continue;
      for (size_t i = 0; i < 3; ++i)
        if (waited[i].revents != 0 && !read_some(i, waited[i].fd, end)) waited[i].fd = -1;
    }
    end.out = out_.text();
    end.err = err_.text();
  }

  /// The child has closed its pipes; it is about to end, or will be ended.
  rusage wait(int& status, ChildEnd& end) {
    rusage usage{};
    for (;;) {
      const pid_t ended = wait4(child_, &status, deadline_ && !end.timed_out ? WNOHANG : 0, &usage);
      if (ended == child_ || (ended < 0 && errno != EINTR)) return usage;
      if (time_is_over() && !std::exchange(end.timed_out, true)) end_it();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

 private:
  bool time_is_over() const { return deadline_ && Clock::now() >= *deadline_; }

  int milliseconds_left() const {
    if (!deadline_) return -1;
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(*deadline_ - Clock::now()).count();
    return left <= 0 ? 100 : int(std::min<int64_t>(left, 60000));
  }

  void end_it() const { kill(-child_, SIGKILL); }

  bool read_some(size_t which, int descriptor, ChildEnd& end) {
    char bytes[65536];
    const ssize_t got = read(descriptor, bytes, sizeof bytes);
    if (got < 0) return errno == EINTR;
    if (got == 0) return false;
    const size_t count = size_t(got);
    if (which == 0) {
      out_.append(bytes, count);
      hashes_.see(bytes, count, end.hashes);
    } else if (which == 1) {
      err_.append(bytes, count);
    } else if (end.notes.size() < kMostNotes) {
      end.notes.append(bytes, count);
    }
    return true;
  }

  pid_t child_;
  ChildPipes& pipes_;
  std::optional<Clock::time_point> deadline_;
  CutText out_, err_;
  HashFinder hashes_;
};

double seconds_of(const timeval& time) { return double(time.tv_sec) + double(time.tv_usec) * 1e-6; }

}  // namespace

void CutText::append(const char* bytes, size_t count) {
  const size_t to_first = std::min(count, kKept - first_.size());
  first_.append(bytes, to_first);
  last_.append(bytes + to_first, count - to_first);
  if (last_.size() <= 2 * kKept) return;
  left_out_ += last_.size() - kKept;
  last_.erase(0, last_.size() - kKept);
}

std::string CutText::text() const {
  if (left_out_ == 0 && last_.size() <= kKept) return first_ + last_;
  const size_t more = last_.size() - std::min(last_.size(), kKept);
  return first_ + "\n[" + std::to_string(left_out_ + more) + " bytes are left out]\n" + last_.substr(more);
}

void prepare_to_stop() {
  if (pipe2(stop_pipe, O_CLOEXEC | O_NONBLOCK) != 0) throw cannot_start("open a pipe", errno);
}

void stop_children() {
  stopped = true;
  const int error = errno;
  if (write(stop_pipe[1], "", 1) < 0) errno = error;
}

bool children_stopped() { return stopped; }

ChildEnd run_child(const ChildStart& start) {
  ChildEnd end;
  if (stopped) {
    end.interrupted = true;
    return end;
  }
  ChildPipes pipes;
  const Clock::time_point begin = Clock::now();
  const pid_t child = spawn(start, pipes);
  for (Pipe* pipe : {&pipes.out, &pipes.err, &pipes.notes}) pipe->close_end(1);
  ChildReader reader(child, pipes, start.timeout, begin);
  reader.read_all(end);
  int status = 0;
  const rusage usage = reader.wait(status, end);
  end.seconds = std::chrono::duration<double>(Clock::now() - begin).count();
  end.core_seconds = seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
  if (WIFSIGNALED(status)) end.signal = WTERMSIG(status);
  if (WIFEXITED(status)) end.exit_code = WEXITSTATUS(status);
  return end;
}

}  // namespace trueshade::batch
