#include "farm/mpi/mpi_ranks.h"

#include <mpi.h>
#include <sched.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>

#include "farm/mpi/traffic.h"

namespace trueshade {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr auto kShortSleep = 50us, kLongSleep = 2000us;
constexpr auto kPatienceToJoin = 120s;
constexpr auto kPatience = 5s;  // with what is under way, and with the others at the end

/// What a rank tells all others when it joins.
struct Introduction {
  char host[64];
  KnownProcess process;
  cpu_set_t cores;
};

/// Whether mpirun lets the others go on when a process dies (--enable-recovery).
bool mpirun_goes_on() {
  const char* const set = std::getenv("OMPI_MCA_orte_enable_recovery");
  return set != nullptr && std::atoi(set) != 0;
}

}  // namespace

MpiRanks::MpiRanks() {
  serving_ = std::thread([this] { serve(); });
  Lock lock(mutex_);
  joined_or_left_.wait_for(lock, kPatienceToJoin, [this] { return joined_; });
}

MpiRanks::~MpiRanks() {
  if (serving_.joinable()) serving_.detach();  // leave() was not called, or MPI does not let go: the process ends
}

void MpiRanks::send(int to, std::vector<uint8_t> bytes) {
  const Lock lock(mutex_);
  outbox_.push_back({to, std::move(bytes)});
  wanted_.notify_one();
}

std::optional<RankMessage> MpiRanks::receive(std::chrono::milliseconds timeout) {
  Lock lock(mutex_);
  if (!arrived_.wait_for(lock, timeout, [this] { return !inbox_.empty(); })) return {};
  RankMessage message = std::move(inbox_.front());
  inbox_.pop_front();
  return message;
}

bool MpiRanks::has_ended(int rank) const {
  const Member& member = members_[size_t(rank)];
  return member.is_seen && known_process(member.process.number).started != member.process.started;
}

void MpiRanks::forget(int rank) { members_[size_t(rank)].forgotten = true; }

void MpiRanks::leave(int exit_code) {
  {
    Lock lock(mutex_);
    leaving_ = true;
    exit_code_ = exit_code;
    wanted_.notify_one();
    if (!joined_or_left_.wait_for(lock, 3 * kPatience, [this] { return left_; })) std::_Exit(exit_code);
  }
  serving_.join();
}

/// Starts MPI, and tells and learns which processes there are. Waits for all of them without a time limit.
void MpiRanks::join() {
  int level = 0, size = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &level);
  MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
  MPI_Comm_rank(MPI_COMM_WORLD, &own_);
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  Introduction own{};
  char host[MPI_MAX_PROCESSOR_NAME] = "";
  int length = 0;
  MPI_Get_processor_name(host, &length);
  std::copy_n(host, std::min(size_t(length), sizeof own.host - 1), own.host);
  own.process = known_process(getpid());
  sched_getaffinity(0, sizeof own.cores, &own.cores);
  std::vector<Introduction> all(static_cast<size_t>(size));
  MPI_Allgather(&own, int(sizeof own), MPI_BYTE, all.data(), int(sizeof own), MPI_BYTE, MPI_COMM_WORLD);
  on_this_machine_ = 0;
  for (const Introduction& one : all) {
    Member& member = members_.emplace_back();
    member.host = one.host;
    member.process = one.process;
    const bool is_here = member.host == own.host;
    on_this_machine_ += is_here && CPU_EQUAL(&one.cores, &own.cores);
    member.is_seen =
        is_here && one.process.started != 0 && known_process(one.process.number).started == one.process.started;
  }
}

/// The thread: joins, then sends and receives until leave() is called and all letters are handed to MPI, then finishes.
void MpiRanks::serve() {
  join();
  Traffic traffic(MPI_COMM_WORLD, count());
  std::deque<RankMessage> complete;
  std::vector<Letter> letters;
  {
    const Lock lock(mutex_);
    joined_ = true;
    joined_or_left_.notify_all();
  }
  for (auto sleep = kShortSleep;;) {
    for (Letter& letter : letters)
      if (!members_[size_t(letter.to)].forgotten) traffic.send(std::move(letter));
    letters.clear();
    const bool moved = traffic.advance(complete, members_);
    sleep = moved ? kShortSleep : std::min(2 * sleep, kLongSleep);
    Lock lock(mutex_);
    for (RankMessage& message : complete)
      if (!members_[size_t(message.from)].forgotten) inbox_.push_back(std::move(message));
    if (!complete.empty()) arrived_.notify_all();
    complete.clear();
    wanted_.wait_for(lock, sleep, [this] { return !outbox_.empty() || leaving_; });
    letters.swap(outbox_);
    if (leaving_ && letters.empty()) break;
  }
  finish(traffic);
}

/// Waits for what is under way, for some seconds, and ends MPI. Where a rank is forgotten it ends this process instead,
/// and on rank 0 the others too; where mpirun goes on without those that die, it ends only this process and the
/// forgotten ones of this machine.
void MpiRanks::finish(Traffic& traffic) {
  std::deque<RankMessage> unread;
  for (const Clock::time_point end = Clock::now() + kPatience; !traffic.all_sent(members_) && Clock::now() < end;) {
    traffic.advance(unread, members_);
    std::this_thread::sleep_for(kShortSleep);
  }
  if (any_forgotten()) {
    // MPI_Finalize would wait for the lost ones. MPI_Abort ends all, and mpirun ends with the code; but where mpirun
    // goes on without those that die, it ends nobody, and waits for all.
    if (mpirun_goes_on()) {
      end_forgotten();
    } else {
      // Of a process that has died mpirun may know: it is not called while it ends the others, or may hang.
      if (own_ != 0 || any_forgotten_has_ended()) std::this_thread::sleep_for(kPatience);
      if (own_ == 0) MPI_Abort(MPI_COMM_WORLD, exit_code_);
    }
    std::_Exit(exit_code_);
  }
  MPI_Finalize();
  const Lock lock(mutex_);
  left_ = true;
  joined_or_left_.notify_all();
}

/// Kills the forgotten processes of this machine that have not ended, as they are stopped or wait for a disk for ever.
void MpiRanks::end_forgotten() {
  for (int rank = 0; rank < count(); ++rank)
    if (const Member& member = members_[size_t(rank)]; member.forgotten && member.is_seen && !has_ended(rank))
      kill(member.process.number, SIGKILL);
}

/// Whether the process of a forgotten rank of this machine has ended.
bool MpiRanks::any_forgotten_has_ended() const {
  for (int rank = 0; rank < count(); ++rank)
    if (members_[size_t(rank)].forgotten && has_ended(rank)) return true;
  return false;
}

bool MpiRanks::any_forgotten() const {
  return std::any_of(members_.begin(), members_.end(), [](const Member& member) { return member.forgotten.load(); });
}

}  // namespace trueshade
