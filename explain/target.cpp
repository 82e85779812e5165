#include "explain/target.h"

#include <algorithm>
#include <limits>

#include "shading/blend/clear_color.h"

namespace trueshade {
namespace {

constexpr int64_t kNoLight = -1;

/// How often each light counts.
struct LightTimes {
  std::span<const uint8_t> times;
  int operator[](size_t light) const { return times.empty() ? 1 : int(times[light]); }
};

/// Draws into a pixel, one after the other.
struct Drawing {
  const BlendTarget& target;
  std::vector<TargetDraw>* draws;
  StoredPixel stored{};

  void draw(const std::string& what, int64_t light, const BlendState& state, const std::array<float, 4>& source) {
    const StoredPixel before = stored;
    stored = after_draw(state, target, source, before);
    if (draws == nullptr) return;
    const std::string name = light == kNoLight ? what : what + "light " + std::to_string(light);
    draws->push_back({name, light, state.enabled, source, before, stored});
  }
  void store(const std::string& what, const std::array<float, 4>& source) {
    draw(what, kNoLight, BlendState{}, source);
  }
};

/// A NaN is one pattern, whatever it came from.
float one_nan(float x) { return x == x ? x : std::numeric_limits<float>::quiet_NaN(); }

/// What the target receives of a sum, or of one light's term that is drawn by itself.
std::array<float, 4> received(const LightTotal& total, const std::array<float, 3>& sum) {
  if (total.program->is_unlit()) return total.surface.albedo;
  auto out = total.program->output<4>(total.program->at_sum(sum), programs::kFinishOutput);
  if (total.takes_albedo_alpha) out[3] = total.surface.albedo[3];
  for (float& value : out) value = one_nan(value);
  return out;
}

/// Sets the terms of the lights that are in reach, and says that they add something, or give nothing.
void set_terms(LightTotal& total) {
  std::vector<uint32_t> reaching;
  for (size_t i = 0; i < total.lights.size(); ++i)
    if (total.lights[i].fate != LightFate::out_of_reach) reaching.push_back(uint32_t(i));
  const std::vector<std::array<float, 3>> terms = total.program->terms(reaching);
  for (size_t i = 0; i < reaching.size(); ++i) {
    LightAtPixel& at = total.lights[reaching[i]];
    for (size_t k = 0; k < 3; ++k) at.term[k] = one_nan(terms[i][k]);
    at.fate = at.term == std::array<float, 3>{} ? LightFate::gives_nothing : LightFate::adds;
  }
}

/// What each light of the table adds to the surface: its distance, its term and its fate. Out of reach, where extent or
/// falloff has ended, the term is 0 and the program is not asked.
void add_lights(const ExplainedFrame& frame, LightTotal& total) {
  for (size_t i = 0; i < total.table->size(); ++i) {
    LightAtPixel& at = total.lights.emplace_back();
    if (!in_reach(total.table->row[i], total.surface, at)) at.fate = LightFate::out_of_reach;
  }
  set_terms(total);
  for (size_t i = 0; i < total.lights.size(); ++i)
    if (total.lights[i].fate == LightFate::gives_nothing)
      total.lights[i].fate = fate_without_light(frame.scene.lights[i], total.surface);
}

/// What the target receives of the sum of the lights that add something, each as often as it counts.
std::array<float, 4> summed(const LightTotal& total, LightTimes times) {
  std::array<float, 3> sum = total.start;
  for (size_t i = 0; i < total.lights.size(); ++i)
    for (int n = total.lights[i].fate == LightFate::adds ? times[i] : 0; n > 0; --n)
      for (size_t k = 0; k < 3; ++k) sum[k] = sum[k] + total.lights[i].term[k];
  return received(total, sum);
}

/// One surface under every light, each with its term and its fate, and their sum; no lights where the surface is unlit.
LightTotal lit(const ExplainedFrame& frame, const FrameLights& lights, const SurfacePlanes& surface,
               WindowPixel pixel) {
  LightTotal out;
  out.surface = surface, out.table = &lights.table;
  out.program = std::make_shared<ProgramAtSurface>(lights.program, surface, pixel);
  out.takes_albedo_alpha = lights.takes_albedo_alpha && !out.program->program().defines_finish;
  out.start = out.program->start();
  if (!out.program->is_unlit()) add_lights(frame, out);
  out.sum = summed(out, {});
  return out;
}

/// The same surface under the same lights by an edited program.
LightTotal relit_total(const LightTotal& total, const programs::Program& edited) {
  LightTotal out = total;
  out.program = std::make_shared<ProgramAtSurface>(*total.program, edited);
  out.start = out.program->start();
  set_terms(out);
  out.sum = summed(out, {});
  return out;
}

/// Gives lights whose geometry does not cover the pixel their fate on the visible surface.
void mark_undrawn(LitSurfaces& lit) {
  for (size_t i = 0; i < lit.geometry.size() && i < lit.visible.lights.size(); ++i)
    if (lit.geometry[i] == 0 && lit.visible.lights[i].fate == LightFate::adds)
      lit.visible.lights[i].fate = LightFate::not_drawn;
}

/// What summed() returns, which is known already where each light counts once.
std::array<float, 4> sum_of(const LightTotal& total, LightTimes times) {
  return times.times.empty() ? total.sum : summed(total, times);
}

/// How many triangles of a light's mesh cover the pixel and are not culled.
uint32_t mesh_covers(const ExplainedFrame& frame, const Light& light, const LightMesh& mesh, WindowPixel pixel) {
  std::vector<glm::vec3> vertices(mesh.unit.size());
  std::vector<ClipVertex> clip;
  light_vertices(mesh, light, vertices);
  for (const glm::vec3& v : vertices) {
    const float point[3] = {v.x, v.y, v.z};
    clip.push_back(clip_position(frame.view.clip_from_world.data(), point));
  }
  uint32_t count = 0;
  for (size_t i = 0; i < mesh.indices.size(); i += 3) {
    const ClipVertex corner[3] = {clip[mesh.indices[i]], clip[mesh.indices[i + 1]], clip[mesh.indices[i + 2]]};
    if (surely_elsewhere(corner, frame.volume_window, pixel)) continue;
    count += fragment_at(corner, frame.volume_window, frame.volume_state, pixel).fate == Fate::covers ? 1 : 0;
  }
  return count;
}

/// What a light's draw hands to the blender: its term alone, finished.
std::array<float, 4> source_of(const LightTotal& total, size_t light) {
  return received(total, total.lights[light].term);
}

/// Draws the base where the pipeline has one, then each light as often as its geometry covers the pixel and the light
/// counts. Draws nothing where no surface is visible.
void draw_volumes(const ExplainedFrame& frame, const LitSurfaces& lit, LightTimes times, Drawing& drawing) {
  if (!lit.covered) return;
  const LightTotal& visible = lit.visible;
  if (frame.pipeline.light_volumes.base)
    drawing.store("what the surface has without lights", received(visible, visible.start));
  for (size_t i = 0; i < visible.lights.size(); ++i) {
    if (!inside_extent(frame.lights.table.row[i], visible.surface)) continue;
    for (uint32_t k = 0; k < lit.geometry[i] * uint32_t(times[i]); ++k)
      drawing.draw("", int64_t(i), frame.pipeline.blend, source_of(visible, i));
  }
}

/// Draws the visible surface with the first light, then adds every other light to each tied surface or, where there are
/// none, to the visible one.
void draw_passes(const ExplainedFrame& frame, const LitSurfaces& lit, LightTimes times, Drawing& drawing) {
  const size_t lights = frame.lights.table.size();
  if (lit.covered) {
    const LightTotal& visible = lit.visible;
    std::array<float, 3> first = visible.start;
    for (int n = !visible.lights.empty() && visible.lights[0].fate == LightFate::adds ? times[0] : 0; n > 0; --n)
      for (size_t k = 0; k < 3; ++k) first[k] = first[k] + visible.lights[0].term[k];
    drawing.store(lights > 0 ? "the first draw, with light 0" : "a draw without lights", received(visible, first));
  }
  std::vector<const LightTotal*> layers;
  if (lit.tied.empty() && lit.covered) layers.push_back(&lit.visible);
  for (const LightTotal& tied : lit.tied) layers.push_back(&tied);
  for (size_t i = 1; i < lights; ++i)
    for (size_t layer = 0; layer < layers.size(); ++layer) {
      const LightTotal& of = *layers[layer];
      const std::string where = lit.tied.empty() ? "" : "surface " + std::to_string(layer) + " at this depth, ";
      for (int n = i < of.lights.size() && inside_extent(frame.lights.table.row[i], of.surface) ? times[i] : 0; n > 0; --n)
        drawing.draw(where, int64_t(i), kAddLight, source_of(of, i));
    }
}

}  // namespace

std::vector<uint32_t> geometry_at(const ExplainedFrame& frame, WindowPixel pixel) {
  std::vector<uint32_t> out;
  if (frame.pipeline.strategy != Strategy::deferred_volumes) return out;
  for (const Light& light : frame.scene.lights) {
    const LightExtent extent = drawn_extent(light, frame.pipeline.light_volumes);
    out.push_back(is_mesh(extent) ? mesh_covers(frame, light, frame.meshes[extent], pixel) : 1);
  }
  return out;
}

LitSurfaces lit_surfaces(const ExplainedFrame& frame, const PixelSurfaces& surfaces, std::vector<uint32_t> geometry) {
  LitSurfaces out;
  out.covered = surfaces.covered;
  out.geometry = std::move(geometry);
  if (surfaces.covered) out.visible = lit(frame, frame.lights, surfaces.visible, surfaces.pixel);
  mark_undrawn(out);
  for (const SurfacePlanes& tied : surfaces.tied) out.tied.push_back(lit(frame, frame.lights, tied, surfaces.pixel));
  for (const SurfacePlanes& glass : surfaces.glass)
    out.glass.push_back(lit(frame, frame.glass_lights, glass, surfaces.pixel));
  return out;
}

LitSurfaces relit(const LitSurfaces& lit, const programs::Program& edited) {
  LitSurfaces out;
  out.covered = lit.covered, out.geometry = lit.geometry;
  if (lit.covered) out.visible = relit_total(lit.visible, edited);
  mark_undrawn(out);
  for (const LightTotal& tied : lit.tied) out.tied.push_back(relit_total(tied, edited));
  for (const LightTotal& glass : lit.glass) out.glass.push_back(relit_total(glass, edited));
  return out;
}

StoredPixel drawn_target(const ExplainedFrame& frame, const LitSurfaces& lit, std::span<const uint8_t> given_times,
                         std::vector<TargetDraw>* draws) {
  const LightTimes times{given_times};
  Drawing drawing{frame.target, draws};
  const glm::vec4 clear = drawn_clear(frame.scene.clear, frame.target);
  drawing.store("the clear colour", {clear.r, clear.g, clear.b, clear.a});
  switch (frame.pipeline.strategy) {
    case Strategy::forward_loop:
    case Strategy::deferred_loop:
      if (lit.covered) drawing.store("the sum of the lights", sum_of(lit.visible, times));
      break;
    case Strategy::deferred_volumes:
      draw_volumes(frame, lit, times, drawing);
      break;
    case Strategy::forward_multipass:
      draw_passes(frame, lit, times, drawing);
      break;
  }
  for (size_t i = 0; i < lit.glass.size(); ++i)
    drawing.draw("transparent surface " + std::to_string(i), kNoLight, frame.pipeline.transparency.blend,
                 sum_of(lit.glass[i], times));
  return drawing.stored;
}

}  // namespace trueshade
