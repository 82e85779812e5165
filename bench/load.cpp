#include "bench/load.h"

#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <sstream>

namespace trueshade {
namespace {

/// The number behind `name` and a separator, as in `throttled_usec 12` and `total=12`.
std::optional<double> number_behind(std::string_view text, std::string_view name) {
  const size_t at = text.find(name);
  if (at == std::string_view::npos) return {};
  double value = 0;
  if (std::sscanf(std::string(text.substr(at + name.size(), 32)).c_str(), "%lf", &value) != 1) return {};
  return value;
}

std::vector<int> usable_cpus() {
  std::vector<int> cpus;
  cpu_set_t set;
  CPU_ZERO(&set);
  if (sched_getaffinity(0, sizeof set, &set) == 0)
    for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu)
      if (CPU_ISSET(cpu, &set)) cpus.push_back(cpu);
  return cpus;
}

/// Of this process's group, version 2 of control groups.
std::string cgroup_cpu_stat() {
  const std::string groups = system_text("/proc/self/cgroup");
  const size_t at = groups.find("0::");
  if (at == std::string::npos) return {};
  return system_text("/sys/fs/cgroup" + groups.substr(at + 3, groups.find('\n', at) - at - 3) + "/cpu.stat");
}

std::string number(double value, const char* format) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string percent(double share) { return number(100 * share, share < 0.2 ? "%.1f %%" : "%.0f %%"); }

std::string cores(double used, int of) {
  return number(used, used < 0.095 ? "%.2f of " : "%.1f of ") + std::to_string(of) + (of == 1 ? " core" : " cores");
}

std::string threads_text(int threads) { return std::to_string(threads) + (threads == 1 ? " thread" : " threads"); }

}  // namespace

