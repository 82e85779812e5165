#include "core/threads/clock.h"

#include <unistd.h>

#include <ctime>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

namespace trueshade {

double process_ms() {
  constexpr int kStartTime = 22;  // of the fields, counted from 1; the second ends with a bracket
  std::ifstream file("/proc/self/stat");
  const std::string text(std::istreambuf_iterator<char>(file), {});
  const size_t bracket = text.rfind(')');
  timespec now{};
  if (bracket == std::string::npos || clock_gettime(CLOCK_BOOTTIME, &now) != 0) return 0.0;
  std::istringstream fields(text.substr(bracket + 1));
  std::string field;
  for (int i = 3; i <= kStartTime; ++i) fields >> field;
  const double start_s = std::strtod(field.c_str(), nullptr) / double(sysconf(_SC_CLK_TCK));
  return 1e3 * (double(now.tv_sec) + 1e-9 * double(now.tv_nsec) - start_s);
}

}  // namespace trueshade
