#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "bench/load.h"

namespace trueshade {

/// What a CPU says of itself.
struct CpuIdentity {
  std::string name = "unknown CPU", vendor;    ///< as the system names them
  int family = -1, model = -1, stepping = -1;  ///< -1 where it has none
  int cores = 0, threads = 0;                  ///< of the machine, whoever may use them; cores 0 where it is not told
  bool is_virtual = false;                     ///< under a hypervisor
};
CpuIdentity cpu_from_text(std::string_view cpuinfo);  ///< the text of /proc/cpuinfo (proc(5)); x86 and ARM

/// Caches that are alike.
struct Cache {
  int level = 0;
  std::string type;  ///< Data, Instruction or Unified
  uint64_t kib = 0;  ///< of each
  int count = 0;     ///< in the machine
};
/// By level and type; none where the system does not tell. `cpus`: the folder of cpu0, cpu1, ...
std::vector<Cache> caches_under(const std::filesystem::path& cpus);

/// What a time was measured on.
struct Machine {
  std::string cpu;       ///< as the system names it
  int cores = 0;         ///< that this process may use
  double clock_ghz = 0;  ///< measured: dependent multiplications a nanosecond, of three cycles each
  CpuIdentity identity = {};
  std::vector<Cache> caches = {};
  double memory_mib = 0;
  std::string os = {}, kernel = {}, compiler = {}, c_library = {};
  std::string hypervisor = {};  ///< as CPUID names it; empty without one, and where it has no name
  std::string date = {};        ///< ISO 8601 with the time zone
  std::string opengl = {};      ///< the driver that was opened, if one was
  Load load_before = {};        ///< while this process slept
  LoadAverage average = {};     ///< as the system had it before
};

Machine this_machine();  ///< sleeps a fifth of a second, to see what others do
double measured_clock_ghz();

}  // namespace trueshade
