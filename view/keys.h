#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace trueshade::viewer {

/// What keys do.
enum class Action : uint8_t {
  forward,
  back,
  left,
  right,
  up,
  down,
  faster,
  slower,
  home,
  look_at_pixel,
  play,
  step_back,
  step_ahead,
  next_view,
  lit_view,
  next_preset,
  brighter,
  darker,
  help,
  picture_panel,
  lights_panel,
  pixel_panel,
  statistics_panel,
  model_panel,
  hide_panels,
  save_picture,
  save_scene,
  reload,
  full_screen,
  close,
  quit,
};

/// A key by the name that scripts and SDL (SDL_GetKeyName) have for it, in small letters.
struct Key {
  std::string_view name;
  Action action;
  bool held = false;            ///< does something for as long as it is held
  std::string_view shown = {};  ///< on the page of keys; empty: not listed, as another key of the action is
  std::string_view about = {};
};
std::span<const Key> keys();

/// Letters in capitals are taken as small ones. Nothing for a key that does nothing.
std::optional<Key> key_named(std::string_view name);

}  // namespace trueshade::viewer
