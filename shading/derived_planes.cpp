#include "shading/derived_planes.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "core/fp_env.h"
#include "scenes/light_shapes.h"
#include "shading/light_table.h"
#include "shading/overlay.h"

namespace trueshade {
namespace {

struct Derived {
  std::string_view name;
  std::string_view from[3];  ///< planes it is made of, beside the target
};
constexpr Derived kDerived[] = {{"Z", {"position", "id.object"}},
                                {"light.tile", {"position", "id.object"}},
                                {"light.intensity", {}},
                                {"light.boxes", {"albedo", "id.object", "depth"}},
                                {"light.edges", {"albedo", "id.object", "depth"}}};

void add_once(std::vector<std::string>& names, std::string_view name) {
  if (!name.empty() && std::find(names.begin(), names.end(), name) == names.end()) names.emplace_back(name);
}

template <typename Value>
void put(Image& image, int x, int y, const Value& value) {
  std::memcpy(image.texel(x, y), &value, sizeof value);
}

/// Unit vector along which distance from the eye grows in depth: what divides x and y in a perspective, else z.
glm::vec3 view_axis(const Scene& scene, const Pipeline& pipeline) {
  const Matrix4 m = clip_from_world(scene.camera, 1.0, pipeline.geometry.clip_depth == ClipDepth::zero_to_one);
  for (const size_t row : {size_t(3), size_t(2)}) {
    const double x = m[row], y = m[4 + row], z = m[8 + row], length2 = (x * x + y * y) + z * z;
    if (!(length2 > 0.0)) continue;
    const double inverse = 1.0 / std::sqrt(length2);
    return {float(x * inverse), float(y * inverse), float(z * inverse)};
  }
  return glm::vec3(0.0f);
}

Image view_distance(const Scene& scene, const Pipeline& pipeline, const Image& position, const Image& object) {
  const glm::vec3 axis = view_axis(scene, pipeline), eye = scene.camera.eye;
  Image out(object.width, object.height, Format::d32f);
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) {
      if (object.value(x, y, 0) == 0.0) continue;
      float p[3];
      for (int k = 0; k < 3; ++k) p[k] = float(position.value(x, y, k)) - eye[k];
      put(out, x, y, (axis.x * p[0] + axis.y * p[1]) + axis.z * p[2]);
    }
  return out;
}

struct Square {
  int x0, y0, x1, y1;  ///< y from the top, half open
};

/// Lights whose falloff is not sure to be 0 in the box of the square's positions, by the test of the light lists.
uint32_t reaching_lights(const LightTable& lights, const Square& square, const Image& position, const Image& object) {
  constexpr float kInf = std::numeric_limits<float>::infinity();
  float low[3] = {kInf, kInf, kInf}, high[3] = {-kInf, -kInf, -kInf};
  bool any = false;
  for (int y = square.y0; y < square.y1; ++y)
    for (int x = square.x0; x < square.x1; ++x) {
      if (object.value(x, y, 0) == 0.0) continue;
      any = true;
      for (int k = 0; k < 3; ++k) {
        const float p = float(position.value(x, y, k));
        low[k] = std::min(low[k], p);
        high[k] = std::max(high[k], p);
      }
    }
  if (!any) return 0;
  uint32_t count = 0;
  for (size_t light = 0; light < lights.size(); ++light) {
    float d2 = 0.0f;
    for (int k = 0; k < 3; ++k) {
      const float place = lights.position[k][light];
      const float gap = std::max(std::max(low[k] - place, place - high[k]), 0.0f);
      d2 += gap * gap;
    }
    const float cut2 = lights.cut2[light];
    count += cut2 == kInf || !(d2 * (1.0f - 0x1p-20f) >= cut2);
  }
  return count;
}

Image lights_by_tile(const LightTable& lights, int threads, const Image& position, const Image& object) {
  Image out(object.width, object.height, Format::r32ui);
  const int rows = (out.height + kLightTile - 1) / kLightTile;
  parallel_for(rows, threads, [&](int row) {
    const int bottom = out.height - row * kLightTile;  // squares count from the window's lower left corner
    for (int x = 0; x < out.width; x += kLightTile) {
      const Square square{x, std::max(bottom - kLightTile, 0), std::min(x + kLightTile, out.width), bottom};
      const uint32_t count = reaching_lights(lights, square, position, object);
      for (int py = square.y0; py < square.y1; ++py)
        for (int px = square.x0; px < square.x1; ++px) put(out, px, py, count);
    }
  });
  return out;
}

Image intensities(const Image& target) {
  Image out(target.width, target.height, Format::d32f);
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x)
      put(out, x, y,
          luminance(float(target.value(x, y, 0)), float(target.value(x, y, 1)), float(target.value(x, y, 2))));
  return out;
}

Image among_surfaces(const Scene& boxes, const Pipeline& pipeline, const Execution& execution,
                     std::span<const NamedImage> drawn) {
  const Image &albedo = plane_named(drawn, "albedo"), &object = plane_named(drawn, "id.object");
  const Overlay over = overlay(boxes, pipeline, execution, plane_named(drawn, "depth"));
  Image out(object.width, object.height, Format::rgba32f);
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) {
      const bool boxed = over.object.value(x, y, 0) != 0.0;
      if (!boxed && object.value(x, y, 0) == 0.0) continue;
      glm::vec4 value(0.0f, 0.0f, 0.0f, boxed ? 1.0f : 0.0f);
      for (int k = 0; k < 3; ++k) value[k] = float((boxed ? over.albedo : albedo).value(x, y, k));
      put(out, x, y, value);
    }
  return out;
}

}  // namespace

std::vector<std::string> planes_to_draw(std::span<const std::string> asked) {
  std::vector<std::string> drawn;
  const auto derived = [](std::string_view name) {
    return std::find_if(std::begin(kDerived), std::end(kDerived), [&](const Derived& d) { return d.name == name; });
  };
  for (const std::string& name : asked)
    if (derived(name) == std::end(kDerived)) add_once(drawn, name);
  for (const std::string& name : asked)
    if (const Derived* d = derived(name); d != std::end(kDerived))
      for (const std::string_view from : d->from) add_once(drawn, from);
  return drawn;
}

Image derived_plane(std::string_view name, const Scene& scene, const Pipeline& pipeline, const Execution& execution,
                    const Image& target, std::span<const NamedImage> drawn) {
  if (name == "light.intensity") return intensities(target);
  if (name == "light.boxes") return among_surfaces(light_boxes(scene), pipeline, execution, drawn);
  if (name == "light.edges") return among_surfaces(light_box_edges(scene), pipeline, execution, drawn);
  const Image& object = plane_named(drawn, "id.object");
  const Image& position = plane_named(drawn, "position");
  if (name == "Z") return view_distance(scene, pipeline, position, object);
  return lights_by_tile(make_light_table(scene.lights, pipeline.light_model, scene.camera), execution.threads, position,
                        object);
}

const Image& plane_named(std::span<const NamedImage> planes, std::string_view name) {
  return std::find_if(planes.begin(), planes.end(), [name](const NamedImage& plane) { return plane.name == name; })
      ->image;
}

}  // namespace trueshade
