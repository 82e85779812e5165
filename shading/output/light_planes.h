#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/image.h"
#include "raster/visibility/visibility.h"
#include "scenes/scene.h"
#include "shading/blend/blend_pass.h"
#include "shading/sum/light_pass.h"

namespace trueshade {

/// The i of a plane `light.<i>`, written without leading zeros; nothing for other names.
std::optional<size_t> light_of_plane(std::string_view name);

/// The planes `light.<i>`, rgb32f: what a single light adds to each pixel, as often as the strategy draws the light
/// there. Their f32 sums in index order, from what pixels hold before any light, are bit for bit what a loop over all
/// lights comes to before it is stored, and what draws leave that are added into floats, where none lights a pixel
/// twice (docs/views.md).
class LightPlanes {
 public:
  /// program: of the frame, or null
  LightPlanes(std::span<const std::string> planes, const Scene& scene, const Pipeline& pipeline,
              const ProgramFrame* program, const LightMeshes& meshes, const View& view);

  /// Draws a tile of each plane for strategies that sum; `planes` are those of the constructor, in order. `of_target`:
  /// the shortcuts of the target, of which those that keep sums as they are hold here. `work` and `color` are scratch.
  void sum(const SurfaceTile& surface, const TileRect& rect, const LightShortcuts& of_target, LightLists& work,
           ColorTile& color, std::span<NamedImage> planes) const;

  /// The same for strategies that blend. `frame`: the draws of all lights; `tied`: as blend_tile() takes it.
  void blend(const LightVolumeDraws& frame, const SurfaceTile& surface, const TiedFragments* tied, const TileRect& rect,
             BlendWork& work, ColorTile& color, std::span<NamedImage> planes) const;

 private:
  struct Plane {
    size_t index, light;
    std::span<const Light> alone;
    LightTable table;
    LightOutlines outlines;  ///< of strategies that blend
  };
  std::vector<Plane> planes_;
  LightModel model_;
};

}  // namespace trueshade
