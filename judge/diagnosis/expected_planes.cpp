#include "judge/diagnosis/expected_planes.h"

#include <mutex>

namespace trueshade::oracle {

ExpectedPlanes::ExpectedPlanes(const Scene& scene, const Pipeline& pipeline, const Profile& profile,
                               std::array<int, 2> drawn_at)
    : pipeline_(pipeline), projector_(scene, pipeline, profile, drawn_at), possible_(possible_surfaces(projector_)) {}

/// The surface that is nominally seen: of those that nominal vertices put there, the first in the depth test's order.
/// Null where there is none.
const PossibleSurface* ExpectedPlanes::seen(size_t pixel) const {
  const DepthFunc func = pipeline_.geometry.depth_func;
  const bool last_wins = func == DepthFunc::lequal || func == DepthFunc::gequal || func == DepthFunc::always;
  const PossibleSurface* front = nullptr;
  for (const PossibleSurface& s : possible_.at(pixel)) {
    if (!s.nominal && !s.certain) continue;
    if (front == nullptr || s.middle < front->middle || (last_wins && s.middle == front->middle)) front = &s;
  }
  return front;
}

bool ExpectedPlanes::covered(int x, int y_top) const {
  return seen(size_t(pipeline_.height - 1 - y_top) * size_t(pipeline_.width) + size_t(x)) != nullptr;
}

ExpectedPixel ExpectedPlanes::at(int x, int y_top) const {
  const uint64_t key = uint64_t(uint32_t(y_top)) << 32 | uint32_t(x);
  {
    const std::shared_lock lock(asked_);
    if (const auto found = known_.find(key); found != known_.end()) return found->second;
  }
  const ExpectedPixel pixel = made(x, y_top);
  const std::unique_lock lock(asked_);
  return known_.emplace(key, pixel).first->second;
}

ExpectedPixel ExpectedPlanes::made(int x, int y_top) const {
  ExpectedPixel out;
  const int y = pipeline_.height - 1 - y_top;
  const PossibleSurface* surface = seen(size_t(y) * size_t(pipeline_.width) + size_t(x));
  for (PlaneValues* v : {&out.value, &out.low, &out.high}) v->depth = double(pipeline_.geometry.clear_depth);
  if (surface == nullptr) return out;
  out.triangle = surface->triangle;
  const SurfaceValues values(projector_, *surface, x + 0.5, y + 0.5);
  const GBufferState& g = pipeline_.gbuffer;
  const auto put = [&](const Range& r, const auto& number) {
    number(out.value) = r.value, number(out.low) = r.low, number(out.high) = r.high;
  };
  for (PlaneValues* v : {&out.value, &out.low, &out.high}) {
    v->covered = true;
    v->object = surface->instance + 1.0;
    v->material = projector_.scene().instances[surface->instance].material + 1.0;
  }
  put(values.depth(), [](PlaneValues& v) -> double& { return v.depth; });
  for (size_t k = 0; k < 3; ++k) {
    put(values.attribute(kPosition + k, g.position.interpolation),
        [k](PlaneValues& v) -> double& { return v.position[k]; });
    put(values.normal(int(k), g.normal.interpolation), [k](PlaneValues& v) -> double& { return v.normal[k]; });
    put(values.albedo(values.base_color(int(k), g.albedo.interpolation)),
        [k](PlaneValues& v) -> double& { return v.albedo[k]; });
  }
  put(values.base_color(3, g.albedo.interpolation), [](PlaneValues& v) -> double& { return v.albedo[3]; });
  const auto base = [&](size_t k) { return values.base_color(int(k), g.albedo.interpolation); };
  for (size_t k = 0; k < 3 && reads_specular_plane(pipeline_.light_model); ++k)
    put(values.specular(base(k), int(k)), [k](PlaneValues& v) -> double& { return v.specular[k]; });
  for (size_t k = 0; k < 3 && pipeline_.light_model.emission; ++k)
    put(values.emission(base(k), int(k)), [k](PlaneValues& v) -> double& { return v.emission[k]; });
  put(values.shininess(), [](PlaneValues& v) -> double& { return v.specular[3]; });
  // Another format stands in where there is no fourth channel.
  put(info(g.emission).channels > 3 ? values.ambient_share() : Range{1, 1, 1},
      [](PlaneValues& v) -> double& { return v.emission[3]; });
  for (size_t k = 0; k < 2; ++k)
    put(values.attribute(kUv + k, g.uv.interpolation), [k](PlaneValues& v) -> double& { return v.uv[k]; });
  return out;
}

}  // namespace trueshade::oracle
