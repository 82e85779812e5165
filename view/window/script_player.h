#pragma once
#include <chrono>
#include <vector>

#include "view/script.h"
#include "view/window/window.h"

namespace trueshade::viewer {

/// Does in a window what a script says, step by step, as hands would: keys and mouse are events of the window.
class ScriptPlayer {
 public:
  ScriptPlayer(std::vector<ScriptStep> steps, std::string where, Session& session, Window& window);

  /// Goes on as far as it can without waiting. Throws Error where a step cannot be done.
  void play();
  bool ended() const { return next_ == steps_.size(); }
  /// How long the window may wait before play() is called again.
  std::chrono::milliseconds patience() const { return std::chrono::milliseconds(ended() ? 1000 : 4); }

 private:
  using Clock = std::chrono::steady_clock;
  bool begin(const ScriptStep& step);  // whether it is over at once
  bool is_over(const ScriptStep& step);
  void end(const ScriptStep& step);
  bool set(const ScriptStep& step);  // whether it was a step that sets a value
  void change_light(const ScriptStep& step);
  void press(const std::string& key, bool down);
  void move_to(int x, int y);
  void button(int x, int y, bool down);
  bool is_still() const;
  void check_becomes_still(const ScriptStep& step) const;
  void drag_on(const ScriptStep& step, double part);

  const std::vector<ScriptStep> steps_;
  const std::string where_;
  Session& session_;
  Window& window_;
  size_t next_ = 0;
  bool begun_ = false;
  Clock::time_point begin_;
  int pointer_x_ = 0, pointer_y_ = 0;
};

}  // namespace trueshade::viewer
