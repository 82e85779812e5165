#include "cli/compared_pictures.h"

#include <algorithm>

#include "cli/judged_comparison.h"
#include "core/error.h"
#include "core/memory_cap.h"

namespace trueshade {

uint64_t flip_memory(uint64_t pixels) {
  constexpr uint64_t kPlanes = 3 + 3, kMaps = 2, kOfBands = uint64_t(64) << 20;  // light of both; the map and it sorted
  return pixels * 4 * (kPlanes + kMaps) + kOfBands;
}

ComparedPictures compared_pictures(const std::string& reference, const std::string& test,
                                   const CompareOptions& options) {
  ComparedPictures pictures;
  pictures.reference = read_any_picture(reference, options.limits.expansion);
  pictures.test = read_any_picture(test, options.limits.expansion);
  const ChannelFile& part = pictures.reference.parts.front();
  const auto& criteria = options.rules.criteria;
  if (options.rules.wants_flip ||
      std::any_of(criteria.begin(), criteria.end(), [](const auto& row) { return compare::is_flip(row.measure); }))
    require_memory(flip_memory(uint64_t(part.width) * uint64_t(part.height)), reference, "FLIP");
  pictures.comparison = compare::compared(pictures.reference, pictures.test, options.rules);
  const compare::Comparison& c = pictures.comparison;
  if (options.judges && c.outcome == compare::Outcome::different && c.differences.not_finite_pixels == 0)
    pictures.judged = judged_by_scene(pictures, options);
  return pictures;
}

}  // namespace trueshade
