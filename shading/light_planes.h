#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/image.h"
#include "raster/visibility.h"
#include "scenes/scene.h"
#include "shading/light_pass.h"

namespace trueshade {

/// The i of a plane `light.<i>`, written without leading zeros; nothing for other names.
std::optional<size_t> light_of_plane(std::string_view name);

/// What each of some lights alone adds to the pixels within its extent: the planes `light.<i>`, rgb32f. Their f32 sums
/// in index order, from +0, are what a loop over all lights comes to before it is stored, bit for bit.
class LightPlanes {
 public:
  LightPlanes(std::span<const std::string> planes, const Scene& scene, const Pipeline& pipeline);

  /// Draws a tile of each plane; `planes` are those of the constructor, in order. `work` and `color` are scratch.
  void draw(const SurfaceTile& surface, const TileRect& rect, bool culling, bool compiled, LightLists& work,
            ColorTile& color, std::span<NamedImage> planes) const;

 private:
  struct Plane {
    size_t index;
    LightTable light;
  };
  std::vector<Plane> planes_;
  LightModel model_;
};

}  // namespace trueshade
