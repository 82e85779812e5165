#pragma once
#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "explain/account.h"
#include "view/frame_maker.h"

namespace trueshade::viewer {

/// A light that adds something to a pixel.
struct AddedLight {
  uint32_t light;
  glm::vec3 term;  ///< what it adds: R, G, B
};

/// All that is known of a pixel that was clicked.
struct PixelCard {
  int x = 0, y = 0;                ///< from the top left
  uint64_t revision = 0;           ///< of the state it was clicked in
  uint32_t word = 0;               ///< as the screen shows it, 0x00RRGGBB
  Account account;                 ///< the step of docs/explain.md
  std::string text;                ///< what `trueshade explain` prints
  std::vector<AddedLight> lights;  ///< of the visible surface, the strongest first
  bool has_surface = false;
  glm::vec3 position{0.0f};  ///< of the visible surface, world space
};

/// Explains a pixel of the lit picture, whatever view is shown. Error(usage) for one that is not in it.
PixelCard pixel_card(const EditedScene& scene, const DrawnPicture& picture, int x, int y);

}  // namespace trueshade::viewer
