#include "view/scene_source.h"

#include <algorithm>
#include <utility>

#include "core/file_ending.h"
#include "scenes/files/content/scene_files.h"
#include "scenes/scene_defaults.h"
#include "scenes/timeline_end.h"

namespace trueshade::viewer {
namespace {

/// `city` of builtin:city,seed=3 and of models/city.gltf.
std::string name_of_spec(const std::string& spec) {
  constexpr std::string_view kBuiltin = "builtin:";
  if (spec.starts_with(kBuiltin)) return spec.substr(kBuiltin.size(), spec.find(',') - kBuiltin.size());
  const std::string file = spec.substr(spec.rfind('/') + 1);  // npos + 1 is 0
  return file.substr(0, file.find('.', 1));
}

/// Notes the scene that a scene file refers to, and the text of the camera that the file itself states.
void read_reference(const SceneSource& source, SceneFacts& facts) {
  if (!has_ending(source.spec, ".json")) return;
  const Bytes bytes = read_user_file(source.spec, source.limits.json_bytes, "--max-json");
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  facts.reference = reference_of_text(text, source.spec, source.limits);
  if (!facts.reference) return;
  const json::Value value = json::parse(text, source.spec);
  if (const auto camera = json::Node(value, source.spec).find("camera"))
    facts.camera_text = json::text_of(camera->value());
}

}  // namespace

OpenedScene opened_scene(const SceneSource& source, std::vector<std::string>& files) {
  OpenedScene opened;
  SceneFacts& facts = opened.facts;
  const FilesRead read;
  struct Keep {  // also where loading throws
    const FilesRead& read;
    std::vector<std::string>& files;
    ~Keep() { files = read.paths(); }
  } const keep{read, files};
  Scene scene = source.load();
  facts.spec = source.spec;
  facts.name = name_of_spec(source.spec);
  facts.pipeline = source.pipeline(scene);
  if (source.bring_to_looks) facts.looks = source.bring_to_looks(scene, facts.pipeline);
  read_reference(source, facts);
  facts.files = read.paths();
  std::erase(facts.files, facts.pipeline.light_program.file);  // the window loads it by itself
  facts.lights = scene.lights;
  facts.clear = scene.clear;
  facts.fps = scene.timeline.fps;
  facts.last_time = std::min(end_of(scene.timeline).last, kLongestTime);
  facts.moves = !scene.timeline.empty() && facts.last_time > 0.0;
  const Bounds bounds = bounds_of(scene);
  facts.reach = bounds.radius > 0.0 ? bounds.radius : 1.0;
  facts.triangles = scene.triangle_count();
  opened.scene = std::make_unique<EditedScene>(std::move(scene));
  return opened;
}

}  // namespace trueshade::viewer
