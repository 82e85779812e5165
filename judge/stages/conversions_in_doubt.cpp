#include "judge/stages/conversions_in_doubt.h"

#include <algorithm>

namespace trueshade::oracle {

namespace {

constexpr size_t kMostOfRow = size_t(1) << 14;

uint32_t place_of(int x, int channel) { return uint32_t(x) * 4 + uint32_t(channel); }

}  // namespace

bool ConversionsInDoubt::is_kept(int x) const {
  uint32_t v = uint32_t(x) * 0x9e3779b1u;
  v ^= v >> 15, v *= 0x846ca68bu, v ^= v >> 16;
  return v % one_in_ == 0;
}

void ConversionsInDoubt::add(int x, const NearThreshold& conversion) {
  if (!is_kept(x)) return;
  entries_.push_back({place_of(x, conversion.channel), false, conversion});
  is_sorted_ = false;
  if (entries_.size() > kMostOfRow) keep_fewer();
}

void ConversionsInDoubt::replace(int x, int channel) {
  if (entries_.empty() || !is_kept(x)) return;
  entries_.push_back({place_of(x, channel), true, {}});
  is_sorted_ = false;
}

void ConversionsInDoubt::keep_fewer() {
  one_in_ *= 2;
  std::erase_if(entries_, [this](const Entry& e) { return !is_kept(int(e.place / 4)); });
}

void ConversionsInDoubt::sort() {
  std::stable_sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) { return a.place < b.place; });
  sorted_.clear(), places_.clear();
  for (const Entry& e : entries_) {
    if (e.replaces) {
      while (!places_.empty() && places_.back() == e.place) places_.pop_back(), sorted_.pop_back();
      continue;
    }
    sorted_.push_back(e.conversion), places_.push_back(e.place);
  }
  is_sorted_ = true;
}

std::span<const NearThreshold> ConversionsInDoubt::at(int x, int channel) {
  if (!is_sorted_) sort();
  const auto [first, last] = std::equal_range(places_.begin(), places_.end(), place_of(x, channel));
  return std::span(sorted_).subspan(size_t(first - places_.begin()), size_t(last - first));
}

}  // namespace trueshade::oracle
