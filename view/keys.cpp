#include "view/keys.h"

#include <algorithm>
#include <string>

namespace trueshade::viewer {
namespace {

// The order is that of the page of keys.
constexpr Key kKeys[] = {
    {"w", Action::forward, true, "W A S D", "fly ahead, left, back, right"},
    {"a", Action::left, true},
    {"s", Action::back, true},
    {"d", Action::right, true},
    {"e", Action::up, true, "E  Q", "fly up, down"},
    {"q", Action::down, true},
    {"left shift", Action::faster, true, "Shift  Ctrl", "four times as fast, a quarter as fast"},
    {"right shift", Action::faster, true},
    {"left ctrl", Action::slower, true},
    {"right ctrl", Action::slower, true},
    {"home", Action::home, false, "Home", "the scene's own camera"},
    {"f", Action::look_at_pixel, false, "F", "look at the clicked pixel, and orbit about it"},
    {"space", Action::play, false, "Space", "play the time, or stop it"},
    {",", Action::step_back, false, ",  .", "a frame back, ahead"},
    {".", Action::step_ahead},
    {"v", Action::next_view, false, "V", "the next view: planes, light counts, overdraw"},
    {"l", Action::lit_view, false, "L", "the lit picture"},
    {"n", Action::next_preset, false, "N", "the next preset"},
    {"=", Action::brighter, false, "+  -", "half a stop brighter, darker"},
    {"+", Action::brighter},
    {"keypad +", Action::brighter},
    {"-", Action::darker},
    {"keypad -", Action::darker},
    {"1", Action::picture_panel, false, "1 2 3 4 5", "panels: picture, lights, pixel, statistics, model"},
    {"2", Action::lights_panel},
    {"3", Action::pixel_panel},
    {"4", Action::statistics_panel},
    {"5", Action::model_panel},
    {"tab", Action::hide_panels, false, "Tab", "hide everything but the picture"},
    {"f1", Action::help, false, "F1  ?", "this page"},
    {"?", Action::help},
    {"/", Action::help},
    {"f2", Action::save_picture, false, "F2", "save the picture; its name has the hash"},
    {"f3", Action::save_scene, false, "F3", "save a scene that draws this very picture"},
    {"f5", Action::reload, false, "F5", "load the scene anew; changed files do so by themselves"},
    {"f11", Action::full_screen, false, "F11", "full screen"},
    {"escape", Action::close, false, "Esc", "close what is open"},
    {"f10", Action::quit, false, "F10", "quit"},
};

}  // namespace

std::span<const Key> keys() { return kKeys; }

std::optional<Key> key_named(std::string_view name) {
  std::string small(name);
  std::transform(small.begin(), small.end(), small.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; });
  const auto found =
      std::find_if(std::begin(kKeys), std::end(kKeys), [&](const Key& key) { return key.name == small; });
  if (found == std::end(kKeys)) return std::nullopt;
  return *found;
}

}  // namespace trueshade::viewer
