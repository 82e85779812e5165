#include "programs/front/bounded_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <optional>

#include "core/error.h"

namespace trueshade::programs {
namespace {

/// What the process hands back: a word that says what follows, then the words of the result, or of an Error its kind
/// and its text.
enum class Answer : uint32_t { words = 1, error };

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number() const { return number_; }

 private:
  const int number_;
};

/// Bytes of data and stacks of this process, as /proc/self/statm has them (proc(5)). Allocates nothing.
uint64_t data_of_process() {
  char text[256] = {};
  const Descriptor file(open("/proc/self/statm", O_RDONLY | O_CLOEXEC));
  if (file.number() < 0 || read(file.number(), text, sizeof text - 1) <= 0) return 0;
  unsigned long long pages = 0;
  if (std::sscanf(text, "%*u %*u %*u %*u %*u %llu", &pages) != 1) return 0;
  return pages * uint64_t(sysconf(_SC_PAGESIZE));
}

void set_limit(int resource, uint64_t most) {
  rlimit now{};
  getrlimit(__rlimit_resource_t(resource), &now);
  now.rlim_cur = std::min<rlim_t>(most, now.rlim_max);
  setrlimit(__rlimit_resource_t(resource), &now);
}

void write_all(int to, const void* bytes, size_t size) {
  const char* at = static_cast<const char*>(bytes);
  while (size > 0) {
    const ssize_t written = write(to, at, size);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) _exit(1);
    at += written, size -= size_t(written);
  }
}

void write_answer(int to, Answer answer, uint32_t kind, const void* bytes, size_t size) {
  const uint32_t head[2] = {uint32_t(answer), kind};
  write_all(to, head, sizeof head);
  write_all(to, bytes, size);
}

/// What the child process does: it carries out the task, writes the answer to the pipe and exits. It runs no destructor,
/// no exit handler and no signal handler that it has from its parent.
[[noreturn]] void carry_out(int to, const ProgramLimits& limits, const std::function<std::vector<uint32_t>()>& task) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  for (const int signal : {SIGABRT, SIGSEGV, SIGBUS, SIGTERM, SIGINT}) std::signal(signal, SIG_DFL);
  std::set_terminate([] { _exit(1); });
  if (const uint64_t data = data_of_process(); data > 0) set_limit(RLIMIT_DATA, data + limits.memory);
  set_limit(RLIMIT_CORE, 0);
  const int nowhere = open("/dev/null", O_WRONLY);
  if (nowhere >= 0) dup2(nowhere, STDERR_FILENO);
  try {
    const std::vector<uint32_t> words = task();
    write_answer(to, Answer::words, 0, words.data(), words.size() * sizeof(uint32_t));
    _exit(0);
  } catch (const Error& error) {
    write_answer(to, Answer::error, uint32_t(error.kind()), error.what(), std::strlen(error.what()));
    _exit(0);
  } catch (...) {
    _exit(1);
  }
}

/// An Error of another process: its text is taken apart where it is put together again.
Error error_with_text(ErrorKind kind, const std::string& text) {
  const size_t reason = text.find(": "), remedy = text.rfind(" (");
  if (reason == std::string::npos || remedy == std::string::npos || remedy < reason + 2 || !text.ends_with(')'))
    return {kind, "glslang", text, "correct the GLSL"};
  return {kind, text.substr(0, reason), text.substr(reason + 2, remedy - reason - 2),
          text.substr(remedy + 2, text.size() - remedy - 3)};
}

/// All that comes before the deadline; nothing where it comes first.
std::optional<std::string> read_until(int from, std::chrono::steady_clock::time_point deadline) {
  std::string all;
  for (;;) {
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
    if (left.count() <= 0) return std::nullopt;
    pollfd one{from, POLLIN, 0};
    const int ready = poll(&one, 1, int(std::min<int64_t>(left.count() + 1, 60'000)));
    if (ready < 0 && errno != EINTR) return all;
    if (ready <= 0) continue;
    char bytes[1 << 16];
    const ssize_t count = read(from, bytes, sizeof bytes);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return all;
    all.append(bytes, size_t(count));
  }
}

std::vector<uint32_t> words_of(const std::string& file, const std::string& answer, const ProgramLimits& limits) {
  uint32_t head[2] = {};
  if (answer.size() >= sizeof head) std::memcpy(head, answer.data(), sizeof head);
  const std::string rest = answer.substr(std::min(answer.size(), sizeof head));
  if (head[0] == uint32_t(Answer::error)) throw error_with_text(ErrorKind(head[1]), rest);
  if (head[0] != uint32_t(Answer::words))
    throw Error(ErrorKind::limit, file,
                "is more than glslang compiles in " + std::to_string(limits.memory >> 20) + " MiB, or ends it",
                "make it shorter, its structures above all");
  std::vector<uint32_t> words(rest.size() / sizeof(uint32_t));
  std::memcpy(words.data(), rest.data(), words.size() * sizeof(uint32_t));
  return words;
}

}  // namespace

std::vector<uint32_t> in_bounded_process(const std::string& file, const ProgramLimits& limits,
                                         const std::function<std::vector<uint32_t>()>& task) {
  int ends[2];
  if (limits.memory == 0 || pipe2(ends, O_CLOEXEC) != 0) return task();
  const Descriptor from(ends[0]);
  pid_t process = 0;
  {
    const Descriptor to(ends[1]);
    process = fork();
    if (process == 0) carry_out(to.number(), limits, task);
    if (process < 0) return task();
  }
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(limits.seconds);
  const std::optional<std::string> answer = read_until(from.number(), deadline);
  if (!answer) kill(process, SIGKILL);
  int status = 0;
  pid_t ended = 0;
  while ((ended = waitpid(process, &status, 0)) < 0 && errno == EINTR) {
  }
  const bool is_whole = ended < 0 || (WIFEXITED(status) && WEXITSTATUS(status) == 0);  // below 0: others wait for it
  if (!answer)
    throw Error(ErrorKind::limit, file, "takes glslang more than " + std::to_string(limits.seconds) + " s",
                "make it shorter, or raise --max-program-time");
  return words_of(file, is_whole ? *answer : std::string(), limits);
}

}  // namespace trueshade::programs
