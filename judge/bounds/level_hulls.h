#pragma once
// Hulls of whole levels of a scene's textures, each found once.
#include <array>
#include <compare>
#include <map>
#include <mutex>
#include <optional>

#include "scenes/texture.h"

namespace trueshade::oracle {

/// What a hull is of: a level as it is read, with the border colour if the sampler may read that.
struct LevelReading {
  const Texture* texture = nullptr;
  size_t level = 0;
  bool encoded = false, border = false;
  double codes = 0;
  std::array<float, 4> border_color{};
  auto operator<=>(const LevelReading&) const = default;
};

/// For any number of threads. Textures must outlive it unchanged.
class LevelHulls {
 public:
  using Hull = std::array<std::array<double, 2>, 4>;  ///< least and largest of R, G, B, A

  std::optional<Hull> find(const LevelReading& of) const {
    const std::lock_guard lock(mutex_);
    const auto found = hulls_.find(of);
    return found == hulls_.end() ? std::nullopt : std::optional(found->second);
  }
  void keep(const LevelReading& of, const Hull& hull) {
    const std::lock_guard lock(mutex_);
    hulls_.emplace(of, hull);
  }

 private:
  mutable std::mutex mutex_;
  std::map<LevelReading, Hull> hulls_;
};

}  // namespace trueshade::oracle
