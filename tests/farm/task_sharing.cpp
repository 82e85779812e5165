// Tasks shared by ranks that are threads: every order, loss, delay and error gives each result once, in order, or one
// clear error on rank 0; and nobody waits for ever.
#include "farm/task_sharing.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <mutex>
#include <random>
#include <system_error>
#include <thread>

#include "core/error.h"
#include "farm/failures.h"
#include "farm/messages.h"
#include "tests/catch.hpp"
#include "tests/farm/local_ranks.h"

namespace trueshade {
namespace {

using namespace std::chrono_literals;
using Bytes = std::vector<uint8_t>;

Bytes result_of(int task) { return Bytes(size_t(task % 7), uint8_t(task * 31)); }

/// What happened on rank 0.
struct Outcome {
  std::vector<int> taken;  // in the order that they were
  std::string error;
  int kind = -1;  // of the Error; 0 of another exception
  SharingReport report;
};

/// What each rank does of a list; all may be changed by a test.
struct Run {
  int tasks = 20;
  SharingRules rules{.lost_after = 5000ms};
  std::function<Bytes(int rank, int task, const Wanted& wanted)> run = [](int, int task, const Wanted&) {
    return result_of(task);
  };
  std::function<void(int rank)> prepare = [](int) {};
  std::function<std::string(int rank)> scene = [](int) { return "the same"; };
  std::function<void(int task)> take = [](int) {};
  bool in_any_order = false;
  std::vector<std::vector<int>> after{};
  std::function<bool(int task)> opens{};
  std::function<void(int task, int because)> leave_out{};
  std::function<Bytes(int task)> brief{};
  std::function<int(int rank)> at_once = [](int) { return 1; };
  std::function<void()> stop{};
  std::function<void()> check{};
};

SharedTasks tasks_of(const Run& how, int rank, Outcome& outcome) {
  how.prepare(rank);
  SharedTasks tasks;
  tasks.count = how.tasks;
  tasks.identity = {{"scene", how.scene(rank)}};
  tasks.run = [&how, rank](int task, std::span<const uint8_t> brief, const Wanted& wanted) {
    if (Bytes(brief.begin(), brief.end()) != (how.brief ? how.brief(task) : Bytes()))
      throw std::runtime_error("another brief");  // as an error, because Catch2 is of one thread
    return how.run(rank, task, wanted);
  };
  tasks.take = [&how, &outcome](int task, Bytes result) {
    CHECK(result == result_of(task));
    how.take(task);
    outcome.taken.push_back(task);
  };
  tasks.in_any_order = how.in_any_order;
  tasks.after = how.after, tasks.opens = how.opens, tasks.leave_out = how.leave_out;
  tasks.brief = how.brief, tasks.stop = how.stop, tasks.at_once = how.at_once(rank), tasks.check = how.check;
  return tasks;
}

Outcome shared_by(LocalNetwork& network, int rank, const Run& how) {
  Outcome outcome;
  try {
    outcome.report = share_tasks(network.rank(rank), how.rules, [&] { return tasks_of(how, rank, outcome); });
  } catch (const Error& error) {
    outcome.error = error.what(), outcome.kind = int(error.kind());
  } catch (const std::exception& error) {
    outcome.error = error.what(), outcome.kind = 0;
  }
  return outcome;
}

/// What rank 0 saw, once all ranks are through.
Outcome shared(LocalNetwork& network, const Run& how) {
  std::vector<std::thread> others;
  for (int rank = 1; rank < network.count(); ++rank)
    others.emplace_back([&network, &how, rank] { shared_by(network, rank, how); });
  Outcome outcome = shared_by(network, 0, how);
  for (std::thread& other : others) other.join();
  return outcome;
}

Outcome shared(int ranks, const Run& how) {
  LocalNetwork network(ranks);
  return shared(network, how);
}

std::vector<int> all_tasks(int count) {
  std::vector<int> tasks;
  for (int task = 0; task < count; ++task) tasks.push_back(task);
  return tasks;
}

/// Sleeps in steps, as a long task that looks whether it is wanted.
void work_for(std::chrono::milliseconds time, const Wanted& wanted) {
  for (; time > 0ms; time -= 5ms) {
    wanted.check();
    std::this_thread::sleep_for(5ms);
  }
}

TEST_CASE("1 to 8 ranks give every result once and in order, of none, of one and of many tasks") {
  for (int ranks = 1; ranks <= 8; ++ranks)
    for (const int tasks : {0, 1, 2, 100}) {
      INFO(ranks << " ranks, " << tasks << " tasks");
      const Outcome outcome = shared(ranks, {.tasks = tasks});
      CHECK(outcome.error.empty());
      CHECK(outcome.taken == all_tasks(tasks));
      int counted = 0;
      for (const int of_rank : outcome.report.tasks_of_rank) counted += of_rank;
      CHECK(counted == tasks);
    }
}

TEST_CASE("results that come in any order are taken in order, or as they come where that is asked for") {
  Run run{.tasks = 60};
  run.run = [](int rank, int task, const Wanted&) {
    std::this_thread::sleep_for(std::chrono::microseconds((task * 7919 + rank * 104729) % 3000));
    return result_of(task);
  };
  CHECK(shared(4, run).taken == all_tasks(60));
  run.in_any_order = true;
  std::vector<int> taken = shared(4, run).taken;
  std::sort(taken.begin(), taken.end());
  CHECK(taken == all_tasks(60));
}

TEST_CASE("no more results wait than the window has room for") {
  std::atomic<int> begun{0}, taken{0}, most{0};
  Run run{.tasks = 80};
  run.rules.window = 6;
  run.run = [&](int, int task, const Wanted&) {
    most = std::max(most.load(), ++begun - taken.load());
    if (task == 0) std::this_thread::sleep_for(50ms);
    return result_of(task);
  };
  run.take = [&](int) { ++taken; };
  CHECK(shared(4, run).taken == all_tasks(80));
  CHECK(most <= 6 + 4);  // each rank may have begun one more before it counted
}

TEST_CASE("several lists follow each other, though ranks are through at different times") {
  LocalNetwork network(4);
  network.delay(2, 20ms);
  const Run run{.tasks = 12};
  std::vector<std::thread> others;
  for (int rank = 1; rank < 4; ++rank)
    others.emplace_back([&network, &run, rank] {
      for (int round = 0; round < 4; ++round) shared_by(network, rank, run);
    });
  for (int round = 0; round < 4; ++round) CHECK(shared_by(network, 0, run).taken == all_tasks(12));
  for (std::thread& other : others) other.join();
}

/// Ten tasks in three chains, and what was seen of them.
struct Chains {
  Run run{.tasks = 10};
  std::mutex mutex;
  std::vector<bool> taken = std::vector<bool>(10);
  std::vector<std::pair<int, int>> left_out;
  int too_early = 0;

