#include "cli/notes.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "cli/json_text.h"
#include "scenes/pipeline/presets.h"
#include "shading/output/view_image.h"

namespace trueshade {
namespace {

std::string counted(uint64_t count, const std::string& one, const std::string& many) {
  return std::to_string(count) + ' ' + (count == 1 ? one : many);
}

bool reads(const Pipeline& pipeline, const Scene& scene, const IgnoredField& field) {
  const std::vector<IgnoredField> ignored = ignored_fields(scene, pipeline);
  return std::none_of(ignored.begin(), ignored.end(),
                      [&](const IgnoredField& other) { return other.of == field.of && other.field == field.field; });
}

/// ` (presets without this note: A B)`, or nothing where every preset has it.
std::string presets_without_note(const Scene& scene, const IgnoredField& field) {
  std::string names;
  for (const Preset& preset : presets())
    if (reads(preset.pipeline, scene, field)) names += ' ' + std::string(preset.name);
  return names.empty() ? "" : " (presets without this note:" + names + ")";
}

std::string line_of(const Scene& scene, const IgnoredField& field) {
  const std::string of(field.of), who = counted(field.count, of + " states", of + "s state");
  return who + " " + std::string(field.field) + ", which is ignored: " + std::string(field.reason) +
         presets_without_note(scene, field);
}

std::string reflectance_line(uint64_t materials) {
  return counted(materials, "material has", "materials have") +
         " a colour above 16: Colours of scenes are linear, from 0 to 1, and no surface reflects more light than it "
         "receives (divide codes from 0 to 255 by 255 and decode them from sRGB)";
}

/// Lights of the kinds that have boxes, and whose range ends.
uint64_t boxed_lights(const Scene& scene) {
  return uint64_t(std::count_if(scene.lights.begin(), scene.lights.end(), [](const Light& light) {
    return (light.type == LightType::point || light.type == LightType::spot) && std::isfinite(light.range);
  }));
}

std::string boxes_line(const Scene& scene, ImageView view) {
  const uint64_t boxed = boxed_lights(scene), all = scene.lights.size();
  if (boxed == all && all > 0) return {};
  return "The view " + std::string(kViewNames[size_t(view)]) + " shows the boxes of " + std::to_string(boxed) + " of " +
         counted(all, "light", "lights") + ": Only point and spot lights with a finite range have a box";
}

std::string uv_line(const Scene& scene) {
  const auto without = std::count_if(scene.instances.begin(), scene.instances.end(),
                                     [&](const Instance& instance) { return !scene.meshes[instance.mesh].has_uv(); });
  if (without == 0) return {};
  return "The view uv shows " + std::to_string(without) + " of " +
         counted(scene.instances.size(), "object", "objects") +
         " in black: Their meshes have no texture coordinates, so that u and v are 0";
}

}  // namespace

Notes notes_of(const Scene& scene, const Pipeline& pipeline) {
  Notes notes{ignored_fields(scene, pipeline), {}};
  for (const IgnoredField& field : notes.ignored) notes.lines.push_back(line_of(scene, field));
  if (const uint64_t materials = implausible_reflectances(scene); materials > 0)
    notes.lines.push_back(reflectance_line(materials));
  std::string of_view;
  if (shows_boxes(pipeline.view)) of_view = boxes_line(scene, pipeline.view);
  if (pipeline.view == ImageView::uv) of_view = uv_line(scene);
  if (!of_view.empty()) notes.lines.push_back(of_view);
  return notes;
}

std::string hidden_picture_note(const Pipeline& pipeline, const Image& picture) {
  constexpr int kHiddenPercent = 90;
  if (pipeline.view != ImageView::light_boxes) return {};
  const size_t pixels = size_t(picture.width) * size_t(picture.height);
  size_t black = 0, empty = 0;
  for (size_t i = 0; i < pixels; ++i) {
    const uint8_t* texel = &picture.texels[4 * i];
    black += texel[0] == 0 && texel[1] == 0 && texel[2] == 0 ? 1 : 0;
    empty += std::equal(texel, texel + 3, kEmptyColor) ? 1 : 0;
  }
  const size_t percent = 100 * black / std::max<size_t>(pixels - empty, 1);
  if (percent < kHiddenPercent) return {};
  return "The view light-boxes is black on " + std::to_string(percent) +
         " % of what is drawn: Boxes are black solids, and the boxes of these lights cover what is behind them "
         "(--view light-edges shows their edges alone)";
}

void say_notes(const std::vector<std::string>& lines) {
  for (const std::string& line : lines) std::fprintf(stderr, "trueshade: note: %s\n", line.c_str());
}

std::string ignored_json(const Notes& notes) {
  JsonArray ignored;
  for (const IgnoredField& field : notes.ignored)
    ignored.add_raw(JsonObject()
                        .put("of", field.of)
                        .put("field", field.field)
                        .put("count", field.count)
                        .put("reason", field.reason)
                        .text());
  return ignored.text();
}

std::string lines_json(const Notes& notes) {
  JsonArray lines;
  for (const std::string& line : notes.lines) lines.add_raw(json_string(line));
  return lines.text();
}

}  // namespace trueshade
