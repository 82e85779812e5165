#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace trueshade::batch {

/// The first and the last bytes of a text that may be of any length, and how many are between them.
class CutText {
 public:
  static constexpr size_t kKept = 8192;  ///< bytes of each end
  void append(const char* bytes, size_t count);
  std::string text() const;  ///< with a line that says how much is left out, if anything is

 private:
  std::string first_, last_;
  uint64_t left_out_ = 0;
};

/// How a process of ours ended.
struct ChildEnd {
  int exit_code = 0;                ///< where neither a signal nor the timeout ended it
  int signal = 0;                   ///< that ended it; 0: none
  bool timed_out = false;           ///< it was ended because its time was over
  bool interrupted = false;         ///< it was ended because stop_children() was called
  double seconds = 0.0;             ///< wall time
  double core_seconds = 0.0;        ///< of all its threads
  std::string out, err;             ///< CutText of standard output and error
  std::vector<std::string> hashes;  ///< of lines of standard output that begin with `sha256:`, as --hash prints them
  std::string notes;                ///< lines of core/file_notes.h
};

/// How a process is started.
struct ChildStart {
  std::vector<std::string> words;  ///< behind `trueshade`
  std::string folder;              ///< that it works in
  std::optional<double> timeout;   ///< seconds
  int threads = 0;                 ///< as JobProcess has them
  uint64_t memory = 0;
};

/// Starts this very program with other words, and waits for its end: standard input is empty, and variables by which
/// MPI tells a process of its place are not passed on. The process ends when the calling thread does. Any number of
/// threads may call it at once. Error(io) where it cannot be started.
ChildEnd run_child(const ChildStart& start);

/// Ends all processes that run_child() waits for, and those that it will start; may be called in a signal handler.
/// prepare_to_stop() comes first, once.
void prepare_to_stop();
void stop_children();
bool children_stopped();

}  // namespace trueshade::batch
