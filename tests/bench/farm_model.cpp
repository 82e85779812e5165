// The model of `bench --ranks` against sums that are known, against bounds that no run can beat, and against runs of
// share_tasks() whose tasks sleep.
#include "bench/farm_model.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <random>
#include <thread>
#include <vector>

#include "farm/task_sharing.h"
#include "tests/catch.hpp"
#include "tests/farm/local_ranks.h"

namespace trueshade {
namespace {

constexpr Network kAtOnce{1e30, 0.0, 0.0};

std::vector<TaskCost> alike(int count, double draw_s, uint64_t bytes = 0, double take_s = 0) {
  return std::vector<TaskCost>(size_t(count), {draw_s, bytes, take_s});
}

std::vector<TaskCost> random_tasks(int count, uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> draw(0.001, 0.2), take(0.0, 0.01);
  std::vector<TaskCost> tasks;
  for (int i = 0; i < count; ++i) tasks.push_back({draw(random), uint64_t(random() % 50000000), take(random)});
  return tasks;
}

TEST_CASE("without messages and taking, alike tasks take as many rounds as they are deep") {
  for (const int machines : {1, 2, 3, 4, 16, 100})
    for (const int tasks : {1, 7, 64, 1000}) {
      INFO(machines << " machines, " << tasks << " tasks");
      const double rounds = std::ceil(double(tasks) / machines);
      CHECK(farm_estimate(alike(tasks, 0.5), machines, 4, kAtOnce).seconds == Approx(0.5 * rounds));
    }
}

TEST_CASE("where taking is all, machines do not help, and a lone core draws later by it") {
  for (const int machines : {1, 8, 64}) {
    const FarmEstimate farm = farm_estimate(alike(100, 1e-9, 0, 0.25), machines, 1, kAtOnce);
    CHECK(farm.seconds == Approx(25.0).epsilon(0.01));
    CHECK(farm.taking_s == Approx(25.0));
  }
  // One core draws for 10 s and takes for 5: 15 in all. Of four cores a quarter of the taking is drawing's loss.
  CHECK(farm_estimate(alike(100, 0.1, 0, 0.05), 1, 1, kAtOnce).seconds == Approx(15.0).epsilon(0.02));
  CHECK(farm_estimate(alike(100, 0.1, 0, 0.05), 1, 4, kAtOnce).seconds == Approx(11.25).epsilon(0.02));
}

TEST_CASE("where the link is all, a run takes as long as its bytes") {
  const Network slow{1e6, 0.0, 0.0};
  const FarmEstimate farm = farm_estimate(alike(200, 1e-6, 1000000), 50, 4, slow);
  CHECK(farm.seconds >= farm.receiving_s);
  CHECK(farm.seconds == Approx(farm.receiving_s).epsilon(0.05));
}

TEST_CASE("an estimate is between what no run can beat and what its parts take one after the other") {
  for (uint32_t seed = 0; seed < 20; ++seed) {
    const std::vector<TaskCost> tasks = random_tasks(300, seed);
    double drawing = 0, dearest = 0;
    for (const TaskCost& task : tasks) drawing += task.draw_s, dearest = std::max(dearest, task.draw_s);
    for (const int machines : {1, 4, 16, 64, 256, 1024}) {
      const FarmEstimate farm = farm_estimate(tasks, machines, 8, {});
      INFO("seed " << seed << ", " << machines << " machines");
      CHECK(farm.seconds >= std::max({farm.taking_s, farm.receiving_s, drawing / machines, dearest}));
      CHECK(farm.busiest_s >= drawing / machines * 0.999);
      // A task may wait at a machine while another one is idle, and rank 0 draws later while it takes.
      CHECK(farm.seconds <= farm.taking_s + farm.receiving_s + drawing / machines + 2.5 * dearest);
    }
  }
}

TEST_CASE("a run of ranks that sleep takes what the model says") {
  const int kTasks = 40;
  std::mt19937 random(3);
  std::vector<TaskCost> tasks;
  for (int i = 0; i < kTasks; ++i) tasks.push_back({0.01 + 0.0001 * double(random() % 400), 0, 0.004});
  const auto sleep = [](double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); };
  for (const int ranks : {1, 2, 4}) {
    LocalNetwork network(ranks);
    const auto share = [&](int rank) {
      share_tasks(network.rank(rank), {}, [&] {
        SharedTasks shared;
        shared.count = kTasks;
        shared.run = [&](int task, std::span<const uint8_t>, const Wanted&) {
          sleep(tasks[size_t(task)].draw_s);
          return std::vector<uint8_t>();
        };
        shared.take = [&](int task, const std::vector<uint8_t>&) { sleep(tasks[size_t(task)].take_s); };
        return shared;
      });
    };
    const auto begin = std::chrono::steady_clock::now();
    std::vector<std::thread> others;
    for (int rank = 1; rank < ranks; ++rank) others.emplace_back(share, rank);
    share(0);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    for (std::thread& other : others) other.join();
    const double model = farm_estimate(tasks, ranks, 1 << 20, {}).seconds;
    INFO(ranks << " ranks: " << seconds << " s, by the model " << model);
    CHECK(seconds > 0.95 * model);
    CHECK(seconds < 1.5 * model + 0.3);  // beside other tests, and with the end of the run
  }
}

}  // namespace
}  // namespace trueshade