std::string system_text(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::optional<CpuTimes> cpu_times_from_text(std::string_view stat, std::span<const int> cpus, double ticks_per_s) {
  std::istringstream lines{std::string(stat)};
  CpuTimes sum;
  bool found = false;
  for (std::string line; std::getline(lines, line);) {
    int cpu = 0;
    // user, nice, system, idle, iowait, irq, softirq, steal; what guests of ours use is in user
    double t[8] = {};
    if (std::sscanf(line.c_str(), "cpu%d %lf %lf %lf %lf %lf %lf %lf %lf", &cpu, t, t + 1, t + 2, t + 3, t + 4, t + 5,
                    t + 6, t + 7) < 5)
      continue;
    if (std::find(cpus.begin(), cpus.end(), cpu) == cpus.end()) continue;
    found = true;
    sum.busy_s += (t[0] + t[1] + t[2] + t[5] + t[6]) / ticks_per_s;
    sum.stolen_s += t[7] / ticks_per_s;
  }
  if (!found) return {};
  return sum;
}

std::optional<double> waited_s_from_text(std::string_view pressure) {
  const size_t some = pressure.find("some ");
  if (some == std::string_view::npos) return {};
  const std::optional<double> us = number_behind(pressure.substr(some), "total=");
  if (!us) return {};
  return *us * 1e-6;
}

std::optional<double> held_back_s_from_text(std::string_view cpu_stat) {
  const std::optional<double> us = number_behind(cpu_stat, "throttled_usec ");
  if (!us) return {};
  return *us * 1e-6;
}

LoadAverage load_average_from_text(std::string_view loadavg) {
  std::array<double, 3> mean{};
  if (std::sscanf(std::string(loadavg.substr(0, 100)).c_str(), "%lf %lf %lf", &mean[0], &mean[1], &mean[2]) != 3)
    return {};
  return mean;
}

LoadSample load_sample() {
  LoadSample sample;
  const std::vector<int> cpus = usable_cpus();
  sample.cpus = int(cpus.size());
  sample.tick_s = 1.0 / double(sysconf(_SC_CLK_TCK));
  sample.times = cpu_times_from_text(system_text("/proc/stat"), cpus, 1.0 / sample.tick_s);
  sample.waited_s = waited_s_from_text(system_text("/proc/pressure/cpu"));
  sample.held_back_s = held_back_s_from_text(cgroup_cpu_stat());
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  for (const timeval& t : {usage.ru_utime, usage.ru_stime}) sample.own_s += double(t.tv_sec) + 1e-6 * double(t.tv_usec);
  sample.at_s = std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  return sample;
}

Load load_between(const LoadSample& from, const LoadSample& to) {
  Load load;
  load.cpus = to.cpus;
  load.seconds = to.at_s - from.at_s;
  if (!(load.seconds > 0)) return load;
  load.own = (to.own_s - from.own_s) / load.seconds;
  if (from.waited_s && to.waited_s) load.waited = (*to.waited_s - *from.waited_s) / load.seconds;
  if (from.held_back_s && to.held_back_s) load.held_back = (*to.held_back_s - *from.held_back_s) / load.seconds;
  if (!from.times || !to.times) return load;
  const double busy_s = to.times->busy_s - from.times->busy_s, own_s = to.own_s - from.own_s;
  const double counting_s = to.tick_s * to.cpus;         // a counter is off by up to a tick
  load.is_known = busy_s > 0 || own_s < 5 * counting_s;  // some containers show counters that stand still
  load.others =
      std::clamp((busy_s - own_s - counting_s) / load.seconds, 0.0, double(to.cpus));  // clocks differ a little
  load.stolen = std::max(0.0, to.times->stolen_s - from.times->stolen_s) / load.seconds;
  return load;
}

std::vector<std::string> load_reasons(const Load& load, std::string_view when) {
  std::vector<std::string> reasons;
  if (!load.is_known) reasons.push_back("this system does not say what others used " + std::string(when));
  if (load.others + load.stolen > kMostTaken * load.cpus) {
    std::string text;
    if (load.others >= load.stolen || load.others > kMostTaken * load.cpus)
      text = "other programs used " + cores(load.others, load.cpus);
    if (load.stolen > load.others || load.stolen > kMostTaken * load.cpus)
      text +=
          (text.empty() ? "" : " and ") + ("the host of this virtual machine took " + cores(load.stolen, load.cpus));
    reasons.push_back(text + ' ' + std::string(when));
  }
  if (load.held_back > kMostHeldBack)
    reasons.push_back("a limit of CPU time held this process back for " + percent(load.held_back) + " of the time " +
                      std::string(when));
  return reasons;
}

std::string clock_reason(std::span<const double> measured_ghz) {
  if (measured_ghz.empty()) return {};
  const auto [least, most] = std::minmax_element(measured_ghz.begin(), measured_ghz.end());
  if (*least >= (1 - kMostClockChange) * *most) return {};
  return "the clock was measured at " + number(*least, "%.2f") + " to " + number(*most, "%.2f") + " GHz while this ran";
}

std::string frames_reason(std::span<const NamedTiming> rows) {
  const auto fewest = std::min_element(rows.begin(), rows.end(), [](const NamedTiming& a, const NamedTiming& b) {
    return a.timing->ms.size() < b.timing->ms.size();
  });
  if (fewest == rows.end() || fewest->timing->ms.size() >= size_t(kLeastFrames)) return {};
  const size_t count = fewest->timing->ms.size();
  return fewest->name + " was timed for " + std::to_string(count) + (count == 1 ? " frame" : " frames") + ", where " +
         std::to_string(kLeastFrames) + " are the least";
}

std::string spread_reason(std::span<const NamedTiming> rows) {
  const NamedTiming* widest = nullptr;
  int wide = 0;
  for (const NamedTiming& row : rows) {
    if (row.timing->spread() <= kMostSpread) continue;
    ++wide;
    if (widest == nullptr || row.timing->spread() > widest->timing->spread()) widest = &row;
  }
  if (widest == nullptr) return {};
  std::string text = "the middle half of the frames of " + widest->name + " spreads over " +
                     percent(widest->timing->spread()) + " of their median, where " + percent(kMostSpread) +
                     " is the limit";
  if (wide > 1) text += "; " + std::to_string(wide - 1) + (wide > 2 ? " others are" : " other is") + " over it too";
  return text;
}

std::string threads_reason(std::span<const NamedTiming> rows, int cpus) {
  const NamedTiming *fewer = nullptr, *more = nullptr;
  double worst = 1;
  for (const NamedTiming& f : rows)
    for (const NamedTiming& m : rows) {
      if (f.threads <= 0 || m.threads <= f.threads || m.threads > cpus) continue;
      const double one = f.timing->median(), many = m.timing->median();
      if (one < kLeastShared || many - one <= (f.timing->spread() * one + m.timing->spread() * many) / 2) continue;
      if (many / one > worst) worst = many / one, fewer = &f, more = &m;
    }
  if (fewer == nullptr) return {};
  return threads_text(fewer->threads) + (fewer->threads == 1 ? " was" : " were") + " faster than " +
         threads_text(more->threads) + ", " + number(fewer->timing->median(), "%.2f") + " ms and " +
         number(more->timing->median(), "%.2f") + " ms, which is impossible on a quiet machine";
}

}  // namespace trueshade
