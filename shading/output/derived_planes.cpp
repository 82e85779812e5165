#include "shading/output/derived_planes.h"

#include <algorithm>
#include <cstring>
#include <limits>

#include "core/image_rows.h"
#include "core/threads/parallel_for.h"
#include "scenes/light_shapes.h"
#include "shading/light/light_table.h"
#include "shading/output/light_planes.h"
#include "shading/output/overlay.h"

namespace trueshade {
namespace {

struct Derived {
  std::string_view name;
  std::string_view from[3];  ///< planes it is made of, beside the target
};
constexpr Derived kDerived[] = {{"light.tile", {"position", "id.object"}},
                                {"light.intensity", {}},
                                {"light.boxes", {"albedo", "id.object", "depth"}},
                                {"light.edges", {"albedo", "id.object", "depth"}}};

void add_once(std::vector<std::string>& names, std::string_view name) {
  if (!name.empty() && std::find(names.begin(), names.end(), name) == names.end()) names.emplace_back(name);
}

/// A row of an image whose texels are a Value each, to be written.
template <typename Value>
class TexelRow {
 public:
  TexelRow(Image& image, int y) : first_(image.texel(0, y)) {}
  void put(int x, const Value& value) const { std::memcpy(first_ + sizeof value * size_t(x), &value, sizeof value); }

 private:
  uint8_t* first_;
};

/// A row of three channels of a plane, and of id.object.
struct VectorRow {
  std::vector<float> values;
  std::vector<uint32_t> object;  ///< 0: no surface

  VectorRow(const Image& plane, const Image& objects, int y)
      : values(3 * size_t(objects.width)), object(size_t(objects.width)) {
    read_row(plane, y, 3, values.data());
    read_row(objects, y, object.data());
  }
  glm::vec3 at(int x) const {
    const float* p = values.data() + 3 * x;
    return {p[0], p[1], p[2]};
  }
};

/// Calls body(y) for every row of a plane.
template <typename Body>
void for_each_row(int height, int threads, const Body& body) {
  parallel_for((height + kRowsOfBand - 1) / kRowsOfBand, threads, [&](int band) {
    for (int y = band * kRowsOfBand; y < std::min((band + 1) * kRowsOfBand, height); ++y) body(y);
  });
}

/// The box of some positions.
struct PositionBox {
  static constexpr float kInf = std::numeric_limits<float>::infinity();
  glm::vec3 low{kInf}, high{-kInf};
  bool any = false;

  /// Of the pixels [x0, x1) that have a surface.
  PositionBox(std::span<const VectorRow> rows, int x0, int x1) {
    for (const VectorRow& row : rows)
      for (int x = x0; x < x1; ++x) {
        if (row.object[size_t(x)] == 0) continue;
        any = true;
        const glm::vec3 p = row.at(x);
        for (int k = 0; k < 3; ++k) {
          low[k] = std::min(low[k], p[k]);
          high[k] = std::max(high[k], p[k]);
        }
      }
  }

  /// Whether a light's falloff is not sure to be 0 in the box, by the test of the light lists. Roundings rise with what
  /// they round: no light reaches a box that does not reach a larger one.
  bool reached_by(const LightTable& lights, size_t light) const {
    if (!any) return false;
    float d2 = 0.0f;
    for (int k = 0; k < 3; ++k) {
      const float place = lights.position[k].data()[light];
      const float gap = std::max(std::max(low[k] - place, place - high[k]), 0.0f);
      d2 += gap * gap;
    }
    const float cut2 = lights.cut2.data()[light];
    return cut2 == kInf || !(d2 * (1.0f - 0x1p-20f) >= cut2);
  }
};

Image lights_by_tile(const LightTable& lights, int threads, const Image& position, const Image& object) {
  Image out(object.width, object.height, Format::r32ui);
  parallel_for((out.height + kLightTile - 1) / kLightTile, threads, [&](int tile) {
    const int bottom = out.height - tile * kLightTile;  // squares count from the window's lower left corner
    std::vector<VectorRow> rows;
    for (int y = std::max(bottom - kLightTile, 0); y < bottom; ++y) rows.emplace_back(position, object, y);
    const PositionBox strip(rows, 0, out.width);
    std::vector<size_t> near;
    for (size_t light = 0; light < lights.size(); ++light)
      if (strip.reached_by(lights, light)) near.push_back(light);
    for (int x = 0; x < out.width; x += kLightTile) {
      const int end = std::min(x + kLightTile, out.width);
      const PositionBox square(rows, x, end);
      uint32_t count = 0;
      for (const size_t light : near) count += square.reached_by(lights, light) ? 1 : 0;
      for (int y = bottom - int(rows.size()); y < bottom; ++y) {
        const TexelRow<uint32_t> texels(out, y);
        for (int px = x; px < end; ++px) texels.put(px, count);
      }
    }
  });
  return out;
}

Image intensities(const Image& target, int threads) {
  Image out(target.width, target.height, Format::d32f);
  for_each_row(out.height, threads, [&](int y) {
    std::vector<float> colors(3 * size_t(out.width));
    read_row(target, y, 3, colors.data());
    const float* c = colors.data();
    const TexelRow<float> texels(out, y);
    for (int x = 0; x < out.width; ++x, c += 3) texels.put(x, luminance(c[0], c[1], c[2]));
  });
  return out;
}

Image among_surfaces(const Scene& boxes, const Pipeline& pipeline, const Execution& execution,
                     std::span<const NamedImage> drawn) {
  const Image &albedo = plane_named(drawn, "albedo"), &object = plane_named(drawn, "id.object");
  const Image box = overlay(boxes, pipeline, execution, plane_named(drawn, "depth"));
  Image out(object.width, object.height, Format::rgba32f);
  for_each_row(out.height, execution.threads, [&](int y) {
    const VectorRow surface(albedo, object, y);
    std::vector<uint32_t> boxed(size_t(out.width));
    read_row(box, y, boxed.data());
    const TexelRow<glm::vec4> texels(out, y);
    for (int x = 0; x < out.width; ++x) {
      if (boxed[size_t(x)] != 0)
        texels.put(x, glm::vec4(overlay_color(boxes, boxed[size_t(x)]), 1.0f));
      else if (surface.object[size_t(x)] != 0)
        texels.put(x, glm::vec4(surface.at(x), 0.0f));
    }
  });
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
  if (name == "light.intensity") return intensities(target, execution.threads);
  if (name == "light.boxes") return among_surfaces(light_boxes(scene), pipeline, execution, drawn);
  if (name == "light.edges") return among_surfaces(light_box_edges(scene), pipeline, execution, drawn);
  const Image& object = plane_named(drawn, "id.object");
  const Image& position = plane_named(drawn, "position");
  return lights_by_tile(make_light_table(scene.lights, pipeline.light_model, scene.camera), execution.threads, position,
                        object);
}

bool shows_light(std::string_view plane) {
  return plane == "light.count" || plane == "light.intensity" || light_of_plane(plane);
}

const Image& plane_named(std::span<const NamedImage> planes, std::string_view name) {
  return std::find_if(planes.begin(), planes.end(), [name](const NamedImage& plane) { return plane.name == name; })
      ->image;
}

}  // namespace trueshade
