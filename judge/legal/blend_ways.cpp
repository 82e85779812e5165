#include "judge/legal/blend_ways.h"

#include <algorithm>
#include <cmath>

namespace trueshade::oracle {

std::vector<Way> ways_from(const Texel& from, std::span<const DrawnFragment> fragments, const BlendState& blend,
                           Format format, const Profile& profile) {
  size_t count = 1;
  for (const DrawnFragment& f : fragments) count *= size_t(f.most - f.least + 1) * (f.output.either_way ? 2 : 1);
  std::vector<Way> list{Way{PixelClass::exact, from, {}}}, next;
  for (const DrawnFragment& f : fragments) {
    next.clear();
    for (const Way& way : list)
      for (int turn = 0; turn <= f.most - f.least; ++turn) {
        const int times = turn == 0 ? f.nominal : f.least + turn - (f.least + turn <= f.nominal ? 1 : 0);
        for (int branch = 0; branch < (f.output.either_way ? 2 : 1); ++branch) {
          Way w = way;
          if (times != f.nominal && worse(f.doubt, w.pixel_class)) w.pixel_class = f.doubt;
          if (branch == 1 && worse(PixelClass::branch, w.pixel_class)) w.pixel_class = PixelClass::branch;
          const std::array<Range, 4>& source = branch == 1 ? f.output.other : f.output.nominal;
          for (int i = 0; i < times; ++i) w.texel = blended_texel(blend, format, profile, source, w.texel);
          for (size_t k = 0; k < 4 && times > 0; ++k) w.value[k] = source[k].value;
          next.push_back(w);
          if (times == 0) break;
        }
      }
    if (count > kMostWays && next.size() > 2) {
      for (size_t i = 2; i < next.size(); ++i) {
        for (size_t k = 0; k < 4; ++k) next[1].texel[k] = hull(next[1].texel[k], next[i].texel[k]);
        if (worse(next[i].pixel_class, next[1].pixel_class)) next[1].pixel_class = next[i].pixel_class;
      }
      next.resize(2);
    }
    std::swap(list, next);
  }
  return list;
}

namespace {
constexpr double kWhole = 0x1.8p52;  // what is added to it is rounded to a whole number, ties to even
}

AddedCodes::AddedCodes(Format format, const BlendState& blend) {
  const FormatInfo layout = info(format);
  suit_ = blend.enabled && blend.rgb == kAccumulate && blend.mask[0] && blend.mask[1] && blend.mask[2] &&
          (!blend.mask[3] || layout.channels < 4) && layout.number_class == NumberClass::unorm && !layout.packed() &&
          !layout.srgb && layout.channels >= 3;
  bytes_ = layout.bytes_per_channel, channels_ = layout.channels;
  largest_ = double(layout.largest_code(0));
}

bool AddedCodes::as_predicted(const Bounded3& color, const uint8_t* before, const uint8_t* after) const {
  const auto code = [this](const uint8_t* texel, size_t k) {
    return bytes_ == 1 ? int(texel[k]) : int(texel[2 * k]) | int(texel[2 * k + 1]) << 8;
  };
  for (size_t k = 0; k < 3; ++k) {
    // A threshold is half a code away; the product with the largest code is rounded to a float before it is stored.
    const double exact = std::clamp(color[k].value, 0.0, 1.0) * largest_, nearest = (exact + kWhole) - kWhole;
    const double reach = color[k].error * largest_ + (exact + 1) * 0x1p-22;
    if (!(std::fabs(exact - nearest) + reach < 0.5)) return false;
    if (code(after, k) != std::min(code(before, k) + int(nearest), int(largest_))) return false;
  }
  return channels_ < 4 || code(after, 3) == code(before, 3);
}

}  // namespace trueshade::oracle
