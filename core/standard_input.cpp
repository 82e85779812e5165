#include "core/standard_input.h"

#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>

#include "core/error.h"
#include "core/memory_cap.h"

namespace trueshade {

std::vector<uint8_t> read_standard_input(uint64_t limit, std::string_view option) {
  constexpr size_t kStep = size_t(1) << 16;
  static std::atomic<bool> is_read{false};
  if (is_read.exchange(true))
    throw Error(ErrorKind::usage, kStandardInput, "it is read already, and comes once",
                "name a file for one of the two");
  if (isatty(STDIN_FILENO) != 0)
    throw Error(ErrorKind::usage, kStandardInput, "it is a terminal", "send a file into it: trueshade ... - <FILE");
  std::vector<uint8_t> bytes;
  for (size_t done = 0;;) {
    if (bytes.size() - done < kStep) {
      require_memory(bytes.size() + kStep, kStandardInput, "what comes from it");
      bytes.resize(2 * bytes.size() + kStep);
    }
    const ssize_t got = ::read(STDIN_FILENO, bytes.data() + done, bytes.size() - done);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0)
      throw Error(ErrorKind::io, kStandardInput, std::string("cannot read: ") + std::strerror(errno),
                  "check what is sent into it");
    done += size_t(got);
    if (done > limit)
      throw Error(ErrorKind::limit, kStandardInput, "more bytes come than the limit",
                  "at most " + std::to_string(limit) + " bytes" +
                      (option.empty() ? std::string() : ", or a higher " + std::string(option)));
    if (got == 0) {
      bytes.resize(done);
      return bytes;
    }
  }
}

}  // namespace trueshade
