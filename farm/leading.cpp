#include "farm/leading.h"

#include <algorithm>
#include <cstdio>
#include <stdexcept>
#include <system_error>

#include "core/error.h"
#include "core/sha256.h"
#include "farm/failures.h"

namespace trueshade {
namespace {

using Clock = HandOut::Clock;
using Milliseconds = std::chrono::milliseconds;

constexpr Milliseconds kLook{50};        // between looks for losses
constexpr Milliseconds kPatience{5000};  // with the others, once the run has failed

const char* const kSameEverywhere = "give every machine the same program and the same files";

/// SHA-256 of the part of a result that must be equal on every rank.
std::string same_hash(const SharedTasks& tasks, std::span<const uint8_t> result) {
  const std::span<const uint8_t> part = tasks.same_part ? tasks.same_part(result) : result;
  Sha256 hash;
  hash.update(part.data(), part.size());
  return hash.hex();
}

/// A value in quotes, cut after 64 characters.
std::string shown(const std::string& value) {
  constexpr size_t kMost = 64;
  return "'" + (value.size() <= kMost ? value : value.substr(0, kMost) + "...") + "'";
}

}  // namespace

Leading::Leading(Ranks& ranks, const SharingRules& rules, uint32_t round)
    : ranks_(ranks), rules_(rules), round_(round), others_(size_t(ranks.count())) {
  for (int rank = 0; rank < ranks_.count(); ++rank) {
    Other& other = others_[size_t(rank)];
    other.heard = Clock::now();
    if (ranks_.is_forgotten(rank))
      other.phase = Phase::lost, other.left = true;
    else if (ranks_.is_excluded(rank))
      other.phase = Phase::left_out;
  }
  report_.tasks_of_rank.resize(others_.size());
  if (ranks_.count() > 1) answering_ = std::thread([this] { answer(); });
}

Leading::~Leading() {
  if (!ending_) end_within(std::min(kPatience, rules_.lost_after), false);
}

void Leading::begin(const SharedTasks& tasks) {
  const Lock lock(mutex_);
  tasks_ = &tasks;
  const int ranks = ranks_.count();
  hand_out_.emplace(HandOut::Rules{tasks.count, ranks, rules_.window, rules_.slow_after, tasks.in_any_order},
                    tasks.after);
  let_have(0, tasks.at_once);
  for (int rank = 1; rank < ranks; ++rank)
    if (others_[size_t(rank)].hello) meet(rank);
  hand_out();
  try {
    for (int i = 0; i < tasks.at_once; ++i) working_.emplace_back([this] { work(); });
  } catch (const std::system_error&) {
    if (working_.empty()) throw;  // else those there are do all of it
  }
}

std::optional<Leading::Result> Leading::next_result() {
  Lock lock(mutex_);
  const auto next = [this] {
    return tasks_->in_any_order ? waiting_.begin() : waiting_.find(hand_out_->first_untaken());
  };
  changed_.wait(lock, [&] { return failure_ || hand_out_->all_taken() || next() != waiting_.end(); });
  const auto found = next();
  if (found != waiting_.end()) {  // what came before a failure is kept
    Result result{found->first, std::move(found->second)};
    waiting_.erase(found);
    return result;
  }
  if (failure_) std::rethrow_exception(failure_);
  return {};
}

void Leading::taken(int task) {
  const bool opens = !tasks_->opens || tasks_->opens(task);
  std::vector<std::pair<int, int>> left_out;
  {
    const Lock lock(mutex_);
    if (opens)
      hand_out_->taken(task);
    else
      left_out = hand_out_->taken_and_closed(task);
    hand_out();
    changed_.notify_all();
  }
  for (const auto& [next, because] : left_out) tasks_->leave_out(next, because);
}

SharingReport Leading::end() {
  report_.goes_on = !tasks_->is_last;
  end_within(rules_.lost_after, report_.goes_on);
  report_.handed_out_twice = hand_out_->handed_out_twice();
  return report_;
}

/// Ends the run: withdraws the tasks that are being done here, tells all ranks of the end, and joins the threads. Waits
/// for the others for `patience` at most.
void Leading::end_within(Milliseconds patience, bool goes_on) {
  {
    const Lock lock(mutex_);
    ending_ = true;
    given_up_ = Clock::now() + patience;
    own_wanted_.withdraw();
    if (tasks_ != nullptr && tasks_->stop) tasks_->stop();
    RankSays end{.what = RankSays::What::end, .round = round_, .number = goes_on ? 1 : 0};
    for (int rank = 1; rank < ranks_.count(); ++rank)
      if (others_[size_t(rank)].phase == Phase::lost) end.numbers.push_back(rank);
    for (int rank = 1; rank < ranks_.count(); ++rank) ranks_.send(rank, packed(end));
    changed_.notify_all();
  }
  if (answering_.joinable()) answering_.join();
  for (std::thread& working : working_) working.join();
}

/// The second thread: hears the other ranks, tells them that this one is there, looks for losses and slow tasks, and
/// calls SharedTasks::check. Returns when all ranks have left or the patience of end_within() is over; ranks that have
/// not left by then are forgotten.
void Leading::answer() {
  Clock::time_point looked{};
  while (true) {
    const std::optional<RankMessage> message = ranks_.receive(kLook);
    std::optional<RankSays> says;
    if (message) says = unpacked(message->bytes);  // copies much, so before the lock
    const Lock lock(mutex_);
    try {
      if (message) hear(message->from, std::move(says));
      const Clock::time_point now = Clock::now();
      if (now - looked >= kLook) {
        looked = now;
        beat();
        look_for_losses();
        if (hand_out_) hand_out();  // tasks may have become slow ones
        if (!ending_ && tasks_ != nullptr && tasks_->check) tasks_->check();
      }
    } catch (...) {  // memory
      fail(std::current_exception());
    }
    if (ending_ && all_left()) return;
    if (!ending_ || Clock::now() < given_up_) continue;
    for (int rank = 1; rank < ranks_.count(); ++rank)  // nobody waits for what they are at
      if (!others_[size_t(rank)].left) ranks_.forget(rank);
    return;
  }
}

/// Does tasks on one thread of rank 0 until there is nothing more to do. An exception becomes the run's failure.
void Leading::work() {
  try {
    while (work_once()) {
    }
  } catch (const Withdrawn&) {
  } catch (...) {
    const Lock lock(mutex_);
    fail(std::current_exception());
  }
}

/// Waits for a task and does it; false where there is nothing more to do. Calls SharedTasks::check before and while it
/// waits. Throws what `check` and the task throw.
bool Leading::work_once() {
  std::optional<int> task;
  std::vector<uint8_t> brief;
  {
    Lock lock(mutex_);
    if (!ending_ && tasks_->check) tasks_->check();
    // Time alone makes a task slow, so this thread looks for itself now and then.
    while (!ending_ && !failure_ && !hand_out_->all_taken() && !(task = hand_out_->next_for(0, Clock::now()))) {
      changed_.wait_for(lock, kLook);
      if (!ending_ && tasks_->check) tasks_->check();
    }
    if (!task) return false;
    brief = brief_of(*task);
  }
  std::vector<uint8_t> bytes = tasks_->run(*task, brief, own_wanted_);
  const Lock lock(mutex_);
  hear_result(0, *task, std::move(bytes));
  return true;
}

void Leading::hear(int rank, std::optional<RankSays> says) {
  Other& other = others_[size_t(rank)];
  other.heard = Clock::now();
  if (!says) {
    if (other.phase != Phase::left_out)
      leave_out(rank, ErrorKind::bad_input, "its messages are of another version",
                "start the same version of Trueshade everywhere");
    other.left = true;  // nor does it know what the end is
    return;
  }
  if (says->round != round_) return;
  if (says->what == RankSays::What::bye) other.left = true;
  if (other.phase == Phase::left_out || other.phase == Phase::lost) return;
  if (says->what == RankSays::What::hello) {
    other.hello = std::move(says);
    if (hand_out_) meet(rank), hand_out();
  } else if (says->what == RankSays::What::result) {
    hear_result(rank, says->number, std::move(says->bytes));
  } else if (says->what == RankSays::What::failure) {
    const std::string text = says->words.empty() ? "" : says->words[0];
    if (rules_.continue_without_lost)
      leave_out(rank, ErrorKind::io, text, "");
    else
      fail(failure_from(name_of(rank), says->kind, text));
  }
}

/// Compares the identity in a rank's hello, which has come, with that of rank 0; once for a rank, as it takes the
/// hello's words. A rank that differs is left out by leave_out(), which fails the run unless continue_without_lost is
/// set; any other may be handed tasks from now on, as let_have() says.
void Leading::meet(int rank) {
  Other& other = others_[size_t(rank)];
  const std::vector<std::string> words = std::move(other.hello->words);
  const auto& identity = tasks_->identity;
  std::string difference;
  if (words.size() != 2 * identity.size()) difference = "what it tells of itself is not what rank 0 tells";
  for (size_t i = 0; i < identity.size() && difference.empty(); ++i) {
    const auto& [name, value] = identity[i];
    if (words[2 * i] != name || words[2 * i + 1] != value)
      difference = "its " + words[2 * i] + " is " + shown(words[2 * i + 1]) + ", and the " + name + " of rank 0 is " +
                   shown(value);
  }
  if (!difference.empty()) return leave_out(rank, ErrorKind::bad_input, difference, kSameEverywhere);
  other.phase = Phase::ready;
  let_have(rank, other.hello->number);
}

/// Lets a rank hold tasks, at least one at a time. Does nothing for a rank beyond the first SharingRules::ranks.
void Leading::let_have(int rank, int at_once) {
  if (rules_.ranks == 0 || rank < rules_.ranks) hand_out_->let_have(rank, std::max(at_once, 1), rules_.ahead);
}

/// Keeps the first result of a task for next_result(), drops later ones, and hands out more tasks. Fails the run where
/// a task was handed out twice and two of its results differ. Ignores a task that there is not.
void Leading::hear_result(int rank, int task, std::vector<uint8_t> bytes) {
  if (!hand_out_ || task < 0 || task >= tasks_->count) return;
  const bool first = hand_out_->came(task, rank, Clock::now());
  if (hand_out_->was_handed_out_twice(task)) {
    const std::string hash = same_hash(*tasks_, bytes);
    const auto [known, is_new] = hashes_.emplace(task, hash);
    if (!is_new && known->second != hash)
      fail(std::make_exception_ptr(std::logic_error("task " + std::to_string(task) + " has another result on " +
                                                    name_of(rank) + " than on another rank")));
  }
  if (first) {
    ++report_.tasks_of_rank[size_t(rank)];
    waiting_.emplace(task, std::move(bytes));
  }
  hand_out();
  changed_.notify_all();
}

/// Loses each rank whose process has ended, or that was silent for longer than lost_after.
void Leading::look_for_losses() {
  for (int rank = 1; rank < ranks_.count(); ++rank) {
    const Other& other = others_[size_t(rank)];
    if (other.phase == Phase::lost || other.left) continue;
    if (ranks_.has_ended(rank)) {
      lose(rank, "its process has ended");
    } else if (Clock::now() - other.heard > rules_.lost_after) {
      char text[64];
      std::snprintf(text, sizeof text, "nothing was heard of it for %g s",
                    std::chrono::duration<double>(rules_.lost_after).count());
      lose(rank, text);
    }
  }
}

/// Leaves a lost rank out, and neither sends to it nor waits for it any more. While the run ends, the loss is no
/// failure.
void Leading::lose(int rank, const std::string& how) {
  Other& other = others_[size_t(rank)];
  if (!ending_ && other.phase != Phase::left_out)
    leave_out(rank, ErrorKind::io, how, "what is finished is kept; --continue-without-lost goes on without it");
  other.phase = Phase::lost;
  other.left = true;
  ranks_.forget(rank);
}

/// Gives a rank no more tasks, in later rounds too. With continue_without_lost the tasks that it holds go to others;
/// without, the run fails by an Error of this kind.
void Leading::leave_out(int rank, ErrorKind kind, const std::string& why, const std::string& remedy) {
  others_[size_t(rank)].phase = Phase::left_out;
  ranks_.exclude(rank);
  if (!rules_.continue_without_lost) return fail(std::make_exception_ptr(Error(kind, name_of(rank), why, remedy)));
  report_.lost.push_back(name_of(rank) + ": " + why);
  if (!hand_out_) return;
  hand_out_->lose(rank);
  hand_out();
  changed_.notify_all();
}

/// Sends every other rank that is ready the tasks that it may have. Does nothing once the run has failed or ends.
void Leading::hand_out() {
  if (failure_ || ending_) return;
  for (int rank = 1; rank < ranks_.count(); ++rank) {
    if (others_[size_t(rank)].phase != Phase::ready) continue;
    while (const std::optional<int> task = hand_out_->next_for(rank, Clock::now()))
      ranks_.send(rank,
                  packed({.what = RankSays::What::work, .round = round_, .number = *task, .bytes = brief_of(*task)}));
  }
}

/// What rank 0 alone knows of a task; no bytes where SharedTasks::brief is not set.
std::vector<uint8_t> Leading::brief_of(int task) const {
  return tasks_->brief ? tasks_->brief(task) : std::vector<uint8_t>();
}

/// Tells all other ranks that this one is there, once in each beat_interval().
void Leading::beat() {
  const Clock::time_point now = Clock::now();
  if (now - last_beat_ < beat_interval(rules_.lost_after)) return;
  last_beat_ = now;
  for (int rank = 1; rank < ranks_.count(); ++rank) say(rank, RankSays::What::beat);
}

/// Whether each other rank has said bye or is lost.
bool Leading::all_left() const {
  return std::all_of(others_.begin() + 1, others_.end(), [](const Other& other) { return other.left; });
}

/// Notes the run's failure, of which the first counts, and wakes all threads.
void Leading::fail(std::exception_ptr failure) {
  if (!failure_) failure_ = std::move(failure);
  changed_.notify_all();
}

/// Sends a rank a message of this round.
void Leading::say(int rank, RankSays::What what, int number) {
  ranks_.send(rank, packed({.what = what, .round = round_, .number = number}));
}

/// `rank 2 on node7`
std::string Leading::name_of(int rank) const { return "rank " + std::to_string(rank) + " on " + ranks_.host(rank); }

}  // namespace trueshade
