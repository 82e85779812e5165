#include "cli/notes.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "cli/commands.h"
#include "cli/json_text.h"
#include "cli/terminal.h"
#include "scenes/files/content/faults.h"
#include "scenes/pipeline/light_mesh.h"
#include "scenes/pipeline/presets.h"
#include "scenes/pipeline/shipped_models.h"
#include "scenes/timeline_end.h"
#include "shading/output/view_image.h"
#include "shading/program/cut_lights.h"

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

/// ` (presets without this note: A B)`, or nothing where every preset has it; also what a pipeline file can state
/// instead.
std::string presets_without_note(const Scene& scene, const IgnoredField& field) {
  std::string names;
  for (const Preset& preset : presets())
    if (reads(preset.pipeline, scene, field)) names += ' ' + std::string(preset.name);
  const char* const value = field.field == "cone_deg" ? "; or light_model.cone smooth_penumbra in a pipeline file" : "";
  return names.empty() ? "" : " (presets without this note:" + names + value + ")";
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
bool has_box(const Light& light) { return is_placed(light.type) && std::isfinite(light.range); }

uint64_t boxed_lights(const Scene& scene) {
  return uint64_t(std::count_if(scene.lights.begin(), scene.lights.end(), has_box));
}

/// Lights whose boxes hold the eye: it sees only their back faces, which the views of boxes do not draw.
uint64_t boxes_about_the_eye(const Scene& scene) {
  return uint64_t(std::count_if(scene.lights.begin(), scene.lights.end(), [&](const Light& light) {
    const glm::vec3 off = glm::abs(scene.camera.eye - light.position);
    return has_box(light) && std::max(std::max(off.x, off.y), off.z) < light.range;
  }));
}

std::string eye_in_boxes_line(const Scene& scene) {
  const uint64_t about = boxes_about_the_eye(scene);
  if (about == 0) return {};
  return counted(about, "box is", "boxes are") +
         " not shown: The eye is inside, and only faces that look at the eye are drawn";
}

/// Whether the mesh of a light in deferred-volumes holds the eye. Tests the light's extent, which the mesh nearly
/// fills.
bool volume_holds_eye(const Light& light, const LightVolumes& volumes, const glm::vec3& eye) {
  const LightExtent extent = drawn_extent(light, volumes);
  if (!has_box(light)) return false;
  const glm::vec3 from = eye - light.position;
  const float along = glm::dot(from, light.direction), distance = glm::length(from);
  switch (extent) {
    case LightExtent::box:
      return std::max(std::max(std::fabs(from.x), std::fabs(from.y)), std::fabs(from.z)) < light.range;
    case LightExtent::sphere:
      return distance < light.range;
    case LightExtent::cone:
      return along > 0.0f && along < light.range &&
             along > distance * std::cos(std::min(light.cone_rad + light.penumbra_rad, 1.57f));
    case LightExtent::hemisphere:
      return along > 0.0f && distance < light.range;
    default:
      return false;
  }
}

std::string lost_volumes_line(const Scene& scene, const Pipeline& pipeline) {
  if (pipeline.view != ImageView::lit || pipeline.strategy != Strategy::deferred_volumes ||
      pipeline.light_volumes.cull_face != CullFace::back)
    return {};
  const auto lost = std::count_if(scene.lights.begin(), scene.lights.end(), [&](const Light& light) {
    return volume_holds_eye(light, pipeline.light_volumes, scene.camera.eye);
  });
  if (lost == 0) return {};
  return counted(uint64_t(lost), "light is", "lights are") +
         " not drawn: The eye is inside the volume of each, and light_volumes.cull_face back leaves out the faces that "
         "it "
         "sees from there (light_volumes.cull_face front draws every light)";
}

std::string cut_line(const Scene& scene, const Pipeline& pipeline) {
  const CutLights cut = cut_lights(scene, pipeline);
  if (cut.count == 0) return {};
  char added[32];
  std::snprintf(added, sizeof added, "%.3g", double(cut.added));
  return counted(cut.count, "light ends at its range", "lights end at their range") +
         ", where the light program still adds something: light " + std::to_string(cut.light) + " up to " + added +
         " on a white surface (light_volumes.point and spot unbounded draw it)";
}

std::string boxes_line(const Scene& scene, ImageView view) {
  const uint64_t boxed = boxed_lights(scene), all = scene.lights.size();
  if (boxed == all && all > 0) return {};
  return "The view " + std::string(kViewNames[size_t(view)]) + " shows the boxes of " + std::to_string(boxed) + " of " +
         counted(all, "light", "lights") + ": Only lights that have a position and a finite range have a box";
}

std::string uv_line(const Scene& scene) {
  const auto without = std::count_if(scene.instances.begin(), scene.instances.end(),
                                     [&](const Instance& instance) { return !scene.meshes[instance.mesh].has_uv(); });
  if (without == 0) return {};
  return "The view uv shows " + std::to_string(without) + " of " +
         counted(scene.instances.size(), "object", "objects") +
         " in black: Their meshes have no texture coordinates, so that u and v are 0";
}

/// What no stage reads. Of a light program nothing is known but that of a preset, whose light model reads the same.
std::vector<IgnoredField> ignored_by(const Scene& scene, const Pipeline& pipeline) {
  if (!pipeline.light_program.used()) return ignored_fields(scene, pipeline);
  if (!draws_by_its_preset(pipeline)) return {};
  Pipeline stated = pipeline;
  stated.light_model = preset_pipeline(pipeline.preset)->light_model;
  return ignored_fields(scene, stated);
}

/// Whether a field is gloss of a model that is drawn as models are where no preset is named. docs/obj.md says of all of
/// them that it is ignored.
bool is_usual(const IgnoredField& field, const Scene& scene, const Pipeline& pipeline) {
  constexpr std::string_view kGloss[] = {"specular_color", "shininess", "specular_map"};
  return scene.is_model && pipeline.preset == default_pipeline(scene).preset && field.of == "material" &&
         std::find(std::begin(kGloss), std::end(kGloss), field.field) != std::end(kGloss);
}

/// Where a build without light programs draws a photometric scene.
std::string stand_in_line(const Scene& scene, const Pipeline& pipeline) {
  if (draws_light_programs() || !scene.photometric || pipeline.preset != default_pipeline(scene).preset) return {};
  return "Drawn by the preset " + pipeline.preset + " in place of " + default_pipeline(scene, true).preset +
         ", glTF's own light model: It is a light program, and this build has none, because it found no glslang";
}

/// Where a text's light model has taken the place of the program that the preset draws by.
std::string no_program_line(const Pipeline& pipeline) {
  const std::optional<Pipeline> row = preset_pipeline(pipeline.preset);
  if (!row || !row->light_program.used() || pipeline.light_program.used()) return {};
  return "Drawn by the light_model that the pipeline states, in place of the light program of the preset " +
         pipeline.preset;
}

/// Where nothing moves at another time than 0, or the animation of a file has come to its end before it.
std::string stands_line(const Scene& scene, bool may_read_time) {
  const TimelineEnd end = end_of(scene.timeline);
  if (scene.time != 0.0 && !may_read_time && !end.is_endless && end.last == 0.0 && !scene.timeline.stands_at)
    return "Nothing of the scene moves: Every time has one picture";
  if (scene.animations.empty() || end.is_endless || !(end.last > 0.0) || scene.time <= end.last) return {};
  return "The time is after the end of what moves, " + json_number(end.last) + " s: All stands as at its last step";
}

}  // namespace

