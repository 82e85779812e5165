#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <string>
#include <system_error>
#include <variant>

#include "cli/commands.h"
#include "cli/options.h"
#include "core/error.h"

namespace trueshade {
namespace {

constexpr int kOurFault = 70;  // sysexits.h: EX_SOFTWARE

/// An error is one line, and does nothing to a terminal, whatever a file's name or a key holds.
int say(std::string message, int exit_code) {
  for (char& c : message)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  std::fprintf(stderr, "trueshade: error: %s\n", message.c_str());
  return exit_code;
}

/// Says what is wrong, and gives the exit code: the only place that knows either.
int exit_code_of(const std::exception_ptr& fault) {
  try {
    std::rethrow_exception(fault);
  } catch (const Error& error) {
    return say(error.what(), int(error.kind()));
  } catch (const std::bad_alloc&) {
    return say("memory: there is not enough (render a smaller image or scene)", int(ErrorKind::out_of_memory));
  } catch (const std::system_error& error) {
    if (error.code() == std::errc::resource_unavailable_try_again)  // what a thread that cannot be started throws
      return say("threads: there is not enough memory to start them (use fewer --threads)",
                 int(ErrorKind::out_of_memory));
    return say(std::string("internal: ") + error.what() + " (please report it)", kOurFault);
  } catch (const std::exception& error) {
    return say(std::string("internal: ") + error.what() + " (please report it)", kOurFault);
  } catch (...) {
    return say("internal: unknown exception (please report it)", kOurFault);
  }
}

/// Libraries end the process where they cannot start their own threads, far from any catch of ours.
[[noreturn]] void end_without_signal() { std::_Exit(exit_code_of(std::current_exception())); }

constexpr int kViolation = 1;

int execute(const Command& command) {
  if (const auto* options = std::get_if<RenderOptions>(&command)) render(*options);
  if (const auto* options = std::get_if<InfoOptions>(&command)) print_info(*options);
  if (const auto* options = std::get_if<ListOptions>(&command)) print_list(*options);
  if (const auto* options = std::get_if<GlslFilesOptions>(&command)) write_glsl(*options);
  if (const auto* options = std::get_if<BenchOptions>(&command)) bench(*options);
  if (const auto* options = std::get_if<ValidationOptions>(&command)) return judge_opengl(*options) ? 0 : kViolation;
  if (const auto* options = std::get_if<PrintText>(&command)) print(options->text);
  return 0;
}

}  // namespace
}  // namespace trueshade

/// The only catch. A failed write must come back as an error, not as the end by a signal.
int main(int count, char** arguments) {
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  std::set_terminate(trueshade::end_without_signal);
  try {
    return trueshade::execute(trueshade::command_from_arguments(count, arguments));
  } catch (...) {
    return trueshade::exit_code_of(std::current_exception());
  }
}
