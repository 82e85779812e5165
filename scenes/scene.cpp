#include "scenes/scene.h"

#include "core/error.h"
#include "scenes/builtin.h"

namespace trueshade {

uint64_t Scene::triangle_count() const {
  uint64_t count = 0;
  for (const Instance& instance : instances) count += meshes[instance.mesh].triangle_count();
  return count;
}

Scene load_scene(const std::string& spec, const SceneLimits& limits) {
  constexpr std::string_view kBuiltin = "builtin:";
  if (spec.starts_with(kBuiltin)) return builtin_scene(std::string_view(spec).substr(kBuiltin.size()), limits);
  throw Error(ErrorKind::bad_input, spec, "the ending names no scene or geometry format", "builtin:NAME, .json, .ply or .ply.gz");
}

}  // namespace trueshade
