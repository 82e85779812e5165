#pragma once
#include <SDL.h>

#include <functional>
#include <set>

#include "view/camera_controls.h"
#include "view/keys.h"

namespace trueshade::viewer {

/// Events of the window as what they mean: for ImGui where a panel is used, else for the camera and the session.
class WindowInput {
 public:
  struct Handlers {
    std::function<void(Action)> act;
    std::function<void(int x, int y)> click;  ///< of the left button without a drag, in the window
    std::function<void(double steps)> wheel;
  };
  WindowInput(SDL_Window* window, Handlers handlers);  ///< sets up ImGui's keys and clipboard

  void take(const SDL_Event& event);
  /// What has moved the camera since the last call, and what moves it now. `radians`: of a pixel of dragging.
  CameraInput camera_input(double radians);
  void begin_ui_frame(int width, int height, double seconds);  ///< tells ImGui's input
  bool holds() const { return !held_.empty() || drags(); }
  bool drags() const { return drag_ != Drag::none; }

 private:
  enum class Drag : uint8_t { none, look, orbit };
  void take_key(const SDL_KeyboardEvent& key);
  void take_button(const SDL_MouseButtonEvent& button);
  void take_motion(const SDL_MouseMotionEvent& motion);
  void take_wheel(double steps);
  void let_go();

  SDL_Window* window_;
  Handlers handlers_;
  std::set<Action> held_;
  Drag drag_ = Drag::none;
  uint8_t drag_button_ = 0;
  int pressed_x_ = 0, pressed_y_ = 0;
  bool moved_ = false;  // since the button was pressed
  glm::dvec2 dragged_{0.0};
  double nearer_ = 0.0;
  bool buttons_[3] = {}, pressed_[3] = {};  // left, right, middle; pressed since the last frame
  float pointer_x_ = -1e9f, pointer_y_ = -1e9f;
};

}  // namespace trueshade::viewer
