#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.h"
#include "view/camera_controls.h"
#include "view/frame_maker.h"
#include "view/frame_times.h"
#include "view/keys.h"
#include "view/light_model.h"
#include "view/pixel_card.h"
#include "view/scene_source.h"
#include "view/source_watch.h"

namespace trueshade::viewer {

enum class Panel : uint8_t { none, picture, lights, pixel, statistics, model };
inline constexpr std::string_view kPanelNames[] = {"none", "picture", "lights", "pixel", "statistics", "model"};

inline constexpr double kMostStops = 16.0;  ///< of exposure, either way

/// A line that tells what happened.
struct Notice {
  std::string text;
  bool problem = false;
  double until = 0.0;  ///< seconds of the session's clock
};

/// What is open in the window, beside the picture.
struct Desk {
  Panel panel = Panel::none;
  bool help = false, hidden = false, full_screen = false, ends = false;
  std::optional<uint32_t> selected_light;
};

/// A window's work without the window: what is shown, how it changes, what is saved. All of it happens in one thread;
/// the frames are made in another.
class Session {
 public:
  /// `news`: see FrameMaker.
  Session(SceneSource source, OpenedScene opened, const Execution& execution, std::function<void()> news);

  // What is shown. Each sets it and asks for a picture.
  void set_preset(std::string_view name);
  void set_pipeline(const Pipeline& pipeline);  ///< any values but the size; Error where they are not valid
  void set_exposure(double stops);
  /// Draws by a light model that ships, by the file that was given, or by the preset's formula: an empty name.
  void set_model(const std::string& name);
  void set_parameter(const std::string& name, const std::vector<float>& value);  ///< of the light model
  void set_size(int width, int height);
  void set_time(double seconds);
  void set_camera(const Camera& camera);
  void change_light(const LightChange& change);  ///< takes the place of the light's earlier change
  void reset_light(uint32_t light);
  void reset_lights();
  void play(bool on) { plays_ = on; }
  void change_speed(double steps);
  void go_home();
  void set_field_of_view(double radians);

  void act(Action action);  ///< of keys that are pressed, not held
  /// Lets `seconds` pass: time that plays, flight, what the maker has sent, files that changed.
  void pass(const CameraInput& input, double seconds);
  bool moves() const;  ///< whether something changes by itself, so that time has to pass

  void click(int x, int y);  ///< asks for the card of a pixel of the picture
  void save_picture(const std::string& path);
  void save_scene(const std::string& path);
  void save_picture() { save_picture({}); }  ///< under the hash, in the current folder
  void save_scene() { save_scene({}); }      ///< beside the scene's file, or in the current folder
  void reload();

  const SceneFacts& facts() const { return facts_; }
  const ViewState& state() const { return state_; }
  bool has_time() const { return facts_.moves || model_reads_time_; }  ///< whether the picture changes with it
  double last_time() const;                                            ///< seconds, where it begins anew
  bool plays() const { return plays_; }
  Desk& desk() { return desk_; }
  const std::optional<PixelCard>& card() const { return card_; }
  const std::string& model_file() const { return model_file_; }  ///< of --light-shader; empty: none was given
  const std::vector<ModelParameter>& parameters() const { return parameters_; }
  const std::optional<BrokenModel>& broken_model() const { return broken_model_; }  ///< as that file is now
  uint64_t model_revision() const { return model_revision_; }  ///< another number when the last two may have changed
  const LightChange* change_of(uint32_t light) const;
  double speed() const { return controls().speed(); }
  double field_of_view() const { return controls().field_of_view(); }
  std::shared_ptr<const DrawnPicture> picture() const { return maker_.newest(); }
  std::string hash() const { return maker_.hash_of(state_.revision); }  ///< of what is shown, once it is still
  bool waits() const { return maker_.busy() || asks_card_; }
  bool is_refused() const { return maker_.is_refused(state_.revision); }  ///< what is asked for cannot be drawn
  const std::optional<Notice>& notice() const { return notice_; }
  void tell(std::string text, bool problem = false);
  double clock() const { return clock_; }
  std::vector<std::string> take_problems() { return std::exchange(problems_, {}); }  ///< for standard error
  const std::optional<Error>& failed_save() const { return failed_save_; }           ///< the last one

 private:
  void changed();
  void look_at_pixel();
  void act_on_desk(Action action);  // of panels and the window, which change no picture
  const CameraControls& controls() const;
  CameraControls& take_camera();
  void receive();
  void watch_files();
  void use(ReadyModel model);
  void use_program(const LightProgram& program);
  void reload_model();
  void take_model(ReadyModel model);
  std::string written(const std::function<std::string()>& write);
  void take_over(SceneFacts facts);

  SceneSource source_;
  SceneFacts facts_;
  ViewState state_;
  Pipeline base_pipeline_;                          // of the file's layers, at the picture's size
  mutable std::optional<CameraControls> controls_;  // made when they are first needed
  bool plays_ = false, asks_card_ = false;
  Desk desk_;
  std::optional<PixelCard> card_;
  std::optional<Notice> notice_;
  std::vector<std::string> problems_;
  std::optional<Error> failed_save_;
  std::string model_file_;
  std::vector<ModelParameter> parameters_;
  std::optional<BrokenModel> broken_model_;
  uint64_t model_revision_ = 0;
  std::vector<std::string> model_inputs_, model_declared_;
  bool model_reads_time_ = false;
  SourceWatch watch_, model_watch_;
  double clock_ = 0.0, next_look_ = 0.0;
  FrameMaker maker_;
};

}  // namespace trueshade::viewer
