#pragma once
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <span>

#include "scenes/scene.h"

namespace trueshade {

/// What is made of one light of a scene that another scene file refers to, or that a viewer shows.
struct LightChange {
  uint32_t light = 0;                      ///< index into Scene::lights
  bool on = true;                          ///< otherwise it gives no light: colour and ambient share are 0
  std::optional<glm::vec3> color = {};     ///< linear RGB times intensity, each in [0, 1e18]; replaces the colour
  std::optional<double> intensity = {};    ///< in [0, 1e18]; multiplies the colour
  std::optional<glm::vec3> position = {};  ///< scene units; point and spot

  bool operator==(const LightChange&) const = default;
};

/// Changes lights as the scene was loaded, before set_time(), one after the other. A colour or position that is
/// replaced does not move any more; an intensity multiplies the colour at every time. Numbers are not checked:
/// validate() does that. Passes over lights that are not there. Takes time by the number of changes and of all that
/// moves, not by their product.
void change_lights(Scene& scene, std::span<const LightChange> changes);

}  // namespace trueshade
