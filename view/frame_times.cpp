#include "view/frame_times.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>

namespace trueshade::viewer {
namespace {

constexpr size_t kMostCounted = 1000000;  // of which a report takes 100 MB

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3f", value);
  return text;
}

}  // namespace

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  const auto rank = size_t(std::ceil(share * double(values.size())));
  const auto at = values.begin() + std::ptrdiff_t(std::clamp<size_t>(rank, 1, values.size()) - 1);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

double process_cpu_seconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return double(time.tv_sec) + double(time.tv_nsec) * 1e-9;
}

void FrameTimes::add(const PictureTimes& times) {
  if (shown_.size() == kShown) shown_.erase(shown_.begin());
  shown_.push_back(times);
  if (counted_.size() < kMostCounted) counted_.push_back(times);
}

void FrameTimes::begin(double process_cpu_s) {
  counted_.clear();
  cpu_begin_s_ = process_cpu_s;
}

std::string FrameTimes::report(double process_cpu_s) const {
  double seconds = 0.0;
  for (const PictureTimes& times : counted_) seconds += times[Part::interval] / 1000.0;
  const double count = double(counted_.size());
  std::string text =
      "{\"pictures\":" + std::to_string(counted_.size()) + ",\"seconds\":" + number(seconds) +
      ",\"pictures_per_second\":" + number(seconds > 0.0 ? count / seconds : 0.0) +
      ",\"cpu_ms_per_picture\":" + number(count > 0.0 ? 1000.0 * (process_cpu_s - cpu_begin_s_) / count : 0.0) +
      ",\"parts_ms\":{";
  for (size_t part = 0; part < kParts; ++part) {
    std::vector<double> values;
    for (const PictureTimes& times : counted_) values.push_back(times.ms[part]);
    text += (part == 0 ? "\"" : ",\"") + std::string(kPartNames[part]) +
            "\":{\"median\":" + number(quantile(values, 0.5)) + ",\"p95\":" + number(quantile(values, 0.95)) +
            ",\"p99\":" + number(quantile(values, 0.99)) + ",\"most\":" + number(quantile(values, 1.0)) + '}';
  }
  return text + "}}\n";
}

}  // namespace trueshade::viewer
