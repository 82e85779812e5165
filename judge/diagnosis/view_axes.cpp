#include "judge/diagnosis/view_axes.h"

#include "oracle/matrices.h"

namespace trueshade::oracle {

std::array<Triple3, 3> view_axes(const Camera& camera, const Pipeline& pipeline) {
  const GeometryState& g = pipeline.geometry;
  const Matrix4 clip = projection_of(camera, g, pipeline.width, pipeline.height);
  Triple3 back = view_axis(clip);
  const bool has_eye = clip[3] != 0 || clip[7] != 0 || clip[11] != 0;
  const bool farther_is_less = g.depth_func == DepthFunc::greater || g.depth_func == DepthFunc::gequal;
  if (!has_eye && farther_is_less && g.depth_near <= g.depth_far) back = times(back, -1);
  const auto across = [&](size_t row, double turned) {
    const Triple3 r = times({clip[row], clip[4 + row], clip[8 + row]}, turned);
    return unit(minus(r, times(back, inner(r, back))));
  };
  return {across(0, 1), across(1, g.clip_origin == ClipOrigin::upper_left ? -1 : 1), back};
}

}  // namespace trueshade::oracle
