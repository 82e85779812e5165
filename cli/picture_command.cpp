// The program `trueshade-picture`: `render` of built-in scenes.
#include <string_view>
#include <variant>

#include "cli/activity.h"
#include "cli/commands.h"
#include "cli/options.h"
#include "cli/preparation.h"
#include "core/error.h"
#include "core/fp_env.h"
#include "scenes/builtin/builtin.h"

namespace trueshade {
namespace {

Error left_out(const std::string& what) {
  return {ErrorKind::usage, "trueshade-picture", what, "use trueshade, which ./run builds after the first picture"};
}

}  // namespace

Scene scene_of_options(const std::string& spec, const Limits& limits, const SceneParts& parts) {
  constexpr std::string_view kBuiltin = "builtin:";
  if (!spec.starts_with(kBuiltin)) throw left_out("it draws built-in scenes alone");
  const Activity activity("making the scene");
  const FpScope fp;
  if (parts != SceneParts{}) throw left_out("it chooses neither cameras nor animations");
  return builtin_scene(std::string_view(spec).substr(kBuiltin.size()), limits);
}

CachedScene cached_scene_of_options(const std::string& spec, const Limits& limits, const SceneParts& parts) {
  if (limits.cache) throw left_out("it has no cache files");
  return {scene_of_options(spec, limits, parts), nullptr, {}};
}

std::vector<std::string> fault_names() { return {}; }

int execute(const Command& command) {
  const auto* options = std::get_if<RenderOptions>(&command);
  if (options == nullptr) throw left_out("it has the command render alone");
  render(*options);
  return 0;
}

}  // namespace trueshade