  Chains() {
    run.in_any_order = true;
    run.after = {{}, {0}, {1}, {}, {3}, {3, 0}, {4, 5}, {}, {7, 6}, {2}};
    run.run = [this](int, int task, const Wanted& wanted) {
      {
        const std::lock_guard lock(mutex);
        for (const int other : run.after[size_t(task)]) too_early += !taken[size_t(other)];
      }
      work_for(5ms, wanted);
      return result_of(task);
    };
    run.take = [this](int task) {
      const std::lock_guard lock(mutex);
      taken[size_t(task)] = true;
    };
    run.leave_out = [this](int task, int because) { left_out.emplace_back(task, because); };
  }
};

TEST_CASE("a task begins when the results of those that it is after are taken") {
  for (int ranks = 1; ranks <= 4; ++ranks)
    for (const int at_once : {1, 3}) {
      Chains chains;
      chains.run.at_once = [at_once](int) { return at_once; };
      const Outcome outcome = shared(ranks, chains.run);
      INFO(ranks << " ranks, " << at_once << " at once: " << outcome.error);
      CHECK(outcome.taken.size() == 10);
      CHECK(chains.too_early == 0);
      CHECK(chains.left_out.empty());
    }
}

TEST_CASE("what is after a task that closes is left out, once, and the rest is done") {
  for (int ranks = 1; ranks <= 3; ++ranks) {
    Chains chains;
    chains.run.opens = [](int task) { return task != 3; };
    Outcome outcome = shared(ranks, chains.run);
    std::sort(outcome.taken.begin(), outcome.taken.end());
    CHECK(outcome.taken == std::vector<int>{0, 1, 2, 3, 7, 9});
    CHECK(chains.left_out == std::vector<std::pair<int, int>>{{4, 3}, {5, 3}, {6, 4}, {8, 6}});
    CHECK(chains.too_early == 0);
  }
}

TEST_CASE("tasks that wait for those of a lost rank are done once these are done by others") {
  LocalNetwork network(3);
  Chains chains;
  chains.run.rules.continue_without_lost = true;
  const auto run = chains.run.run;
  chains.run.run = [&](int rank, int task, const Wanted& wanted) {
    if (rank == 1 && task != 0) network.lose(1, true);
    return run(rank, task, wanted);
  };
  const Outcome outcome = shared(network, chains.run);
  CHECK(outcome.error.empty());
  CHECK(outcome.taken.size() == 10);
  CHECK(chains.too_early == 0);
}

TEST_CASE("each rank does as many tasks at a time as it says") {
  std::atomic<int> at_work[3]{}, most[3]{};
  Run run{.tasks = 60, .in_any_order = true};
  run.rules.ahead = 0;
  run.at_once = [](int rank) { return 1 + 2 * rank; };
  run.run = [&](int rank, int task, const Wanted& wanted) {
    const int now = ++at_work[rank];
    for (int seen = most[rank]; now > seen && !most[rank].compare_exchange_weak(seen, now);) {
    }
    work_for(10ms, wanted);
    --at_work[rank];
    return result_of(task);
  };
  CHECK(shared(3, run).taken.size() == 60);
  for (int rank = 0; rank < 3; ++rank) CHECK(most[rank] == 1 + 2 * rank);
}

TEST_CASE("a brief of rank 0 comes with its task, and ranks beyond those that are asked for get none") {
  Run run{.tasks = 40};
  run.brief = [](int task) { return Bytes(3, uint8_t(task)); };
  run.rules.ranks = 2;
  const Outcome outcome = shared(4, run);  // tasks_of() compares the briefs
  CHECK(outcome.error.empty());
  CHECK(outcome.taken == all_tasks(40));
  CHECK(outcome.report.tasks_of_rank[2] + outcome.report.tasks_of_rank[3] == 0);
}

TEST_CASE("tasks that cannot look whether they are wanted are stopped, once a rank, when the run fails") {
  std::atomic<int> stops{0};
  Run run;
  run.at_once = [](int) { return 2; };
  run.run = [&](int rank, int task, const Wanted&) -> Bytes {
    if (rank == 0 && task > 1) throw Error(ErrorKind::limit, "a", "b", "c");
    for (int i = 0; i < 2000 && task > 1 && stops == 0; ++i) std::this_thread::sleep_for(5ms);
    return result_of(task);
  };
  run.stop = [&] { ++stops; };
  const auto begin = std::chrono::steady_clock::now();
  CHECK(shared(2, run).error == "a: b (c)");
  CHECK(stops == 2);
  CHECK(std::chrono::steady_clock::now() - begin < 5000ms);
}

TEST_CASE("what rank 0 checks ends the run, whether it works, waits for others or is alone") {
  for (const int ranks : {1, 3})
    for (const bool rank_0_works : {true, false}) {
      if (ranks == 1 && !rank_0_works) continue;
      std::atomic<bool> ends{false};
      Run run{.tasks = 200};
      run.rules.slow_after = 60000ms;
      run.run = [&](int rank, int task, const Wanted& wanted) {
        if (task == 5) ends = true;
        for (int i = 0; i < 400 && (rank != 0) != rank_0_works && task > 5; ++i) work_for(10ms, wanted);
        return result_of(task);
      };
      run.check = [&] {
        if (ends) throw Error(ErrorKind::io, "a", "signal", "c");
      };
      const auto begin = std::chrono::steady_clock::now();
      CHECK(shared(ranks, run).error == "a: signal (c)");
      CHECK(std::chrono::steady_clock::now() - begin < 3000ms);
    }
}

TEST_CASE("a run that fails is the last, and one that does not is followed, whoever was left out") {
  for (const bool fails : {false, true}) {
    LocalNetwork network(3);
    std::atomic<int> rounds[3]{};
    const auto go_on = [&](int rank) {
      Run run{.tasks = 9};
      run.rules.continue_without_lost = true;
      run.prepare = [rank](int) {
        if (rank == 2) throw std::runtime_error("no such scene");
      };
      run.run = [fails](int rank_at_work, int task, const Wanted& wanted) {
        work_for(5ms, wanted);
        if (fails && rank_at_work == 0 && task > 2) throw Error(ErrorKind::io, "a", "b", "c");
        return result_of(task);
      };
      size_t notes = 0;
      bool goes_on = true;
      while (goes_on) {
        const int round = rounds[rank]++;
        Outcome outcome;
        try {
          outcome.report = share_tasks(network.rank(rank), run.rules, [&] {
            SharedTasks tasks = tasks_of(run, rank, outcome);
            tasks.is_last = round == 3;
            return tasks;
          });
        } catch (const Error&) {
        }
        notes += outcome.report.lost.size();
        goes_on = outcome.report.goes_on;
      }
      return notes;
    };
    std::vector<std::thread> others;
    for (const int rank : {1, 2}) others.emplace_back([&go_on, rank] { go_on(rank); });
    const size_t notes = go_on(0);
    for (std::thread& other : others) other.join();
    CHECK(rounds[0] == (fails ? 1 : 4));
    for (const int rank : {1, 2}) CHECK(rounds[rank] == rounds[0]);
    if (!fails) CHECK(notes == 1);
  }
}

TEST_CASE("a rank that is lost at any task ends the run in one error that names it, and what was taken stays") {
  for (const bool is_seen : {true, false})
    for (int at = is_seen ? 0 : 9; at < (is_seen ? 20 : 10); at += 3) {
      INFO("lost at task " << at);
      LocalNetwork network(3);
      Run run;
      run.rules.lost_after = is_seen ? 5000ms : 600ms;
      std::atomic<int> gone{-1};
      run.run = [&](int rank, int task, const Wanted& wanted) {
        int nobody = -1;
        if (rank != 0 && task >= at && gone.compare_exchange_strong(nobody, rank)) network.lose(rank, is_seen);
        work_for(rank == 0 ? 20ms : 5ms, wanted);  // so that others get their share
        return result_of(task);
      };
      const Outcome outcome = shared(network, run);
      REQUIRE(gone >= 0);
      if (outcome.taken.size() == 20) continue;  // it had sent all that was asked of it
      CHECK(outcome.kind == int(ErrorKind::io));
      CHECK(outcome.error.starts_with("rank " + std::to_string(gone) + " on host" + std::to_string(gone) + ": "));
      CHECK(outcome.taken == all_tasks(int(outcome.taken.size())));
    }
}

TEST_CASE("without lost ranks the run goes on to the end, whoever is lost, and whenever") {
  for (const int lost_ranks : {1, 2, 3})
    for (const bool is_seen : {true, false})
      for (int at = is_seen ? 0 : 6; at < (is_seen ? 20 : 7); at += 6) {
        LocalNetwork network(4);
        Run run;
        run.rules.lost_after = is_seen ? 5000ms : 600ms;
        run.rules.continue_without_lost = true;
        std::atomic<int> gone{0};
        run.run = [&](int rank, int task, const Wanted& wanted) {
          if (rank != 0 && task >= at && gone < lost_ranks && !network.is_lost(rank))
            ++gone, network.lose(rank, is_seen);
          work_for(10ms, wanted);
          return result_of(task);
        };
        const Outcome outcome = shared(network, run);
        INFO(outcome.error);
        CHECK(outcome.taken == all_tasks(20));
        CHECK(int(outcome.report.lost.size()) <= gone);
      }
}

TEST_CASE("a slow rank's tasks are done again by idle ones, and a slow network only takes time") {
  Run run{.tasks = 8};
  run.rules.slow_after = 40ms;
  std::atomic<bool> slow_one_works{false};
  run.run = [&](int rank, int task, const Wanted& wanted) {
    if (rank == 1) slow_one_works = true;
    while (!slow_one_works) work_for(5ms, wanted);
    work_for(rank == 1 ? 4000ms : 5ms, wanted);
    return result_of(task);
  };
  const auto begin = std::chrono::steady_clock::now();
  const Outcome outcome = shared(3, run);
  CHECK(outcome.taken == all_tasks(8));
  CHECK(outcome.report.handed_out_twice > 0);
  CHECK(std::chrono::steady_clock::now() - begin < 3000ms);

  LocalNetwork far(3);
  far.delay(1, 100ms);
  CHECK(shared(far, {}).taken == all_tasks(20));
}

TEST_CASE("a second result that differs is an error, whichever comes first") {
  LocalNetwork network(3);
  Run run{.tasks = 3};
  run.rules.slow_after = 20ms;
  run.take = [](int) {};
  std::atomic<int> calls{0};
  run.run = [&](int, int task, const Wanted&) -> Bytes {
    if (task != 0) {
      std::this_thread::sleep_for(task == 2 ? 600ms : 1ms);
      return result_of(task);
    }
    const int call = calls++;
    std::this_thread::sleep_for(call == 0 ? 200ms : 100ms);
    return call == 0 ? result_of(0) : Bytes{1, 2, 3};
  };
  Outcome outcome;
  run.take = [](int) {};
  // The wrong one may be taken first: then the right one is what differs.
  std::vector<std::thread> others;
  const auto one = [&](int rank) {
    Outcome seen;
    try {
      share_tasks(network.rank(rank), run.rules, [&] {
        SharedTasks tasks = tasks_of(run, rank, seen);
        tasks.take = [](int, Bytes) {};
        return tasks;
      });
    } catch (const std::exception& error) {
      seen.error = error.what();
    }
    return seen;
  };
  for (const int rank : {1, 2}) others.emplace_back([&one, rank] { one(rank); });
  outcome = one(0);
  for (std::thread& other : others) other.join();
  CHECK_THAT(outcome.error, Catch::Contains("task 0 has another result"));
}

TEST_CASE("an error of a task, of making the tasks and of taking a result ends the run with its text and kind") {
  Run run;
  run.run = [](int rank, int task, const Wanted& wanted) {
    if (rank == 2)
      throw Error(ErrorKind::limit, "roof.gltf: mesh 3", "too many (of (these))", "ask for less (or (so))");
    work_for(10ms, wanted);
    return result_of(task);
  };
  Outcome outcome = shared(3, run);
  CHECK(outcome.kind == int(ErrorKind::limit));
  CHECK(outcome.error == "rank 2 on host2: roof.gltf: mesh 3: too many (of (these)) (ask for less (or (so)))");

  run = {};
  run.prepare = [](int rank) {
    if (rank == 1) throw std::runtime_error("no such thing");
  };
  run.run = [](int, int task, const Wanted& wanted) {
    work_for(20ms, wanted);
    return result_of(task);
  };
  outcome = shared(3, run);
  CHECK(outcome.kind == 0);
  CHECK(outcome.error == "rank 1 on host1: no such thing");

  run.prepare = [](int) { throw Error(ErrorKind::bad_input, "scene.json", "is none", "name one"); };
  CHECK(shared(3, run).error == "scene.json: is none (name one)");  // rank 0's own, without a rank

  run = {};
  run.take = [](int task) {
    if (task == 7) throw Error(ErrorKind::io, "out.png", "the disk is full", "free some space");
  };
  outcome = shared(4, run);
  CHECK(outcome.kind == int(ErrorKind::io));
  CHECK(outcome.taken == all_tasks(7));

  run = {};
  run.run = [](int, int, const Wanted&) -> Bytes { throw Error(ErrorKind::io, "a", "b", "c"); };
  CHECK_THAT(shared(1, run).error, Catch::Contains("a: b (c)"));
  run.rules.continue_without_lost = true;  // where all fail, rank 0 does too
  CHECK_THAT(shared(3, run).error, Catch::Contains("a: b (c)"));
}

TEST_CASE("a rank with another scene ends the run before it works, or is left out where that is asked for") {
  std::atomic<int> worked{0};
  Run run;
  run.scene = [](int rank) { return rank == 1 ? std::string(100, 'b') : "the same"; };
  run.run = [&](int rank, int task, const Wanted& wanted) {
    if (rank == 1) ++worked;
    work_for(10ms, wanted);
    return result_of(task);
  };
  Outcome outcome = shared(3, run);
  CHECK(outcome.kind == int(ErrorKind::bad_input));
  CHECK_THAT(outcome.error, Catch::StartsWith("rank 1 on host1: its scene is 'bbbb") &&
                                Catch::Contains("bbb...', and the scene of rank 0 is 'the same'"));
  run.rules.continue_without_lost = true;
  outcome = shared(3, run);
  CHECK(outcome.taken == all_tasks(20));
  CHECK(outcome.report.lost.size() == 1);
  CHECK(worked == 0);
}

TEST_CASE("a rank of another version, whose messages are of another form, is told from the others") {
  LocalNetwork network(2);
  network.on_the_way = [](int from, int, Bytes& bytes) {
    if (from == 1) bytes[0] ^= 1;
  };
  Run run;
  run.rules.lost_after = 1000ms;
  run.run = [](int, int task, const Wanted& wanted) {
    work_for(20ms, wanted);
    return result_of(task);
  };
  const Outcome outcome = shared(network, run);
  CHECK(outcome.kind == int(ErrorKind::bad_input));
  CHECK_THAT(outcome.error, Catch::Contains("rank 1 on host1: its messages are of another version"));
}

TEST_CASE("where rank 0 is lost the others end with an error") {
  for (const bool is_seen : {true, false}) {
    LocalNetwork network(3);
    network.lose(0, is_seen);
    Run run;
    run.rules.lost_after = is_seen ? 5000ms : 250ms;
    std::array<std::string, 2> errors;  // Catch's checks are for one thread at a time
    std::vector<std::thread> others;
    for (const int rank : {1, 2})
      others.emplace_back([&, rank] { errors[size_t(rank - 1)] = shared_by(network, rank, run).error; });
    for (std::thread& other : others) other.join();
    for (const std::string& error : errors) CHECK_THAT(error, Catch::StartsWith("rank 0 on host0: it is lost"));
  }
}

TEST_CASE("messages come back as they were, and bytes that are none are told") {
  const RankSays says{.what = RankSays::What::hello,
                      .round = 3,
                      .number = -1,
                      .kind = 4,
                      .numbers = {1, 2},
                      .words = {"", "a\0b"},
                      .bytes = {0, 255}};
  const Bytes bytes = packed(says);
  const std::optional<RankSays> back = unpacked(bytes);
  REQUIRE(back);
  CHECK(packed(*back) == bytes);
  for (size_t size = 0; size < bytes.size(); ++size) CHECK_FALSE(unpacked(std::span(bytes).first(size)));
  Bytes longer = bytes, of_another_version = bytes;
  longer.push_back(0);
  of_another_version[3] ^= 3;  // the digit of `TRs2`
  CHECK_FALSE(unpacked(longer));
  CHECK_FALSE(unpacked(of_another_version));
  std::mt19937 random(5);
  for (int i = 0; i < 20000; ++i) {
    Bytes hostile = bytes;
    for (int change = 0; change < 3; ++change) hostile[random() % hostile.size()] = uint8_t(random());
    if (const auto read = unpacked(hostile)) CHECK(packed(*read).size() == hostile.size());
  }
}

TEST_CASE("A rank that has no more threads says so, and is out of memory") {
  const auto kind_of = [](std::errc error) {
    return failure_text(std::make_exception_ptr(std::system_error(std::make_error_code(error)))).kind;
  };
  CHECK(kind_of(std::errc::resource_unavailable_try_again) == int32_t(ErrorKind::out_of_memory));
  CHECK(kind_of(std::errc::no_such_file_or_directory) == 0);
}

}  // namespace
}  // namespace trueshade
