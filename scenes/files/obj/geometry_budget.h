#pragma once
#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/memory_cap.h"
#include "scenes/scene_limits.h"

namespace trueshade::obj {

/// Counts what is made of a file against limits.geometry_bytes, and against the memory cap each time that it has
/// doubled: a vector that grows doubles too.
class GeometryBudget {
 public:
  GeometryBudget(const SceneLimits& limits, std::string_view where) : limit_(limits.geometry_bytes), where_(where) {}

  /// Whether `bytes` more are within the limit. Error(limit) over the memory cap.
  bool take(uint64_t bytes) {
    if (bytes > limit_ - taken_) return false;
    taken_ += bytes;
    if (taken_ > next_check_) {
      require_memory(taken_, where_, "the geometry");
      next_check_ = 2 * taken_;
    }
    return true;
  }

  std::string remedy() const { return within_limit(limit_, "bytes", "--max-geometry-memory"); }

 private:
  uint64_t limit_, taken_ = 0, next_check_ = uint64_t(16) << 20;
  std::string where_;
};

}  // namespace trueshade::obj
