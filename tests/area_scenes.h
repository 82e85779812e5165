#pragma once
#include <string_view>

#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

// Scenes under lights with an area.
namespace trueshade::testing {

inline constexpr std::string_view kAreaScenes[] = {"box", "mixed", "city", "columns", "papered"};

/// By name:
///   box      Cornell's box under a light of each kind, of infinite range; many pixels see only a part of a light
///   mixed    the same with ranges, among lights of the other types
///   city     blocks under rectangles above the streets, with ranges
///   columns  a curved, glossy object among tubes and spheres of many colours
///   papered  a room with normal maps and textures under disks, some at its walls
Scene area_scene(std::string_view name);

/// glTF's preset, lit by a light model that ships.
Pipeline area_pipeline(std::string_view model, int width, int height);

}  // namespace trueshade::testing