Notes notes_of(const Scene& scene, const Pipeline& pipeline) {
  const bool by_program = pipeline.light_program.used();
  Notes notes{ignored_by(scene, pipeline), scene.notes};
  for (const IgnoredField& field : notes.ignored)
    if (!is_usual(field, scene, pipeline)) notes.lines.push_back(line_of(scene, field));
  if (const uint64_t materials = implausible_reflectances(scene); materials > 0)
    notes.lines.push_back(reflectance_line(materials));
  const bool boxes = shows_boxes(pipeline.view);
  for (std::string line :
       {boxes ? boxes_line(scene, pipeline.view) : std::string(), boxes ? eye_in_boxes_line(scene) : std::string(),
        pipeline.view == ImageView::uv ? uv_line(scene) : std::string(), lost_volumes_line(scene, pipeline),
        by_program ? cut_line(scene, pipeline) : std::string(), stand_in_line(scene, pipeline),
        no_program_line(pipeline), stands_line(scene, by_program && !names_shipped_model(pipeline.light_program.file))})
    if (!line.empty()) notes.lines.push_back(std::move(line));
  return notes;
}

bool is_lenient(const Metadata& metadata) {
  return std::any_of(metadata.begin(), metadata.end(), [](const auto& entry) { return entry.first == kLenientKey; });
}

void say_notes(const std::vector<std::string>& lines) {
  if (is_quiet()) return;
  for (const std::string& line : lines) say(line, SaidAs::note);
}

}  // namespace trueshade
