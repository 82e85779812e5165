#pragma once
// How far textured planes are from nominal, pixel by pixel, and what each cause would make of them.
#include <span>
#include <string_view>
#include <vector>

#include "judge/legal/surface_values.h"
#include "judge/legal/texel_changes.h"
#include "judge/stages/cause_fit.h"
#include "judge/stages/verdict.h"
#include "oracle/capture.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade::oracle {

/// How far one plane's channels are from nominal at the textured pixels of one material.
struct TextureDeviations {
  uint32_t material = 0;
  std::string_view plane;         ///< `albedo`, `albedo.A`, `specular`, `emission`, `emission.A`, `normal`
  std::vector<MaterialMap> maps;  ///< those of the material: each has kTexelCauses in the deviations' causes, in order
  std::vector<Deviation> list;    ///< in the order of the pixels
};

/// How far textured pixels are from nominal, by material and plane, and how far one unit of each cause would move them.
/// Leaves out pixels whose nearest texel is in doubt, and values that a format clamps.
///   profile: as resolved() returns it
///   way: how all lookups are made
std::vector<TextureDeviations> texture_deviations(const Scene& scene, const Pipeline& pipeline, const Profile& profile,
                                                  const Capture& capture, std::span<const TexturedPixel> textured,
                                                  const TexelWay& way);

}  // namespace trueshade::oracle
