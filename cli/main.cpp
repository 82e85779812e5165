#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>
#include <variant>

#include "cli/commands.h"
#include "cli/job_process.h"
#include "cli/options.h"
#include "cli/shared_render.h"
#include "cli/terminal.h"
#include "core/error.h"
#include "core/fp_env.h"
#include "core/memory_cap.h"
#include "core/pixel_cap.h"
#include "core/printable_text.h"
#include "farm/process_ranks.h"
#include "programs/run/fast/machine_stages.h"

namespace trueshade {
namespace {

constexpr int kOurFault = 70;          // sysexits.h: EX_SOFTWARE
constexpr int kReaderGone = 128 + 13;  // as of a program that SIGPIPE ends

/// Writes all of it, and takes no memory for that.
void write_to_standard_error(std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = write(STDERR_FILENO, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return;  // nobody is left to be told
    text.remove_prefix(size_t(written));
  }
}

/// An error is one line, printable() whatever a file's name or a key holds. It is put together in memory that is there
/// from the start, because the fault may be that there is no more.
int say_error(std::string_view message, int exit_code) {
  static char line[1 << 14];
  size_t size = 0;
  const auto append = [&size](std::string_view text) {
    const size_t room = std::min(text.size(), sizeof line - 1 - size);
    std::copy_n(text.data(), room, line + size);
    size += room;
  };
  const auto append_word = [&](std::string_view escape, std::string_view word) {
    if (terminal_takes_colors()) append(escape);
    append(word);
  };
  append_word("\x1b[1m", "trueshade: ");
  append_word("\x1b[31m", "error: ");
  append_word("\x1b[0m", "");
  while (!message.empty()) {
    const FirstCharacter first = first_character(message);
    append(first.is_shown ? message.substr(0, first.bytes) : "?");
    message.remove_prefix(first.bytes);
  }
  line[size++] = '\n';
  write_to_standard_error({line, size});
  return exit_code;
}

int say_our_fault(const char* what) {
  char text[1024];
  std::snprintf(text, sizeof text, "internal: %.900s (please report it)", what);
  return say_error(text, kOurFault);
}

int say_out_of_memory() {
  return say_error("memory: there is not enough (render a smaller image or scene)", int(ErrorKind::out_of_memory));
}

int say_no_more_threads() {
  return say_error("threads: the system starts no more (raise the limit on processes, ulimit -u, or end others)",
                   int(ErrorKind::out_of_memory));
}

/// Says what is wrong, and gives the exit code: the only place that knows either.
int exit_code_of(const std::exception_ptr& fault) {
  try {
    std::rethrow_exception(fault);
  } catch (const Error& error) {
    return say_error(error.what(), int(error.kind()));
  } catch (const ReaderGone&) {
    return kReaderGone;
  } catch (const std::bad_alloc&) {
    return say_out_of_memory();
  } catch (const std::length_error&) {  // more elements than a container can ever have
    return say_out_of_memory();
  } catch (const std::system_error& error) {
    return error.code() == std::errc::resource_unavailable_try_again ? say_no_more_threads()
                                                                     : say_our_fault(error.what());
  } catch (const std::exception& error) {
    return say_our_fault(error.what());
  } catch (...) {
    return say_our_fault("unknown exception");
  }
}

/// Libraries end the process where they cannot start their own threads, far from any catch of ours.
[[noreturn]] void end_without_signal() {
  const std::exception_ptr fault = std::current_exception();
  std::_Exit(fault ? exit_code_of(fault) : say_out_of_memory());  // there was none left to throw an exception
}

/// Memory that is given back when there is no more, so that the way out of where it was needed has some.
char* reserve = nullptr;
constexpr size_t kReserve = size_t(1) << 18;

void give_reserve_back() {
  std::free(std::exchange(reserve, nullptr));
  throw std::bad_alloc();
}

void install_handlers() {
  std::set_terminate(end_without_signal);
  reserve = static_cast<char*>(std::malloc(kReserve));
  std::set_new_handler(give_reserve_back);
}

/// Called before the initializers of the libraries, which may run out of memory as well.
__attribute__((section(".preinit_array"), used)) void (*const before_libraries)() = install_handlers;

/// What reading a mapped file comes to when somebody has made the file shorter, or the disk fails.
void end_at_lost_bytes(int) {
  std::_Exit(say_error("--cache: a part of the cache file is no longer there (remove the file; it is made anew)",
                       int(ErrorKind::io)));
}

/// As where SIGTERM ends the process: what was to be written is not there, or is the file that was there before, and a
/// large picture can be gone on with.
void end_at_timeout(int) {
  std::_Exit(say_error("--timeout: the time is over (ask for less, or give more seconds)", int(ErrorKind::limit)));
}

void end_after(uint64_t seconds) {
  std::signal(SIGALRM, end_at_timeout);
  const itimerval once{{}, {time_t(std::min<uint64_t>(seconds, UINT32_MAX)), 0}};
  setitimer(ITIMER_REAL, &once, nullptr);
}

void set_program_limits(const Limits& given) {
  programs::ProgramLimits limits;
  limits.nodes = given.program_nodes, limits.trips = given.loop_trips, limits.seconds = given.program_seconds;
  programs::set_program_limits(limits);
}

void set_up(const Command& command) {
  std::visit(
      [](const auto& options) {
        if constexpr (requires { options.quiet; })
          if (options.quiet) be_quiet();
        if constexpr (requires { options.no_machine_code; }) {
          if (options.no_machine_code) static const programs::MachineCodeScope interpreted(false);
        }
        if constexpr (requires { options.limits; }) {
          if (options.limits.memory != 0) set_memory_cap(options.limits.memory);
          if (options.limits.pixels != 0) set_pixel_cap(options.limits.pixels);
          set_program_limits(options.limits);
          if (options.limits.seconds != 0) end_after(options.limits.seconds);
          if (options.limits.cache) std::signal(SIGBUS, end_at_lost_bytes);
        }
      },
      command);
}

/// The only catch.
int run(int count, char** arguments) {
  const MpiStart start = mpi_start();
  const bool is_other = start.by_mpi && start.rank != 0;
  try {
    become_job_process();
    const Command command = command_from_arguments(count, arguments);
    if (is_other && !is_shared(command)) return 0;  // rank 0 alone carries it out
    set_up(command);
    return execute(command);
  } catch (...) {
    // What all processes of MPI find, as a wrong option, rank 0 says, and mpirun ends the others when rank 0 ends.
    if (is_other) std::this_thread::sleep_for(std::chrono::seconds(2));
    return exit_code_of(std::current_exception());
  }
}

}  // namespace
}  // namespace trueshade

/// A failed write must come back as an error, not as the end by a signal.
int main(int count, char** arguments) {
  const trueshade::FpScope ieee;  // whatever a library that was loaded before has left: texts are rounded by it, too
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  return trueshade::leave_process_ranks(trueshade::run(count, arguments));
}
