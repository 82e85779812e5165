#include "core/memory_cap.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <fstream>
#include <string>

#include "core/error.h"

namespace trueshade {
namespace {

std::atomic<uint64_t> most_bytes{0};  // 0: not set
std::atomic<uint64_t> unasked{0};     // bytes allowed since the resident ones were last asked for

std::string mebibytes(uint64_t bytes) { return std::to_string((bytes + (uint64_t(1) << 20) - 1) >> 20) + " MiB"; }

/// The group of a line of /proc/self/cgroup, `ID:CONTROLLERS:/PATH`, if it has that controller.
bool group_of_line(const std::string& line, std::string_view controller, std::string& group) {
  const size_t first = line.find(':'), second = first == std::string::npos ? first : line.find(':', first + 1);
  if (second == std::string::npos) return false;
  const std::string names = ',' + line.substr(first + 1, second - first - 1) + ',';
  if (names.find(',' + std::string(controller) + ',') == std::string::npos) return false;
  group = line.substr(second + 1);
  return true;
}

uint64_t least_limit_of_groups() {
  std::ifstream groups("/proc/self/cgroup");
  uint64_t least = UINT64_MAX;
  for (std::string line, group; std::getline(groups, line);) {
    if (group_of_line(line, "", group)) {  // version 2 names no controller
      least = std::min(least, least_group_limit("/sys/fs/cgroup", group, "memory.max"));
      least = std::min(least, least_group_limit("/sys/fs/cgroup/unified", group, "memory.max"));
    }
    if (group_of_line(line, "memory", group))
      least = std::min(least, least_group_limit("/sys/fs/cgroup/memory", group, "memory.limit_in_bytes"));
  }
  return least;
}

}  // namespace

uint64_t least_group_limit(std::string_view root, std::string_view group, std::string_view name) {
  uint64_t least = UINT64_MAX;
  for (std::string path(group);; path.resize(path.rfind('/'))) {
    while (path.ends_with('/')) path.pop_back();
    std::ifstream file(std::string(root) + path + '/' + std::string(name));
    std::string text;
    uint64_t bytes = 0;
    if (file >> text && std::from_chars(text.data(), text.data() + text.size(), bytes).ec == std::errc())
      least = std::min(least, bytes);
    if (path.rfind('/') == std::string::npos) return least;
  }
}

uint64_t available_memory() {
  static const uint64_t bytes =
      std::min(uint64_t(sysconf(_SC_PHYS_PAGES)) * uint64_t(sysconf(_SC_PAGESIZE)), least_limit_of_groups());
  return bytes;
}

uint64_t memory_cap() {
  const uint64_t set = most_bytes;
  return set != 0 ? set : available_memory() / 2;
}

void set_memory_cap(uint64_t bytes) { most_bytes = bytes; }

namespace {

struct ResidentPages {
  uint64_t all = 0, of_files = 0;
};

ResidentPages resident_pages() {
  ResidentPages pages;
  const int file = open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
  if (file < 0) return pages;
  char text[128];
  const ssize_t size = read(file, text, sizeof text);
  close(file);
  const char* at = text;
  const char* const end = text + std::max<ssize_t>(size, 0);
  for (uint64_t* const number : {static_cast<uint64_t*>(nullptr), &pages.all, &pages.of_files}) {
    if (number != nullptr) std::from_chars(at, end, *number);
    at = std::find(at, end, ' ');
    at += at != end ? 1 : 0;
  }
  return pages;
}

}  // namespace

uint64_t resident_memory() {
  const ResidentPages pages = resident_pages();
  return (pages.all - std::min(pages.all, pages.of_files)) * uint64_t(sysconf(_SC_PAGESIZE));
}

uint64_t resident_memory_with_files() { return resident_pages().all * uint64_t(sysconf(_SC_PAGESIZE)); }

void require_memory(uint64_t bytes, std::string_view where, std::string_view what, std::string_view remedy) {
  constexpr uint64_t kUnasked = uint64_t(1) << 20;  // to ask what is resident takes 2 us, too long for small requests
  if (unasked.fetch_add(bytes) + bytes <= kUnasked) return;
  unasked = 0;
  const uint64_t most = memory_cap(), resident = resident_memory();
  if (bytes <= most && resident <= most - bytes) return;
  throw Error(ErrorKind::limit, where,
              std::string(what) + " needs " + mebibytes(bytes) + " besides the " + mebibytes(resident) +
                  " in use, and --max-memory is " + mebibytes(most),
              std::string(remedy) + ", or raise --max-memory");
}

}  // namespace trueshade
