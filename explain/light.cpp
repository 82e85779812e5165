#include "explain/light.h"

#include <cmath>

#include "scenes/light_cone.h"

namespace trueshade {
namespace {

using Vector = std::array<float, 3>;

float dot(const Vector& a, const float* b) { return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2]; }

float squared_distance(const LightRow& light, const SurfacePlanes& surface) {
  Vector d;
  for (size_t k = 0; k < 3; ++k) d[k] = light.position[k] - surface.position[k];
  return dot(d, d.data());
}

}  // namespace

std::string_view text(LightFate fate) {
  switch (fate) {
    case LightFate::adds:
      return "adds";
    case LightFate::out_of_reach:
      return "out of reach";
    case LightFate::not_drawn:
      return "its geometry is not drawn here";
    case LightFate::faces_away:
      return "behind the surface";
    case LightFate::outside_cone:
      return "outside the cone";
    case LightFate::behind_light:
      return "behind the light, which shines to one side";
    case LightFate::gives_nothing:
      return "its light is 0 here";
  }
  return {};  // unreachable: every enumerator returns above
}

bool in_reach(const LightRow& light, const SurfacePlanes& surface, LightAtPixel& at) {
  if (!is_placed(light.type)) return true;
  const float d2 = squared_distance(light, surface);
  at.d = std::sqrt(d2);
  return d2 < light.cut2;
}

LightFate fate_without_light(const Light& light, const SurfacePlanes& surface) {
  if (is_ambient(light.type)) return LightFate::gives_nothing;
  const bool directional = is_directional(light.type);
  Vector d, axis;
  for (int k = 0; k < 3; ++k) {
    axis[size_t(k)] = -light.direction[k];
    d[size_t(k)] = directional ? axis[size_t(k)] : light.position[k] - surface.position[size_t(k)];
  }
  if (!(dot(d, surface.normal.data()) > 0.0f)) return LightFate::faces_away;
  const bool is_flat = has_area(light.type) && row_of(light.type).is_aimed;
  if (is_flat && !(dot(d, axis.data()) > 0.0f)) return LightFate::behind_light;
  const bool outside = dot(d, axis.data()) <= LightCone(light).cos_outer * std::sqrt(dot(d, d.data()));
  return is_spot(light.type) && outside ? LightFate::outside_cone : LightFate::gives_nothing;
}

float strength(const LightAtPixel& light) {
  const float sum = std::fabs(light.term[0]) + std::fabs(light.term[1]) + std::fabs(light.term[2]);
  return sum == sum ? sum : HUGE_VALF;
}

bool inside_extent(const LightRow& light, const SurfacePlanes& surface) {
  return std::isinf(light.extent2) || squared_distance(light, surface) < light.extent2;
}

}  // namespace trueshade
