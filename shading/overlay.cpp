#include "shading/overlay.h"

#include <cstring>

#include "shading/derived_planes.h"
#include "shading/draw_frame.h"

namespace trueshade {
namespace {

bool passes(DepthFunc func, double z, double there) {
  switch (func) {
    case DepthFunc::never:
      return false;
    case DepthFunc::less:
      return z < there;
    case DepthFunc::equal:
      return z == there;
    case DepthFunc::lequal:
      return z <= there;
    case DepthFunc::greater:
      return z > there;
    case DepthFunc::notequal:
      return z != there;
    case DepthFunc::gequal:
      return z >= there;
    case DepthFunc::always:
      return true;
  }
  return false;
}

}  // namespace

Overlay overlay(const Scene& over, const Pipeline& pipeline, const Execution& execution, const Image& depth) {
  Pipeline plain = pipeline;
  plain.geometry.cull_face = CullFace::back;
  plain.gbuffer.albedo = {Format::rgba32f, Interpolation::smooth};
  const std::string planes[] = {"depth", "albedo", "id.object"};
  Frame frame = draw_frame(PreparedScene(over), plain, execution, planes, {});
  Overlay out{std::move(frame.aovs[1].image), std::move(frame.aovs[2].image)};
  for (int y = 0; y < depth.height; ++y)
    for (int x = 0; x < depth.width; ++x)
      if (!passes(pipeline.geometry.depth_func, frame.aovs[0].image.value(x, y, 0), depth.value(x, y, 0)))
        std::memset(out.object.texel(x, y), 0, 4);
  return out;
}

}  // namespace trueshade
