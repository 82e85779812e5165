#pragma once
// Hulls of whole levels of a scene's textures, each found once.
#include <array>
#include <bitset>
#include <compare>
#include <map>
#include <memory>
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

/// Keeps the hulls and codes of levels. For any number of threads. Textures must outlive it unchanged.
class LevelHulls {
 public:
  using Hull = std::array<std::array<double, 2>, 4>;  ///< least and largest of R, G, B, A

  /// The hull of a reading; nothing where none was kept.
  std::optional<Hull> find(const LevelReading& of) const {
    const std::lock_guard lock(mutex_);
    const auto found = hulls_.find(of);
    return found == hulls_.end() ? std::nullopt : std::optional(found->second);
  }
  /// Keeps the hull of a reading; one that is kept already stays.
  void keep(const LevelReading& of, const Hull& hull) {
    const std::lock_guard lock(mutex_);
    hulls_.emplace(of, hull);
  }

  using Codes = std::array<std::bitset<256>, 4>;  ///< of R, G, B, A
  /// The codes that occur in each channel of a level of 8-bit texels. Reads the whole level at the first call.
  std::shared_ptr<const Codes> codes_of(const Texture& texture, size_t level) {
    const std::pair key{&texture, level};
    {
      const std::lock_guard lock(mutex_);
      if (const auto found = codes_.find(key); found != codes_.end()) return found->second;
    }
    std::array<std::array<uint8_t, 256>, 4> seen{};
    const Array<uint8_t>& bytes = texture.levels[level].bytes;
    for (size_t k = 0; k + 4 <= bytes.size(); k += 4)
      for (size_t c = 0; c < 4; ++c) seen[c][bytes[k + c]] = 1;
    auto codes = std::make_shared<Codes>();
    for (size_t c = 0; c < 4; ++c)
      for (size_t code = 0; code < 256; ++code) (*codes)[c][code] = seen[c][code] != 0;
    const std::lock_guard lock(mutex_);
    return codes_.emplace(key, std::move(codes)).first->second;
  }

 private:
  mutable std::mutex mutex_;
  std::map<LevelReading, Hull> hulls_;
  std::map<std::pair<const Texture*, size_t>, std::shared_ptr<const Codes>> codes_;
};

}  // namespace trueshade::oracle
