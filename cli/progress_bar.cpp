#include "cli/progress_bar.h"

#include <cstdio>

#include "cli/activity.h"
#include "cli/terminal.h"

namespace trueshade {
namespace {

constexpr int kBarCells = 30;
constexpr double kQuietSeconds = 1.0, kRedrawSeconds = 0.1;

}  // namespace

std::string progress_line(std::string_view what, std::string_view unit, int done, int total, double seconds) {
  const double share = total > 0 ? double(done) / total : 0.0;
  const double rate = seconds > 0.0 ? done / seconds : 0.0;
  const int full = int(share * kBarCells);
  char numbers[96];
  std::snprintf(numbers, sizeof numbers, "] %3d%%  %.0f ", int(share * 100.0), rate);
  std::string line = std::string(what) + " [" + std::string(size_t(full), '#') +
                     std::string(size_t(kBarCells - full), '.') + numbers + std::string(unit) + "/s";
  if (rate > 0.0) {
    std::snprintf(numbers, sizeof numbers, "  %.0f s left", (total - done) / rate);
    line += numbers;
  }
  return line;
}

ProgressBar::ProgressBar(std::string_view what, std::string_view unit)
    : what_(what),
      unit_(unit),
      begin_(Clock::now()),
      shown_(begin_),
      terminal_(terminal_takes_escapes() && !is_quiet() && !Activity::any()) {}

ProgressBar::~ProgressBar() {
  if (drawn_) std::fputs("\r\x1b[K", stderr);
}

void ProgressBar::show(int done, int total) {
  const Clock::time_point now = Clock::now();
  if (!terminal_ || seconds_of(now - begin_) < kQuietSeconds || seconds_of(now - shown_) < kRedrawSeconds) return;
  const std::string line = '\r' + progress_line(what_, unit_, done, total, seconds_of(now - begin_)) + "\x1b[K";
  std::fputs(line.c_str(), stderr);
  shown_ = now;
  drawn_ = true;
}

}  // namespace trueshade
