#pragma once
#include <SDL.h>

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "view/frame_times.h"
#include "view/session.h"
#include "view/window/placement.h"
#include "view/window/style.h"
#include "view/window/ui_raster.h"
#include "view/window/window_input.h"

namespace trueshade::viewer {

/// SDL's video, for as long as it lives. Error(io) in one line where there is no display.
class Display {
 public:
  Display();
  ~Display();
  Display(const Display&) = delete;
  Display& operator=(const Display&) = delete;

  void wake() const;  ///< ends a wait for events; from any thread
  uint32_t wake_event() const { return wake_event_; }
  double text_scale() const;  ///< 1 of 96 dots an inch or fewer; steps of a quarter

 private:
  uint32_t wake_event_ = 0;
};

/// The window of a session: events in, pictures and panels out. It draws into the window's own memory, so that it needs
/// neither OpenGL nor a GPU.
class Window {
 public:
  struct Look {
    int width, height;   ///< of the window at first
    bool fixed_picture;  ///< the picture keeps its size, whatever the window's
    double scale;        ///< of texts and panels
  };
  Window(const Display& display, Session& session, const Look& look);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// Waits for what happens next, at most so long, lets time pass and shows what has changed. Whether it goes on.
  bool step(std::chrono::milliseconds longest);

  void save_screenshot(const std::string& path);  ///< of what is shown, .png
  void set_size(int width, int height);
  uint64_t shown_revision() const { return shown_ ? shown_->state.revision : 0; }
  FrameTimes& times() { return times_; }
  uint32_t id() const { return SDL_GetWindowID(window_); }
  void show_again() { frames_to_show_ = kSettlingFrames; }  ///< although nothing has changed
  CameraInput scripted{};                                   ///< added to what hands do, once

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr int kSettlingFrames = 3;  // that ImGui needs to lay out what has changed

  void take_events(std::chrono::milliseconds longest);
  void take(const SDL_Event& event);
  void fit_picture();
  PicturePlace place_of(const Image& image, int width, int height) const;
  void pass_time();
  void show();
  void draw_panels(const Canvas& canvas);
  void click(int x, int y);
  bool is_due() const;

  const Display& display_;
  Session& session_;
  const bool fixed_picture_;
  const double scale_;
  SDL_Window* window_ = nullptr;
  std::optional<WindowInput> input_;
  Fonts fonts_;
  FrameTimes times_;
  std::shared_ptr<const DrawnPicture> shown_;
  std::string shown_hash_;
  uint64_t shown_model_ = 0;
  Clock::time_point last_pass_, last_new_picture_, last_show_;
  std::chrono::duration<double> shortest_{1.0 / 125.0};  // from one picture to the next
  int frames_to_show_ = kSettlingFrames;
  bool full_screen_ = false, was_moving_ = false;
};

}  // namespace trueshade::viewer
