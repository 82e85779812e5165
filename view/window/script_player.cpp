#include "view/window/script_player.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cli/commands.h"
#include "cli/preparation.h"
#include "core/error.h"
#include "core/file_ending.h"
#include "core/image_files/image_io.h"

namespace trueshade::viewer {
namespace {

constexpr double kRadians = 3.14159265358979323846 / 180.0;

template <typename Names>
size_t index_of(const Names& names, const std::string& name) {
  return size_t(std::find(std::begin(names), std::end(names), name) - std::begin(names));
}

void write_text(const std::string& path, const std::string& text) {
  write_file(path, {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
}

}  // namespace

ScriptPlayer::ScriptPlayer(std::vector<ScriptStep> steps, std::string where, Session& session, Window& window)
    : steps_(std::move(steps)), where_(std::move(where)), session_(session), window_(window) {}

void ScriptPlayer::play() {
  while (!ended()) {
    const ScriptStep& step = steps_[next_];
    if (!begun_) {
      begin_ = Clock::now();
      begun_ = true;
      if (!begin(step)) return;
    } else if (!is_over(step)) {
      return;
    } else {
      end(step);
    }
    begun_ = false;
    ++next_;
    window_.show_again();
  }
}

void ScriptPlayer::press(const std::string& key, bool down) {
  SDL_Event event{};
  event.type = down ? SDL_KEYDOWN : SDL_KEYUP;
  event.key.windowID = window_.id();
  event.key.state = down ? SDL_PRESSED : SDL_RELEASED;
  event.key.keysym.sym = SDL_GetKeyFromName(key.c_str());
  event.key.keysym.scancode = SDL_GetScancodeFromKey(event.key.keysym.sym);
  SDL_PushEvent(&event);
}

void ScriptPlayer::move_to(int x, int y) {
  SDL_Event event{};
  event.type = SDL_MOUSEMOTION;
  event.motion.windowID = window_.id();
  event.motion.xrel = x - std::exchange(pointer_x_, x), event.motion.yrel = y - std::exchange(pointer_y_, y);
  event.motion.x = x, event.motion.y = y;
  SDL_PushEvent(&event);
}

void ScriptPlayer::button(int x, int y, bool down) {
  SDL_Event event{};
  event.type = down ? SDL_MOUSEBUTTONDOWN : SDL_MOUSEBUTTONUP;
  event.button.windowID = window_.id();
  event.button.button = SDL_BUTTON_LEFT;
  event.button.state = down ? SDL_PRESSED : SDL_RELEASED;
  event.button.x = x, event.button.y = y;
  SDL_PushEvent(&event);
}

void ScriptPlayer::drag_on(const ScriptStep& step, double part) {
  const auto at = [part](double from, double to) { return int(std::lround(from + (to - from) * part)); };
  move_to(at(step.numbers[0], step.numbers[2]), at(step.numbers[1], step.numbers[3]));
}

bool ScriptPlayer::is_still() const {
  return !session_.waits() && window_.shown_revision() == session_.state().revision && !session_.hash().empty() &&
         !session_.moves();
}

void ScriptPlayer::change_light(const ScriptStep& step) {
  const auto light = uint32_t(step.numbers[0]);
  const LightChange* const known = session_.change_of(light);
  LightChange change = known != nullptr ? *known : LightChange{light};
  const auto three = [&] { return glm::vec3(step.numbers[1], step.numbers[2], step.numbers[3]); };
  if (step.command == "light") change.on = step.words[0] == "on";
  if (step.command == "light-color") change.color = three();
  if (step.command == "light-intensity") change.intensity = step.numbers[1];
  if (step.command == "light-position") change.position = three();
  session_.change_light(change);
}

bool ScriptPlayer::set(const ScriptStep& step) {
  Pipeline pipeline = session_.state().pipeline;
  const auto is = [&step](std::string_view name) { return step.command == name; };
  const auto number = [&step](size_t i) { return step.numbers[i]; };
  if (is("preset")) return session_.set_preset(step.words[0]), true;
  if (is("strategy"))
    return pipeline.strategy = Strategy(index_of(kStrategyNames, step.words[0])), session_.set_pipeline(pipeline), true;
  if (is("view")) return pipeline.view = *view_from_name(step.words[0]), session_.set_pipeline(pipeline), true;
  if (is("target")) {
    for (const Format format : kTargetFormats)
      if (info(format).name == step.words[0]) pipeline.target = format;
    return session_.set_pipeline(pipeline), true;
  }
  if (is("exposure")) return session_.set_exposure(number(0)), true;
  if (is("time")) return session_.set_time(number(0)), true;
  if (is("play") || is("pause")) return session_.play(is("play")), true;
  if (is("home")) return session_.go_home(), true;
  if (is("reset-lights")) return session_.reset_lights(), true;
  if (is("wheel")) return session_.change_speed(number(0)), true;
  if (is("look")) return window_.scripted.turn = {number(0) * kRadians, number(1) * kRadians}, true;
  if (is("orbit")) return window_.scripted.orbit = {number(0) * kRadians, number(1) * kRadians}, true;
  if (is("size")) return window_.set_size(int(number(0)), int(number(1))), true;
  if (is("panel")) return session_.desk().panel = Panel(index_of(kPanelNames, step.words[0])), true;
  if (is("model")) return session_.set_model(step.words[0] == "none" ? "" : step.words[0]), true;
  if (is("light-parameter")) {
    const ProgramParameter given = parameter_of(step.words[0]);
    return session_.set_parameter(given.name, given.value), true;
  }
  if (step.command.starts_with("light")) return change_light(step), true;
  if (!is("camera")) return false;
  Camera camera = session_.picture() ? session_.picture()->camera : Camera();
  camera = camera_with_lens(camera, session_.facts().reach);
  camera.eye = {number(0), number(1), number(2)};
  camera.target = {number(3), number(4), number(5)};
  if (camera.eye == camera.target)
    throw Error(ErrorKind::bad_input, where_ + ": line " + std::to_string(step.line), "the camera looks at where it is",
                "two points");
  return session_.set_camera(camera), true;
}

/// What waits for nothing, and what is begun here and ends later.
bool ScriptPlayer::begin(const ScriptStep& step) {
  if (set(step)) return step.command != "look" && step.command != "orbit";
  if (step.command == "key") press(step.words[0], true);
  if (step.command == "press") {
    press(step.words[0], true);
    press(step.words[0], false);
  }
  if (step.command == "click" || step.command == "drag") {
    const int x = int(step.numbers[0]), y = int(step.numbers[1]);
    move_to(x, y);
    if (step.command == "drag") button(x, y, true);
  }
  if (step.command == "quit") session_.desk().ends = true;
  return step.command == "quit";
}

/// Ends a script that would wait for ever.
void ScriptPlayer::check_becomes_still(const ScriptStep& step) const {
  const auto fail = [&](const char* reason, const char* remedy) {
    throw Error(ErrorKind::bad_input, where_ + ": line " + std::to_string(step.line), reason, remedy);
  };
  if (session_.plays() && session_.has_time())
    fail("it waits until nothing moves, and the time plays", "a line `pause` before it");
  if (session_.is_refused() && !session_.waits())
    fail("it waits for a picture that cannot be drawn", "other lines before it; the note says what is wrong");
}

bool ScriptPlayer::is_over(const ScriptStep& step) {
  const double passed = std::chrono::duration<double>(Clock::now() - begin_).count();
  constexpr double kMoment = 0.05;  // in which the window sees events and lays panels out
  if (step.command == "wait") return passed >= step.numbers[0];
  if (step.command == "key") return passed >= step.numbers[0];
  if (step.command == "drag") {
    drag_on(step, std::min(passed / std::max(step.numbers[4], 1e-3), 1.0));
    return passed >= step.numbers[4];
  }
  if (step.command == "measure") return true;
  if (step.command == "click" || step.command == "press" || step.command == "look" || step.command == "orbit")
    return passed >= kMoment;
  if (step.command == "report") return true;
  check_becomes_still(step);
  return is_still() && passed >= kMoment;  // saving, and `still`
}

void ScriptPlayer::end(const ScriptStep& step) {
  if (step.command == "key") press(step.words[0], false);
  if (step.command == "click") {
    button(pointer_x_, pointer_y_, true);
    button(pointer_x_, pointer_y_, false);
  }
  if (step.command == "drag") button(pointer_x_, pointer_y_, false);
  if (step.command == "measure") window_.times().begin(process_cpu_seconds());
  if (step.command == "report") write_text(step.words[0], window_.times().report(process_cpu_seconds()));
  if (step.command == "screenshot") window_.save_screenshot(step.words[0]);
  if (step.command == "save" && has_ending(step.words[0], ".json"))
    session_.save_scene(step.words[0]);
  else if (step.command == "save")
    session_.save_picture(step.words[0]);
  if (step.command == "explanation") print(session_.card() ? session_.card()->text : "no pixel was clicked\n");
  if (step.command != "hash") return;
  const Image& image = session_.picture()->frame.color;
  print("sha256:" + session_.hash() + "  " + std::to_string(image.width) + 'x' + std::to_string(image.height) + "  " +
        std::string(info(image.format).name) + '\n');
}

}  // namespace trueshade::viewer
