#pragma once
// Wrong renderers of lights drawn one by one: what each makes of the target after each light.
#include <functional>
#include <span>

#include "tests/judge/mutants/mutants.h"

namespace trueshade::oracle {

/// The target after each light, of a right renderer. Borrows the scene.
using StepRenderer = std::function<LightSteps(const Scene&, const Pipeline&)>;

struct BlendMutant {
  std::string_view name;
  Latitude latitude = Latitude::none;
  void (*base)(Scene&,
               Pipeline&) = nullptr;  ///< what right and wrong renderer are both given, where not the scene as it is
  std::vector<Image> (*wrong)(const Scene&, const Pipeline&,
                              const StepRenderer&) = nullptr;  ///< before the first light, then after each
};

/// Sixteen of them. Each is for the strategies that it changes; of others its images are the right ones.
std::span<const BlendMutant> blend_mutants();

/// All steps as images: before the first light, then after each.
std::vector<Image> images_of(const LightSteps& steps);
/// And back.
LightSteps steps_from(std::span<const Image> images);

}  // namespace trueshade::oracle
