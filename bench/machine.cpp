#include "bench/machine.h"

#include <gnu/libc-version.h>
#include <sys/utsname.h>
#include <unistd.h>
#if defined(__x86_64__)
#include <cpuid.h>
#endif

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <set>
#include <sstream>
#include <thread>
#include <utility>

#include "core/threads/parallel_for.h"

namespace trueshade {
namespace {

std::string first_line(const std::filesystem::path& file) {
  const std::string text = system_text(file);
  return text.substr(0, text.find('\n'));
}

int integer_of(const std::string& text) {
  int value = -1;
  return std::sscanf(text.c_str(), "%i", &value) == 1 ? value : -1;
}

std::string os_name() {
  std::istringstream release(system_text("/etc/os-release"));
  constexpr std::string_view kKey = "PRETTY_NAME=";
  for (std::string line; std::getline(release, line);) {
    if (!line.starts_with(kKey)) continue;
    line.erase(0, kKey.size());
    std::erase(line, '"');
    return line;
  }
  return "unknown";
}

std::string kernel_name() {
  utsname name{};
  if (uname(&name) != 0) return "unknown";
  // What follows the version may name whoever built the kernel.
  const std::string release(name.release);
  return std::string(name.sysname) + ' ' + release.substr(0, release.find('-')) + ' ' + name.machine;
}

/// CPUID's leaf 0x40000000 has 12 letters there.
std::string hypervisor_name() {
#if defined(__x86_64__)
  unsigned most = 0, letters[3] = {};
  __cpuid(0x40000000u, most, letters[0], letters[1], letters[2]);
  const std::string name(reinterpret_cast<const char*>(letters), sizeof letters);
  return name.substr(0, name.find('\0'));
#else
  return {};
#endif
}

std::string date_now() {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  char text[64];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%S%z", &local);
  return text;
}

std::string compiler_name() {
#if defined(__clang__)
  return std::string("clang ") + __clang_version__;
#else
  return std::string("g++ ") + __VERSION__;
#endif
}

}  // namespace

CpuIdentity cpu_from_text(std::string_view cpuinfo) {
  CpuIdentity cpu;
  std::set<std::pair<std::string, std::string>> cores;
  std::string package, implementer, part;
  std::istringstream lines{std::string(cpuinfo)};
  for (std::string line; std::getline(lines, line);) {
    const size_t colon = line.find(':');
    if (colon == std::string::npos) continue;
    const std::string key = line.substr(0, line.find_last_not_of(" \t", colon - 1) + 1);
    const std::string value = colon + 2 < line.size() ? line.substr(colon + 2) : "";
    if (key == "processor") ++cpu.threads;
    if (key == "physical id") package = value;
    if (key == "core id") cores.emplace(package, value);
    if (cpu.threads > 1) continue;  // the others are as the first
    if (key == "model name") cpu.name = value;
    if (key == "vendor_id") cpu.vendor = value;
    if (key == "cpu family") cpu.family = integer_of(value);
    if (key == "model") cpu.model = integer_of(value);
    if (key == "stepping") cpu.stepping = integer_of(value);
    if (key == "flags") cpu.is_virtual = (' ' + value + ' ').find(" hypervisor ") != std::string::npos;
    if (key == "CPU implementer") cpu.vendor = value;  // ARM's words from here
    if (key == "CPU architecture") cpu.family = integer_of(value);
    if (key == "CPU part") cpu.model = integer_of(value);
    if (key == "CPU revision") cpu.stepping = integer_of(value);
  }
  cpu.cores = int(cores.size());
  return cpu;
}

std::vector<Cache> caches_under(const std::filesystem::path& cpus) {
  std::vector<Cache> caches;
  std::set<std::string> seen;
  for (int cpu = 0; std::filesystem::is_directory(cpus / ("cpu" + std::to_string(cpu))); ++cpu)
    for (int index = 0;; ++index) {
      const auto folder = cpus / ("cpu" + std::to_string(cpu)) / "cache" / ("index" + std::to_string(index));
      if (!std::filesystem::is_directory(folder)) break;
      Cache cache{integer_of(first_line(folder / "level")), first_line(folder / "type"), 0, 1};
      const std::string size = first_line(folder / "size");  // 32K; the kernel writes no other unit
      cache.kib = uint64_t(std::max(0, integer_of(size)));
      if (!seen.insert(std::to_string(cache.level) + cache.type + ' ' + first_line(folder / "shared_cpu_list")).second)
        continue;
      const auto alike = std::find_if(caches.begin(), caches.end(), [&cache](const Cache& c) {
        return c.level == cache.level && c.type == cache.type && c.kib == cache.kib;
      });
      if (alike == caches.end())
        caches.push_back(cache);
      else
        ++alike->count;
    }
  return caches;
}

/// Best of a few runs of 2 million multiplications of 32 bits, each of which waits three cycles for the one before, on
/// every x86-64 core since Nehalem and Zen (Agner Fog's and uops.info's tables). Additions of a constant will not do:
/// newer cores (Golden Cove) carry out six dependent ones a cycle while they rename registers.
double measured_clock_ghz() {
  using Clock = std::chrono::steady_clock;
  constexpr int kMultiplications = 2'000'000;
  constexpr double kLatency = 3.0;
  double best = 0.0;
  for (int run = 0; run < 8; ++run) {
    uint32_t x = 3;
    const auto start = Clock::now();
    for (int i = 0; i < kMultiplications; ++i) {
      x *= x;
      asm volatile("" : "+r"(x));  // keeps them apart
    }
    const double ns = std::chrono::duration<double, std::nano>(Clock::now() - start).count();
    best = std::max(best, kLatency * kMultiplications / ns);
  }
  return best;
}

Machine this_machine() {
  Machine machine;
  machine.date = date_now();
  machine.average = load_average_from_text(system_text("/proc/loadavg"));
  const LoadSample before = load_sample();
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  machine.load_before = load_between(before, load_sample());
  machine.identity = cpu_from_text(system_text("/proc/cpuinfo"));
  machine.cpu = machine.identity.name;
  machine.cores = thread_count(0);
  machine.clock_ghz = measured_clock_ghz();
  machine.caches = caches_under("/sys/devices/system/cpu");
  machine.memory_mib = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGESIZE)) / 1048576.0;
  machine.os = os_name();
  machine.kernel = kernel_name();
  machine.compiler = compiler_name();
  machine.c_library = std::string("glibc ") + gnu_get_libc_version();
  if (machine.identity.is_virtual) machine.hypervisor = hypervisor_name();
  return machine;
}

}  // namespace trueshade
