#include "shading/overlay.h"

#include <algorithm>
#include <cstring>

#include "core/fp_env.h"
#include "core/image_rows.h"
#include "shading/draw_frame.h"

namespace trueshade {
namespace {

bool passes(DepthFunc func, float z, float there) {
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
  Frame frame = draw_frame(PreparedScene(over), plain, execution, planes, false, {});
  Overlay out{std::move(frame.aovs[1].image), std::move(frame.aovs[2].image)};
  const Image& near = frame.aovs[0].image;
  parallel_for((depth.height + kRowsOfBand - 1) / kRowsOfBand, execution.threads, [&](int band) {
    std::vector<float> z(size_t(depth.width)), there(size_t(depth.width));
    for (int y = band * kRowsOfBand; y < std::min((band + 1) * kRowsOfBand, depth.height); ++y) {
      read_row(near, y, 1, z.data());
      read_row(depth, y, 1, there.data());
      for (int x = 0; x < depth.width; ++x)
        if (!passes(pipeline.geometry.depth_func, z[size_t(x)], there[size_t(x)]))
          std::memset(out.object.texel(x, y), 0, 4);
    }
  });
  return out;
}

}  // namespace trueshade
