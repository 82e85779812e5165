#include "view/session.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "scenes/pipeline/presets.h"
#include "scenes/pipeline/program_inputs.h"
#include "scenes/pipeline/shipped_models.h"
#include "view/saved_files.h"

namespace trueshade::viewer {
namespace {

constexpr double kNoticeSeconds = 4.0, kProblemSeconds = 12.0;
constexpr double kLookSeconds = 0.25;  // between two looks at the files of the scene

template <typename Enum, size_t n>
Enum next_of(Enum value, const std::string_view (&)[n]) {
  return Enum((size_t(value) + 1) % n);
}

}  // namespace

Session::Session(SceneSource source, OpenedScene opened, const Execution& execution, std::function<void()> news)
    : source_(std::move(source)),
      facts_(std::move(opened.facts)),
      base_pipeline_(facts_.pipeline),
      maker_(std::move(opened.scene), execution, std::move(news)) {
  state_.pipeline = facts_.pipeline;
  state_.looks = facts_.looks;
  watch_.watch(facts_.files);
  if (const LightProgram& program = facts_.pipeline.light_program; program.used()) {
    if (!names_shipped_model(program.file)) model_watch_.watch({model_file_ = program.file});
    ReadyModel model = ready_model(program);
    check_given(program, model.inputs, model.declared);
    use(std::move(model));
  }
  changed();
}

void Session::changed() {
  ++state_.revision;
  maker_.ask(state_);
}

void Session::tell(std::string text, bool problem) {
  if (problem) problems_.push_back(text);
  notice_ = {std::move(text), problem, clock_ + (problem ? kProblemSeconds : kNoticeSeconds)};
}

void Session::set_preset(std::string_view name) {
  Pipeline pipeline = *preset_pipeline(name);
  pipeline.width = state_.pipeline.width, pipeline.height = state_.pipeline.height;
  pipeline.view = state_.pipeline.view;
  if (draws_by_its_preset(state_.pipeline)) {
    use_program(pipeline.light_program);
  } else {  // a model that the user has chosen stays
    pipeline.light_program = state_.pipeline.light_program;
    if (pipeline.light_program.used()) pipeline.light_volumes = state_.pipeline.light_volumes;
  }
  set_pipeline(pipeline);
}

void Session::set_pipeline(const Pipeline& pipeline) {
  validate(pipeline);
  state_.pipeline = pipeline;
  changed();
}

void Session::set_exposure(double stops) {
  if (state_.pipeline.light_program.used()) return tell("a light model has no exposure; it may have parameters");
  state_.exposure = std::clamp(stops, -kMostStops, kMostStops);
  changed();
}

void Session::set_size(int width, int height) {
  if (width == state_.pipeline.width && height == state_.pipeline.height) return;
  for (Pipeline* pipeline : {&state_.pipeline, &base_pipeline_}) pipeline->width = width, pipeline->height = height;
  changed();
}

void Session::set_time(double seconds) {
  state_.time = std::clamp(seconds, -kLatestTime, kLatestTime);
  changed();
}

void Session::set_camera(const Camera& camera) {
  controls_.emplace(camera, facts_.reach);
  state_.camera = camera.clip_from_world ? controls_->camera() : camera;  // to the bit, until somebody flies
  changed();
}

void Session::change_light(const LightChange& change) {
  if (change.light >= facts_.lights.size())
    throw Error(ErrorKind::bad_input, "light", "there is no light " + std::to_string(change.light),
                "there are " + std::to_string(facts_.lights.size()) + ", from 0");
  std::erase_if(state_.changes, [&](const LightChange& known) { return known.light == change.light; });
  if (change != LightChange{change.light}) state_.changes.push_back(change);
  changed();
}

void Session::reset_light(uint32_t light) { change_light({light}); }

void Session::reset_lights() {
  state_.changes.clear();
  changed();
}

const LightChange* Session::change_of(uint32_t light) const {
  const auto found = std::find_if(state_.changes.begin(), state_.changes.end(),
                                  [light](const LightChange& change) { return change.light == light; });
  return found == state_.changes.end() ? nullptr : &*found;
}

/// From where the picture that is shown was seen; before the first picture, from where none is.
const CameraControls& Session::controls() const {
  const std::shared_ptr<const DrawnPicture> picture = maker_.newest();
  if (!controls_ || !state_.camera) controls_.emplace(picture ? picture->camera : Camera(), facts_.reach);
  return *controls_;
}

CameraControls& Session::take_camera() {
  controls();
  return *controls_;
}

void Session::change_speed(double steps) {
  CameraControls& own = take_camera();
  own.change_speed(steps);
  state_.camera = own.camera();
  changed();
}

void Session::set_field_of_view(double radians) {
  CameraControls& own = take_camera();
  own.set_field_of_view(radians);
  state_.camera = own.camera();
  changed();
}

void Session::go_home() {
  state_.camera.reset();
  controls_.reset();
  changed();
}

void Session::look_at_pixel() {
  if (!card_ || !card_->has_surface) return tell("click a surface first, then F looks at it");
  CameraControls& own = take_camera();
  own.set_pivot(glm::dvec3(card_->position));
  state_.camera = own.camera();
  changed();
}

void Session::act(Action action) {
  Pipeline pipeline = state_.pipeline;
  switch (action) {
    case Action::home:
      return go_home();
    case Action::look_at_pixel:
      return look_at_pixel();
    case Action::play:
      if (!has_time()) return tell("nothing moves in this scene");
      return play(!plays_);
    case Action::step_back:
      return set_time(state_.time - 1.0 / facts_.fps);
    case Action::step_ahead:
      return set_time(state_.time + 1.0 / facts_.fps);
    case Action::next_view:
      pipeline.view = next_of(pipeline.view, kViewNames);
      return set_pipeline(pipeline);
    case Action::lit_view:
      pipeline.view = ImageView::lit;
      return set_pipeline(pipeline);
    case Action::next_preset: {
      const auto all = presets();
      const auto now = std::find_if(all.begin(), all.end(), [&](const Preset& p) { return p.name == pipeline.preset; });
      return set_preset(now == all.end() || now + 1 == all.end() ? all.front().name : (now + 1)->name);
    }
    case Action::brighter:
      return set_exposure(state_.exposure + 0.5);
    case Action::darker:
      return set_exposure(state_.exposure - 0.5);
    case Action::save_picture:
      return save_picture();
    case Action::save_scene:
      return save_scene();
    case Action::reload:
      return reload();
    default:
      return act_on_desk(action);
  }
}

void Session::act_on_desk(Action action) {
  const auto toggle = [this](Panel panel) {
    desk_.panel = desk_.panel == panel && !desk_.hidden ? Panel::none : panel;
    desk_.hidden = false;
  };
  switch (action) {
    case Action::help:
      desk_.help = !desk_.help;
      return;
    case Action::picture_panel:
      return toggle(Panel::picture);
    case Action::lights_panel:
      return toggle(Panel::lights);
    case Action::pixel_panel:
      return toggle(Panel::pixel);
    case Action::statistics_panel:
      return toggle(Panel::statistics);
    case Action::model_panel:
      return toggle(Panel::model);
    case Action::hide_panels:
      desk_.hidden = !desk_.hidden;
      return;
    case Action::full_screen:
      desk_.full_screen = !desk_.full_screen;
      return;
    case Action::close:
      if (desk_.help)
        desk_.help = false;
      else
        desk_.panel = Panel::none;
      return;
    case Action::quit:
      desk_.ends = true;
      return;
    default:  // held keys: CameraInput
      return;
  }
}

double Session::last_time() const { return facts_.moves ? facts_.last_time : kLongestTime; }

bool Session::moves() const { return (plays_ && has_time()) || (controls_ && state_.camera && controls_->flies()); }

void Session::pass(const CameraInput& input, double seconds) {
  clock_ += seconds;
  bool moved = false;
  if (plays_ && has_time()) {
    state_.time += seconds;
    if (state_.time > last_time()) state_.time = 0.0;
    moved = true;
  }
  if (!input.rests() || (controls_ && state_.camera && controls_->flies())) {
    CameraControls& own = take_camera();
    own.step(input, seconds);
    state_.camera = own.camera();
    moved = true;
  }
  if (moved) changed();
  receive();
  watch_files();
  if (notice_ && notice_->until < clock_) notice_.reset();
}

void Session::receive() {
  for (const FrameMaker::Mail& mail : maker_.take_mail()) mail();
  if (std::optional<std::string> problem = maker_.take_problem()) {
    asks_card_ = false;
    tell(*problem, true);
  }
}

void Session::watch_files() {
  if (clock_ < next_look_) return;
  next_look_ = clock_ + kLookSeconds;
  if (watch_.changed(SourceWatch::Clock::now())) reload();
  if (model_watch_.changed(SourceWatch::Clock::now())) reload_model();
}

void Session::reload() {
  watch_.watch(watch_.paths());  // what changes from here on calls for another time
  maker_.replace([this, source = source_] {
    std::vector<std::string> files;
    try {
      OpenedScene opened = opened_scene(source, files);
      auto facts = std::make_shared<SceneFacts>(std::move(opened.facts));
      maker_.post([this, facts] { take_over(std::move(*facts)); });
      return std::move(opened.scene);
    } catch (...) {
      maker_.post([this, files] { watch_.watch(files); });  // one that was not read before may be what is wrong
      throw;
    }
  });
}

void Session::take_over(SceneFacts facts) {
  Pipeline base = facts.pipeline;
  base.width = base_pipeline_.width, base.height = base_pipeline_.height;
  if (draws_by_its_preset(base) && draws_by_its_preset(base_pipeline_))
    use_program(base.light_program);
  else
    base.light_program = base_pipeline_.light_program;            // which is loaded by itself
  if (state_.pipeline == base_pipeline_) state_.pipeline = base;  // the user has not changed it
  base_pipeline_ = base;
  std::erase_if(state_.changes, [&](const LightChange& change) { return change.light >= facts.lights.size(); });
  if (desk_.selected_light && *desk_.selected_light >= facts.lights.size()) desk_.selected_light.reset();
  facts_ = std::move(facts);
  state_.looks = facts_.looks;
  plays_ = plays_ && has_time();
  card_.reset();
  watch_.watch(facts_.files);
  changed();
  tell("loaded " + facts_.spec + " anew");
}

void Session::click(int x, int y) {
  asks_card_ = true;
  maker_.send([this, x, y](EditedScene& scene, const DrawnPicture& picture) {
    auto card = std::make_shared<PixelCard>(pixel_card(scene, picture, x, y));
    maker_.post([this, card] {
      card_ = std::move(*card);
      asks_card_ = false;
    });
  });
}

std::string Session::written(const std::function<std::string()>& write) {
  try {
    return write();
  } catch (const Error& error) {
    maker_.post([this, error] { failed_save_ = error; });
    throw;
  }
}

void Session::save_picture(const std::string& path) {
  maker_.send([this, path, name = facts_.name](EditedScene& scene, const DrawnPicture& picture) {
    std::string told = written([&] { return write_picture(path, name, scene, picture); });
    maker_.post([this, told = std::move(told)] { tell(told); });
  });
}

void Session::save_scene(const std::string& path) {
  maker_.send([this, path, facts = facts_](EditedScene&, const DrawnPicture& picture) {
    std::string told = written([&] { return write_scene(path, facts, picture); });
    maker_.post([this, told = std::move(told)] { tell(told); });
  });
}

}  // namespace trueshade::viewer
