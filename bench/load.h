#pragma once
#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench/contest.h"

namespace trueshade {

/// A file of /proc or /sys; empty where there is none.
std::string system_text(const std::filesystem::path& file);

/// CPU time that a machine has given since it was started, seconds, summed over some CPUs.
struct CpuTimes {
  double busy_s = 0;    ///< to programs and the kernel, of this guest
  double stolen_s = 0;  ///< by a hypervisor to others, while this guest had work
};

// What the texts of Linux say (proc(5), kernel.org: PSI, cgroup v2); nothing where they do not say it.
/// /proc/stat. `cpus`: their numbers.
std::optional<CpuTimes> cpu_times_from_text(std::string_view stat, std::span<const int> cpus, double ticks_per_s);
/// /proc/pressure/cpu: seconds in which some task waited for a CPU.
std::optional<double> waited_s_from_text(std::string_view pressure);
/// cpu.stat of a control group: seconds in which its limit of CPU time held it back.
std::optional<double> held_back_s_from_text(std::string_view cpu_stat);
using LoadAverage = std::optional<std::array<double, 3>>;  ///< tasks that run or wait, mean of 1, 5 and 15 minutes
LoadAverage load_average_from_text(std::string_view loadavg);

/// Counters at one time, of the CPUs that this process may use.
struct LoadSample {
  double at_s = 0;   ///< of a steady clock
  double own_s = 0;  ///< CPU time of this process
  int cpus = 0;
  double tick_s = 0.01;  ///< to which the system counts
  std::optional<CpuTimes> times;
  std::optional<double> waited_s, held_back_s;
};
LoadSample load_sample();

/// Who used the CPUs that this process may use, between two samples, in CPUs.
struct Load {
  double seconds = 0;
  int cpus = 0;
  bool is_known = false;                   ///< false where the system does not count
  double own = 0, others = 0, stolen = 0;  ///< others: at least; ticks that only counting may have made are left out
  double held_back = 0;                    ///< share of the time
  std::optional<double> waited;            ///< share of the time, tasks of this process among them
};
Load load_between(const LoadSample& from, const LoadSample& to);

// When figures are not to be quoted. Each limit is what a figure of two digits, such as "19x", can bear.
/// Share of the CPUs that others may take: a free thread takes the next tile, so a frame lasts as much longer.
inline constexpr double kMostTaken = 0.05;
/// Of the middle half of the frames, of their median: the median of 15 frames is then known to 3 %.
inline constexpr double kMostSpread = 0.10;
/// Of each row: fewer tell neither spread nor an interval (bench/comparison.h), and one is a frame with cold caches.
inline constexpr int kLeastFrames = 5;
/// Between the fastest and the slowest clock measured, of the fastest; times follow the clock.
inline constexpr double kMostClockChange = 0.05;
/// Of the time in which a control group's limit held this process back.
inline constexpr double kMostHeldBack = 0.01;
/// Frames that one thread draws faster than this may gain nothing by a second thread, ms.
inline constexpr double kLeastShared = 1.0;

// Each is a clause that says why, or empty. `when`: `before this ran` or `while this ran`.
std::vector<std::string> load_reasons(const Load& load, std::string_view when);
std::string clock_reason(std::span<const double> measured_ghz);
struct NamedTiming {
  std::string name;
  const Timing* timing;
  int threads = 0;  ///< 0: it is not compared by them
};
std::string frames_reason(std::span<const NamedTiming> rows);
std::string spread_reason(std::span<const NamedTiming> rows);
/// Where more threads, of at most `cpus`, are slower than fewer by more than the spread.
std::string threads_reason(std::span<const NamedTiming> rows, int cpus);

}  // namespace trueshade
