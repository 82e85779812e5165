#include "bench/farm_model.h"

#include <algorithm>
#include <chrono>
#include <deque>
#include <queue>
#include <vector>

#include "farm/hand_out.h"
#include "farm/task_sharing.h"

namespace trueshade {
namespace {

using Clock = HandOut::Clock;

/// A run, an event at a time.
class Simulation {
 public:
  Simulation(std::span<const TaskCost> tasks, int machines, int cores, const Network& network)
      : tasks_(tasks),
        cores_(cores),
        network_(network),
        hand_out_({int(tasks.size()), machines, 0, HandOut::kNever, false}, {}),
        machines_(size_t(machines)),
        arrived_(tasks.size(), false) {
    for (int machine = 0; machine < machines; ++machine) hand_out_.let_have(machine, 1, SharingRules().ahead);
  }

  FarmEstimate run() {
    hand_out();
    while (!events_.empty()) {
      const Event event = events_.top();
      events_.pop();
      now_ = event.at;
      (this->*event.happens)(event);
    }
    result_.seconds = now_;
    for (const Machine& machine : machines_) result_.busiest_s = std::max(result_.busiest_s, machine.drawing_s);
    return result_;
  }

 private:
  struct Event {
    double at;
    void (Simulation::*happens)(const Event&);
    int machine, task;
    bool operator<(const Event& other) const { return at > other.at; }  // the soonest is on top
  };
  struct Machine {
    std::deque<int> waiting;
    bool draws = false;
    double drawing_s = 0;
    double late_s = 0;  // that taking has cost since it began to draw
  };

  void hand_out() {
    for (int machine = 1; machine < int(machines_.size()); ++machine)
      while (const auto task = hand_out_.next_for(machine, Clock::time_point{}))
        events_.push({now_ + message_s(0), &Simulation::gets, machine, *task});
    Machine& own = machines_[0];  // rank 0 takes a task of its own when it has none
    if (own.draws || !own.waiting.empty()) return;
    if (const auto task = hand_out_.next_for(0, Clock::time_point{})) {
      own.waiting.push_back(*task);
      begin(0);
    }
  }

  double message_s(uint64_t bytes) const {
    return network_.latency_s + network_.look_s + double(bytes) / network_.bytes_per_s;
  }

  void gets(const Event& event) {
    machines_[size_t(event.machine)].waiting.push_back(event.task);
    begin(event.machine);
  }

  void begin(int number) {
    Machine& machine = machines_[size_t(number)];
    if (machine.draws || machine.waiting.empty()) return;
    const int task = machine.waiting.front();
    machine.waiting.pop_front();
    machine.draws = true;
    machine.late_s = number == 0 && takes_ ? (taken_at_ - now_) / cores_ : 0.0;
    machine.drawing_s += tasks_[size_t(task)].draw_s;
    events_.push({now_ + tasks_[size_t(task)].draw_s, &Simulation::has_drawn, number, task});
  }

  void has_drawn(const Event& event) {
    Machine& machine = machines_[size_t(event.machine)];
    if (machine.late_s > 0) {
      events_.push({now_ + std::exchange(machine.late_s, 0.0), &Simulation::has_drawn, event.machine, event.task});
      return;
    }
    machine.draws = false;
    if (event.machine == 0) {
      arrives(event);
    } else {  // the link of rank 0 takes one message after the other
      const uint64_t bytes = tasks_[size_t(event.task)].bytes;
      const double receiving = double(bytes) / network_.bytes_per_s;
      link_free_ = std::max(link_free_, now_ + message_s(0)) + receiving;
      result_.receiving_s += receiving;
      events_.push({link_free_, &Simulation::arrives, event.machine, event.task});
    }
    begin(event.machine);
  }

  void arrives(const Event& event) {
    hand_out_.came(event.task, event.machine, Clock::time_point{});
    arrived_[size_t(event.task)] = true;
    hand_out();
    take();
  }

  /// The next result of the order, if it is there and rank 0 is at no other.
  void take() {
    const int next = hand_out_.first_untaken();
    if (takes_ || next == int(tasks_.size()) || !arrived_[size_t(next)]) return;
    takes_ = true;
    const double seconds = tasks_[size_t(next)].take_s;
    result_.taking_s += seconds;
    taken_at_ = now_ + seconds;
    if (machines_[0].draws) machines_[0].late_s += seconds / cores_;
    events_.push({taken_at_, &Simulation::has_taken, 0, next});
  }

  void has_taken(const Event& event) {
    takes_ = false;
    hand_out_.taken(event.task);
    hand_out();
    take();
  }

  const std::span<const TaskCost> tasks_;
  const int cores_;
  const Network network_;
  HandOut hand_out_;
  std::vector<Machine> machines_;
  std::vector<bool> arrived_;
  std::priority_queue<Event> events_;
  double now_ = 0, link_free_ = 0, taken_at_ = 0;
  bool takes_ = false;
  FarmEstimate result_;
};

}  // namespace

FarmEstimate farm_estimate(std::span<const TaskCost> tasks, int machines, int cores, const Network& network) {
  return Simulation(tasks, machines, cores, network).run();
}

}  // namespace trueshade
