#include "scenes/presets.h"

#include <array>

namespace trueshade {
namespace {

Preset many_lights() {
  return {"many-lights",
          "Trueshade's own: Blinn-Phong with a linear window, as in light-volume renderers "
          "(max(0, 1 - d/range) * max(0, N.L)), over an rgba8 albedo plane",
          Pipeline{}};
}

Preset touchdesigner() {
  Pipeline p;
  p.preset = "touchdesigner";
  p.gbuffer.albedo.format = Format::rgba32f;
  p.light_model.renormalize = false;      // the shader uses the texel as it was stored
  p.light_model.specular_masked = false;  // the seed adds the specular term whatever N.L is
  p.light_model.shininess = 32.0f;
  p.light_model.specular_color = glm::vec3(0.5f);
  p.light_model.falloff = Falloff::quadratic;
  p.light_model.order = TermOrder::separate;
  p.light_model.alpha_from_albedo = true;
  p.target = Format::rgba8;
  return {"touchdesigner", "TouchDesigner Deferred Lighting - Point Lights (tutorial), its combine shader", p};
}

}  // namespace

std::span<const Preset> presets() {
  static const std::array<Preset, 2> rows{many_lights(), touchdesigner()};
  return rows;
}

std::optional<Pipeline> preset_pipeline(std::string_view name) {
  for (const Preset& row : presets())
    if (row.name == name) return row.pipeline;
  return std::nullopt;
}

}  // namespace trueshade
