#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <variant>

#include "cli/commands.h"
#include "cli/options.h"
#include "core/error.h"

namespace trueshade {
namespace {

constexpr int kOurFault = 70;  // sysexits.h: EX_SOFTWARE

int report(const char* message, int exit_code) {
  std::fprintf(stderr, "trueshade: error: %s\n", message);
  return exit_code;
}

void execute(const Command& command) {
  if (const auto* options = std::get_if<RenderOptions>(&command)) return render(*options);
  if (const auto* options = std::get_if<InfoOptions>(&command)) return print_info(*options);
  if (const auto* options = std::get_if<ListOptions>(&command)) return print_list(*options);
  if (const auto* options = std::get_if<GlslFilesOptions>(&command)) return write_glsl(*options);
  print(std::get<PrintText>(command).text);
}

}  // namespace
}  // namespace trueshade

/// The only place that knows exit codes. A failed write must come back as an error, not as the end by a signal.
int main(int count, char** arguments) {
  using namespace trueshade;
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  try {
    execute(command_from_arguments(count, arguments));
    return 0;
  } catch (const Error& error) {
    return report(error.what(), int(error.kind()));
  } catch (const std::bad_alloc&) {
    return report("memory: there is not enough (render a smaller image or scene)", int(ErrorKind::out_of_memory));
  } catch (const std::exception& error) {
    return report((std::string("internal: ") + error.what() + " (please report it)").c_str(), kOurFault);
  } catch (...) {
    return report("internal: unknown exception (please report it)", kOurFault);
  }
}
