#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "scenes/scene.h"

namespace trueshade {

/// A built-in scene as `trueshade list` shows it.
struct BuiltinInfo {
  std::string_view name;         ///< without `builtin:`
  std::string_view description;  ///< one line
};

/// All built-in scenes, in the order of `trueshade list`.
std::span<const BuiltinInfo> builtin_scenes();

/// `NAME[,key=value...]`, keys lights, seed, objects, glass=0|1, radius=overlap|constant. Generated from the seed by
/// integers and
/// + - * / sqrt alone: the same bits on every CPU. Error(bad_input) for an unknown name, key or value; Error(limit).
Scene builtin_scene(std::string_view spec, const SceneLimits& limits = {});

}  // namespace trueshade
