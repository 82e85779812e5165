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

/// How a level of a texture is read, the key of a stored hull. With `border` the hull holds the sampler's border colour
/// too; `encoded`: sRGB is not decoded; `codes`: how many of 255 a decoded sRGB texel may be off.
struct LevelReading {
  const Texture* texture = nullptr;
  size_t level = 0;
  bool encoded = false, border = false;
  double codes = 0;
  std::array<float, 4> border_color{};
  auto operator<=>(const LevelReading&) const = default;
};

/// A cache of the least and largest channels of texture levels, and of the codes that occur in them. Any thread may use
/// it. It borrows the textures, which must not change.
class LevelHulls {
 public:
  using Hull = std::array<std::array<double, 2>, 4>;  ///< least and largest of R, G, B, A

  /// The hull that keep() stored for this reading; nothing where it stored none.
  std::optional<Hull> find(const LevelReading& of) const {
    const std::lock_guard lock(mutex_);
    const auto found = hulls_.find(of);
    return found == hulls_.end() ? std::nullopt : std::optional(found->second);
  }
  /// Stores the hull of a reading, unless one is stored already.
  void keep(const LevelReading& of, const Hull& hull) {
    const std::lock_guard lock(mutex_);
    hulls_.emplace(of, hull);
  }

  using Codes = std::array<std::bitset<256>, 4>;  ///< of R, G, B, A
  /// For each channel, which of the codes 0 to 255 occur in a level whose texels are RGBA8. The first call reads the
  /// whole level; later ones return what it found.
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
