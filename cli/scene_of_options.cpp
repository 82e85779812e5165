// scene_of_options() of programs that read every kind of scene.
#include "cli/activity.h"
#include "cli/notes.h"
#include "cli/preparation.h"
#include "core/image_files/image_io.h"
#include "core/printable_text.h"

namespace trueshade {
namespace {

Scene read_scene(const std::string& spec, const Limits& limits, const SceneParts& parts) {
  const Activity activity("reading " + printable(spec, Lines::one));
  return load_scene(
      spec, limits,
      [&limits](std::span<const uint8_t> content, const std::string& where, uint64_t most_bytes) {
        return decode_image(content, where, most_bytes, limits.expansion);
      },
      parts);
}

}  // namespace

CachedScene cached_scene_of_options(const std::string& spec, const Limits& limits, const SceneParts& parts) {
  if (!limits.cache) return {read_scene(spec, limits, parts), nullptr, {}};
  const Activity activity("reading " + printable(spec, Lines::one));  // or making the file
  CachedScene cached =
      cached_scene(*limits.cache, spec, limits, parts, [&] { return read_scene(spec, limits, parts); });
  if (!cached.note.empty()) say_notes({cached.note});
  return cached;
}

Scene scene_of_options(const std::string& spec, const Limits& limits, const SceneParts& parts) {
  CachedScene cached = cached_scene_of_options(spec, limits, parts);
  check_all(cached);
  return std::move(cached.scene);
}

}  // namespace trueshade
