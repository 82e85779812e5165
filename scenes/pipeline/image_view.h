#pragma once
#include <cstdint>
#include <optional>
#include <string_view>

namespace trueshade {

/// What the image shows: the lit picture, or what it is made of in colours to look at (docs/views.md).
enum class ImageView : uint8_t {
  lit,
  albedo,
  specular,
  depth,
  normal,
  position,
  uv,
  light_count,
  light_tile,
  light_boxes,
  light_edges,
  overdraw
};

/// Spelling on the command line and in JSON, in the order of the values.
inline constexpr std::string_view kViewNames[] = {"lit",        "albedo",      "specular",    "depth",
                                                  "normal",     "position",    "uv",          "light-count",
                                                  "light-tile", "light-boxes", "light-edges", "overdraw"};

/// The view of that name, or nothing.
constexpr std::optional<ImageView> view_from_name(std::string_view name) {
  for (size_t i = 0; i < std::size(kViewNames); ++i)
    if (kViewNames[i] == name) return ImageView(i);
  return std::nullopt;
}

}  // namespace trueshade
