#pragma once
// Wrong renderers of transparent surfaces.
#include "tests/judge/mutants/blend_mutants.h"

namespace trueshade::oracle {

/// Glass before the camera: three panes, one of them with maps and one that stands in the scene, and a ball; a light
/// model that leaves nothing of the lights' order open.
void add_glass(Scene& scene);

struct GlassMutant {
  std::string_view name;
  Latitude latitude = Latitude::none;
  void (*input)(Scene&, Pipeline&) = nullptr;                                  ///< what the wrong one is given
  Capture (*wrong)(const Scene&, const Pipeline&, const Renderer&) = nullptr;  ///< or what it makes of several pictures
};

/// Thirteen of them.
std::span<const GlassMutant> glass_mutants();

}  // namespace trueshade::oracle
