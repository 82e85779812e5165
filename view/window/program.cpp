// The program trueshade-view, which `trueshade view` hands over to: the command line is the command's own.
#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>
#include <variant>

#include "cli/command_tables.h"
#include "cli/commands.h"
#include "cli/help_text.h"
#include "cli/looks.h"
#include "cli/options.h"
#include "cli/preparation.h"
#include "core/error.h"
#include "scenes/files/content/scene_files.h"
#include "view/script.h"
#include "view/window/placement.h"
#include "view/window/script_player.h"
#include "view/window/window.h"

namespace trueshade {

using namespace viewer;

namespace {

constexpr uint64_t kMostScriptBytes = uint64_t(16) << 20;

std::vector<ScriptStep> script_of(const ViewOptions& options) {
  if (!options.script) return {};
  const Bytes bytes = read_user_file(*options.script, kMostScriptBytes, "");
  return script_from_text({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, *options.script);
}

/// The window's size: of the picture and the bar where it is given, else 1280 x 720 in texts of that scale, within the
/// display.
Window::Look look_of(const ViewOptions& options, const Display& display) {
  Window::Look look{1280, 720, options.size.has_value(), options.scale > 0.0 ? options.scale : display.text_scale()};
  SDL_Rect room{0, 0, look.width, look.height};
  SDL_GetDisplayUsableBounds(0, &room);
  if (options.size)
    return look.width = std::clamp(options.size->width, 320, std::max(room.w, 320)),
           look.height = std::clamp(options.size->height + bar_rows(look.scale), 240, std::max(room.h, 240)), look;
  look.width = std::clamp(int(look.width * look.scale), 320, std::max(room.w * 9 / 10, 320));
  look.height = std::clamp(int(look.height * look.scale), 240, std::max(room.h * 9 / 10, 240));
  return look;
}

void run_window(const ViewOptions& options) {
  check_pipeline(options);
  std::vector<ScriptStep> steps = script_of(options);
  const Display display;
  const SceneSource source{options.scene, [&options] { return scene_of_options(options); },
                           [&options](const Scene& scene) { return pipeline_of(options, scene); },
                           [&options](Scene& scene, const Pipeline& pipeline) {
                             return looks_text(bring_to_looks(options, pipeline, ChosenLooks::by_scene, scene));
                           },
                           options.limits};
  std::vector<std::string> files;
  OpenedScene opened = opened_scene(source, files);
  const Window::Look look = look_of(options, display);
  if (!options.size)
    opened.facts.pipeline.width = look.width, opened.facts.pipeline.height = look.height - bar_rows(look.scale);
  check_memory(opened.scene->scene(), opened.facts.pipeline, options.execution, {});
  std::optional<Camera> camera;  // of the options, which stands still
  if (const Scene& scene = opened.scene->scene(); options.camera.any())
    camera = camera_of(scene, options.camera, opened.facts.pipeline).camera(scene);
  Session session(source, std::move(opened), options.execution, [&display] { display.wake(); });
  if (options.time) session.set_time(*options.time);
  if (camera) session.set_camera(*camera);
  Window window(display, session, look);
  ScriptPlayer player(std::move(steps), options.script.value_or(""), session, window);
  do player.play();
  while (window.step(player.patience()));
  if (session.failed_save()) throw *session.failed_save();
}

}  // namespace

std::vector<std::string> fault_names() { return {}; }

int execute(const Command& command) {
  if (std::holds_alternative<PrintText>(command)) {  // whichever help was asked for, it is this command's
    const CommandTables tables;
    return print(help_of_command(*tables.named("view"))), 0;
  }
  const auto* options = std::get_if<ViewOptions>(&command);
  if (options == nullptr)
    throw Error(ErrorKind::usage, "trueshade-view", "it has the command view alone", "use trueshade");
  run_window(*options);
  return 0;
}

}  // namespace trueshade
