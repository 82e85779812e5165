#include "explain/target.h"

#include <algorithm>

#include "shading/blend/clear_color.h"

namespace trueshade {
namespace {

constexpr size_t kNoLight = size_t(-1);

/// How often each light counts.
struct LightTimes {
  std::span<const uint8_t> times;
  int operator[](size_t light) const { return times.empty() ? 1 : int(times[light]); }
};

/// Adds draws to a pixel one after the other.
struct Drawing {
  const BlendTarget& target;
  PixelTarget& out;

  void draw(std::string what, size_t light, const BlendState& state, const std::array<float, 4>& source) {
    const StoredPixel before = out.stored;
    out.stored = after_draw(state, target, source, before);
    out.draws.push_back({std::move(what), light == kNoLight ? -1 : int64_t(light), source, before, out.stored});
  }
  void store(std::string what, size_t light, const std::array<float, 4>& source) {
    draw(std::move(what), light, BlendState{}, source);
  }
};

std::string name_of_light(size_t light) { return "light " + std::to_string(light); }

LightTotal lit(const LightModel& model, const LightTable& table, const SurfacePlanes& surface, LightTimes times) {
  LightTotal out{lit_pixel(model, table, surface), {}, {}};
  std::array<float, 3> sum = out.pixel.start;
  for (const LightRow& row : table.row) {
    out.lights.push_back(light_at(model, row, out.pixel));
    if (out.lights.back().fate != LightFate::adds) continue;
    for (int n = times[out.lights.size() - 1]; n > 0; --n)
      for (size_t k = 0; k < 3; ++k) sum[k] = sum[k] + out.lights.back().term[k];
  }
  out.sum = received(model, out.pixel, sum);
  return out;
}

/// How often the geometry of a light covers the pixel: quads cover all pixels once, meshes by their triangles.
uint32_t geometry_at(const ExplainedFrame& frame, const Light& light, WindowPixel pixel) {
  const LightExtent extent = drawn_extent(light, frame.pipeline.light_volumes);
  if (!is_mesh(extent)) return 1;
  const LightMesh& mesh = frame.meshes[extent];
  std::vector<glm::vec3> vertices(mesh.unit.size());
  light_vertices(mesh, light, vertices);
  uint32_t count = 0;
  for (size_t i = 0; i < mesh.indices.size(); i += 3) {
    ClipVertex clip[3];
    for (size_t k = 0; k < 3; ++k) {
      const glm::vec3& v = vertices[mesh.indices[i + k]];
      const float point[3] = {v.x, v.y, v.z};
      clip[k] = clip_position(frame.view.clip_from_world.data(), point);
    }
    count += fragment_at(clip, frame.volume_window, frame.volume_state, pixel).fate == Fate::covers ? 1 : 0;
  }
  return count;
}

/// What a light's draw hands to the blender: its term alone.
std::array<float, 4> source_of(const LightModel& model, const LitPixel& pixel, const LightAtPixel& at) {
  return received(model, pixel, at.fate == LightFate::adds ? at.term : std::array<float, 3>{});
}

void draw_volumes(const ExplainedFrame& frame, const PixelSurfaces& surfaces, WindowPixel pixel, LightTimes times,
                  Drawing& drawing) {
  const LightModel& model = frame.pipeline.light_model;
  PixelTarget& out = drawing.out;
  if (!surfaces.covered) return;
  const LitPixel& surface = out.visible.pixel;
  if (frame.pipeline.light_volumes.base)
    drawing.store("what the surface has without lights", kNoLight, received(model, surface, surface.start));
  for (size_t i = 0; i < frame.scene.lights.size(); ++i) {
    out.geometry.push_back(geometry_at(frame, frame.scene.lights[i], pixel));
    if (out.geometry.back() == 0) out.visible.lights[i].fate = LightFate::not_drawn;
    if (!inside_extent(frame.lights.row[i], surface)) continue;
    for (uint32_t k = 0; k < out.geometry.back() * uint32_t(times[i]); ++k)
      drawing.draw(name_of_light(i), i, frame.pipeline.blend, source_of(model, surface, out.visible.lights[i]));
  }
}

void draw_passes(const ExplainedFrame& frame, const PixelSurfaces& surfaces, LightTimes times, Drawing& drawing) {
  const LightModel& model = frame.pipeline.light_model;
  PixelTarget& out = drawing.out;
  const size_t lights = frame.scene.lights.size();
  if (surfaces.covered) {
    const LitPixel& pixel = out.visible.pixel;
    std::array<float, 3> first = pixel.start;
    for (int n = lights > 0 && out.visible.lights[0].fate == LightFate::adds ? times[0] : 0; n > 0; --n)
      for (size_t k = 0; k < 3; ++k) first[k] = first[k] + out.visible.lights[0].term[k];
    drawing.store(lights > 0 ? "the first light's draw" : "a draw without lights", lights > 0 ? 0 : kNoLight,
                  received(model, pixel, first));
  }
  std::vector<LitPixel> layers;
  if (surfaces.tied.empty() && surfaces.covered) layers.push_back(out.visible.pixel);
  for (const SurfacePlanes& tied : surfaces.tied) layers.push_back(lit_pixel(model, frame.lights, tied));
  for (size_t i = 1; i < lights; ++i)
    for (const LitPixel& layer : layers)
      for (int n = inside_extent(frame.lights.row[i], layer) ? times[i] : 0; n > 0; --n)
        drawing.draw(name_of_light(i), i, kAddLight,
                     source_of(model, layer, light_at(model, frame.lights.row[i], layer)));
}

void draw_glass(const ExplainedFrame& frame, const PixelSurfaces& surfaces, LightTimes times, Drawing& drawing) {
  LightModel model = frame.pipeline.light_model;
  model.alpha_from_albedo = true;
  for (size_t i = 0; i < surfaces.glass.size(); ++i) {
    drawing.out.glass.push_back(lit(model, frame.glass_lights, surfaces.glass[i], times));
    drawing.draw("transparent surface " + std::to_string(i), kNoLight, frame.pipeline.transparency.blend,
                 drawing.out.glass.back().sum);
  }
}

}  // namespace

PixelTarget target_of(const ExplainedFrame& frame, const PixelSurfaces& surfaces, WindowPixel pixel,
                      std::span<const uint8_t> given_times) {
  const LightTimes times{given_times};
  PixelTarget out;
  Drawing drawing{frame.target, out};
  const glm::vec4 clear = drawn_clear(frame.scene.clear, frame.target);
  drawing.store("the clear colour", kNoLight, {clear.r, clear.g, clear.b, clear.a});
  if (surfaces.covered) out.visible = lit(frame.pipeline.light_model, frame.lights, surfaces.visible, times);
  switch (frame.pipeline.strategy) {
    case Strategy::forward_loop:
    case Strategy::deferred_loop:
      if (surfaces.covered) drawing.store("the sum of the lights", kNoLight, out.visible.sum);
      break;
    case Strategy::deferred_volumes:
      draw_volumes(frame, surfaces, pixel, times, drawing);
      break;
    case Strategy::forward_multipass:
      draw_passes(frame, surfaces, times, drawing);
      break;
  }
  draw_glass(frame, surfaces, times, drawing);
  return out;
}

}  // namespace trueshade
