#include "cli/activity.h"

#include <atomic>
#include <cstdio>
#include <system_error>

#include "cli/terminal.h"

namespace trueshade {
namespace {

constexpr std::chrono::milliseconds kQuiet(1000), kRedraw(100);

std::atomic<bool> alive{false};
std::mutex told;        // guards what the one that is alive says, and
bool is_drawn = false;  // whether a line stands on the terminal

void wipe() {
  if (is_drawn) std::fputs("\r\x1b[K", stderr);
  is_drawn = false;
}

}  // namespace

Activity::Activity(std::string what, Counts counts)
    : outermost_(!alive.exchange(true)),
      terminal_(terminal_takes_escapes() && !is_quiet()),
      what_(std::move(what)),
      part_begin_(Clock::now()),
      loop_begin_(part_begin_) {
  if (!outermost_ || !terminal_) return;
  if (counts == Counts::loops) watch_.emplace([this](int done, int count) { show(done, count, "parts"); });
  try {
    drawer_ = std::thread([this] { draw(); });
  } catch (const std::system_error&) {
    // Without a thread to spare the work goes on in silence.
  }
}

Activity::~Activity() {
  watch_.reset();
  if (drawer_.joinable()) {
    {
      const std::lock_guard lock(told);
      ends_ = true;
    }
    end_.notify_all();
    drawer_.join();
  }
  if (outermost_) alive = false;
}

bool Activity::any() { return alive; }

void Activity::now(std::string what) {
  const std::lock_guard lock(told);
  what_ = std::move(what);
  done_ = total_ = 0;
  part_begin_ = loop_begin_ = Clock::now();
}

void Activity::show(int done, int total, std::string_view unit) {
  const std::lock_guard lock(told);
  if (total != total_ || done < done_) loop_begin_ = Clock::now();
  done_ = done, total_ = total, unit_ = unit;
}

std::string Activity::line() const {
  const Clock::time_point now = Clock::now();
  if (total_ > 1) return progress_line(what_, unit_, done_, total_, seconds_of(now - loop_begin_));
  char text[32];
  std::snprintf(text, sizeof text, ", %.0f s", seconds_of(now - part_begin_));
  return what_ + text;
}

void Activity::draw() {
  std::unique_lock lock(told);
  if (end_.wait_for(lock, kQuiet, [this] { return ends_; })) return;
  while (!ends_) {
    std::fputs(('\r' + line() + "\x1b[K").c_str(), stderr);
    is_drawn = true;
    end_.wait_for(lock, kRedraw, [this] { return ends_; });
  }
  wipe();
}

std::unique_lock<std::mutex> Activity::pause() {
  std::unique_lock lock(told);
  wipe();
  return lock;
}

}  // namespace trueshade
