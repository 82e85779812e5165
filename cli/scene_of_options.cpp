// scene_of_options() of programs that read every kind of scene.
#include "cli/activity.h"
#include "cli/preparation.h"
#include "core/image_files/image_io.h"
#include "core/printable_text.h"

namespace trueshade {

Scene scene_of_options(const std::string& spec, const Limits& limits) {
  const Activity activity("reading " + printable(spec, Lines::one));
  return load_scene(spec, limits,
                    [&limits](std::span<const uint8_t> content, const std::string& where, uint64_t most_bytes) {
                      return decode_image(content, where, most_bytes, limits.expansion);
                    });
}

CachedScene cached_scene_of_options(const std::string& spec, const Limits& limits,
                                    const std::optional<std::string>& folder) {
  const auto load = [&] { return scene_of_options(spec, limits); };
  if (!folder) return {load(), nullptr, {}};
  return cached_scene(*folder, spec, limits, load);
}

}  // namespace trueshade
