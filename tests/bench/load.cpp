// How busy a machine is, by texts of Linux that are known, and when figures are not to be quoted.
#include "bench/load.h"

#include <atomic>
#include <chrono>
#include <fstream>
#include <thread>
#include <vector>

#include "bench/machine.h"
#include "tests/catch.hpp"
#include "tests/scratch_folder.h"

namespace trueshade {
namespace {

constexpr const char* kStat =
    "cpu  1000 200 300 9000 40 5 15 60 7 0\n"
    "cpu0 600 100 200 4000 20 5 10 50 7 0\n"
    "cpu1 400 100 100 5000 20 0 5 10 0 0\n"
    "intr 123 4\nctxt 5\n";

/// Samples of two CPUs, `seconds` apart.
Load load_of(double seconds, double busy_s, double own_s, double stolen_s = 0, double held_back_s = 0) {
  LoadSample from, to;
  from.cpus = to.cpus = 2;
  from.times = CpuTimes{100, 10};
  from.held_back_s = 1;
  to.at_s = seconds, to.own_s = own_s;
  to.times = CpuTimes{100 + busy_s, 10 + stolen_s};
  to.held_back_s = 1 + held_back_s;
  return load_between(from, to);
}

Timing timing(std::vector<double> ms) { return {std::move(ms)}; }

}  // namespace

TEST_CASE("CPU time is read of the CPUs that are asked for, and stolen time apart") {
  const std::vector<int> both{0, 1}, second{1}, absent{7};
  const auto all = cpu_times_from_text(kStat, both, 100);
  REQUIRE(all);
  CHECK(all->busy_s == Approx(15.20));  // user, nice, system, irq and softirq
  CHECK(all->stolen_s == Approx(0.60));
  const auto one = cpu_times_from_text(kStat, second, 100);
  REQUIRE(one);
  CHECK(one->busy_s == Approx(6.05));
  CHECK(one->stolen_s == Approx(0.10));
  CHECK_FALSE(cpu_times_from_text(kStat, absent, 100));
  CHECK_FALSE(cpu_times_from_text("", both, 100));
  CHECK_FALSE(cpu_times_from_text("cpu0 what\n", both, 100));
}

TEST_CASE("Pressure, a limit's delays and load averages are read, and are nothing where they are not there") {
  CHECK(waited_s_from_text("some avg10=1.50 avg60=0.40 avg300=0.10 total=2500000\nfull avg10=0 total=7\n").value() ==
        Approx(2.5));
  CHECK_FALSE(waited_s_from_text(""));
  CHECK_FALSE(waited_s_from_text("full avg10=0.00 total=7\n"));
  CHECK(held_back_s_from_text("usage_usec 9\nnr_throttled 3\nthrottled_usec 1500000\n").value() == Approx(1.5));
  CHECK_FALSE(held_back_s_from_text("usage_usec 9\nuser_usec 8\n"));
  CHECK(load_average_from_text("1.25 0.50 0.05 2/90 4711\n").value()[1] == 0.5);
  CHECK_FALSE(load_average_from_text("1.25 none"));
}

TEST_CASE("What others use is what is busy but for this process, less the ticks of counting") {
  const Load load = load_of(10, 18, 9);
  CHECK(load.is_known);
  CHECK(load.own == Approx(0.9));
  CHECK(load.others == Approx((18 - 9 - 0.02) / 10));
  CHECK(load_reasons(load, "while this ran") ==
        std::vector<std::string>{"other programs used 0.9 of 2 cores while this ran"});
  CHECK(load_reasons(load_of(10, 9.5, 9), "while this ran").empty());  // 0.048 cores
  CHECK(load_reasons(load_of(10, 9.9, 9), "while this ran").empty());  // 0.088 of 2: less than a twentieth
  CHECK(load_reasons(load_of(10, 10.2, 9), "while this ran").size() == 1);
  CHECK(load_of(0.1, 0.11, 0.1).others == 0.0);  // a tick
}

TEST_CASE("A host that takes time, a limit, and counters that stand still are said each in a sentence") {
  CHECK(load_reasons(load_of(10, 9, 9, 3), "while this ran") ==
        std::vector<std::string>{"the host of this virtual machine took 0.3 of 2 cores while this ran"});
  CHECK(
      load_reasons(load_of(10, 12, 9, 3), "while this ran") ==
      std::vector<std::string>{"other programs used 0.3 of 2 cores and the host of this virtual machine took 0.3 of 2 "
                               "cores while this ran"});
  // Neither is over the limit, and both are.
  CHECK(load_reasons(load_of(10, 9.8, 9, 0.6), "while this ran").size() == 1);
  CHECK(load_reasons(load_of(10, 9, 9, 0, 2.5), "while this ran") ==
        std::vector<std::string>{"a limit of CPU time held this process back for 25 % of the time while this ran"});
  CHECK(load_reasons(load_of(10, 0, 9), "before this ran") ==
        std::vector<std::string>{"this system does not say what others used before this ran"});
  LoadSample from, to;
  from.cpus = to.cpus = 2, to.at_s = 1;
  CHECK_FALSE(load_between(from, to).is_known);
}

TEST_CASE("A clock that changes, frames that spread or are few, and one thread that beats two are named") {
  CHECK(clock_reason(std::vector<double>{3.5, 3.4}).empty());
  CHECK(clock_reason(std::vector<double>{3.52, 2.86, 3.4}) ==
        "the clock was measured at 2.86 to 3.52 GHz while this ran");
  const Timing even = timing({10, 10, 10.2, 10.4}), wide = timing({10, 11, 12, 30}), wider = timing({1, 1, 2, 20});
  CHECK(spread_reason(std::vector<NamedTiming>{{"a", &even}}).empty());
  CHECK(
      spread_reason(std::vector<NamedTiming>{{"a", &even}, {"b", &wide}, {"c", &wider}}) ==
      "the middle half of the frames of c spreads over 950 % of their median, where 10.0 % is the limit; 1 other is over "
      "it too");
  const Timing once = timing({10}), enough = timing({1, 1, 1, 1, 1});
  CHECK(frames_reason(std::vector<NamedTiming>{{"a", &enough}, {"b", &once}}) ==
        "b was timed for 1 frame, where 5 are the least");
  CHECK(frames_reason(std::vector<NamedTiming>{{"a", &enough}}).empty());
  const Timing slower = timing({11, 11, 11.3, 11.4}), small = timing({0.1, 0.1, 0.1, 0.1}),
               large = timing({0.5, 0.5, 0.5, 0.5});
  CHECK(threads_reason(std::vector<NamedTiming>{{"two", &slower, 2}, {"one", &even, 1}}, 2) ==
        "1 thread was faster than 2 threads, 10.20 ms and 11.30 ms, which is impossible on a quiet machine");
  CHECK(threads_reason(std::vector<NamedTiming>{{"two", &even, 2}, {"one", &slower, 1}}, 2).empty());
  CHECK(threads_reason(std::vector<NamedTiming>{{"two", &wide, 2}, {"one", &slower, 1}}, 2).empty());   // by the spread
  CHECK(threads_reason(std::vector<NamedTiming>{{"four", &slower, 4}, {"one", &even, 1}}, 2).empty());  // of two cores
  CHECK(threads_reason(std::vector<NamedTiming>{{"two", &large, 2}, {"one", &small, 1}}, 2).empty());   // starting them
}

TEST_CASE("What threads of this process use is its own, and is not said to be another program's") {
  std::atomic<bool> stop{false};
  const LoadSample from = load_sample();
  std::vector<std::thread> spinning;
  for (int i = 0; i < from.cpus; ++i)
    spinning.emplace_back([&stop] {
      while (!stop) {
      }
    });
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  stop = true;
  for (std::thread& thread : spinning) thread.join();
  const Load load = load_between(from, load_sample());
  CHECK(load.cpus >= 1);
  CHECK(load.own > 0.01);  // however busy the machine is
  CHECK(load.own + load.others + load.stolen < load.cpus * 1.05);
}

TEST_CASE("What /proc/cpuinfo says of x86 and ARM is read") {
  const CpuIdentity x86 = cpu_from_text(
      "processor\t: 0\nvendor_id\t: AuthenticAMD\ncpu family\t: 25\nmodel\t\t: 17\nmodel name\t: AMD EPYC\n"
      "stepping\t: 1\nphysical id\t: 0\ncore id\t\t: 0\nflags\t\t: fpu hypervisor avx2\n\n"
      "processor\t: 1\nvendor_id\t: AuthenticAMD\nmodel name\t: other\nphysical id\t: 0\ncore id\t\t: 0\n\n"
      "processor\t: 2\nphysical id\t: 0\ncore id\t\t: 1\n\nprocessor\t: 3\nphysical id\t: 1\ncore id\t\t: 1\n");
  CHECK(x86.name == "AMD EPYC");
  CHECK(x86.vendor == "AuthenticAMD");
  CHECK(x86.family == 25);
  CHECK(x86.model == 17);
  CHECK(x86.stepping == 1);
  CHECK(x86.threads == 4);
  CHECK(x86.cores == 3);
  CHECK(x86.is_virtual);
  const CpuIdentity arm = cpu_from_text(
      "processor\t: 0\nBogoMIPS\t: 50.00\nFeatures\t: fp asimd\nCPU implementer\t: 0x41\nCPU architecture: 8\n"
      "CPU variant\t: 0x3\nCPU part\t: 0xd0c\nCPU revision\t: 1\n");
  CHECK(arm.vendor == "0x41");
  CHECK(arm.model == 0xd0c);
  CHECK(arm.threads == 1);
  CHECK_FALSE(arm.is_virtual);
  CHECK(cpu_from_text("").name == "unknown CPU");
}

TEST_CASE("Caches that CPUs share are counted once, and those that are alike together") {
  const ScratchFolder folder;
  const auto cache = [&folder](int cpu, int index, const char* level, const char* type, const char* size,
                               const char* shared) {
    const std::filesystem::path place =
        folder.path("cpu" + std::to_string(cpu) + "/cache/index" + std::to_string(index));
    std::filesystem::create_directories(place);
    for (const auto& [name, text] :
         {std::pair{"level", level}, {"type", type}, {"size", size}, {"shared_cpu_list", shared}})
      std::ofstream(place / name) << text << '\n';
  };
  cache(0, 0, "1", "Data", "48K", "0"), cache(1, 0, "1", "Data", "32K", "1"), cache(2, 0, "1", "Data", "32K", "2");
  for (const int cpu : {0, 1, 2}) cache(cpu, 1, "3", "Unified", "32768K", "0-2");
  const std::vector<Cache> caches = caches_under(folder.path(""));
  REQUIRE(caches.size() == 3);
  CHECK(caches[0].kib == 48);
  CHECK(caches[1].level == 3);
  CHECK(caches[1].kib == 32768);
  CHECK(caches[1].count == 1);
  CHECK(caches[2].kib == 32);
  CHECK(caches[2].count == 2);
  CHECK(caches_under(folder.path("absent")).empty());
}

}  // namespace trueshade
