// The tables of commands that tell of scenes and write them for others: info, list, glsl, export.
#include <algorithm>

#include "cli/command_tables.h"
#include "cli/option_values.h"
#include "scenes/pipeline/shipped_models.h"

namespace trueshade {
namespace {

const char* const kOnlyAnswerHelp = "Say no progress; what is printed is the answer";

oracle::ShaderApi shader_api_from_text(const std::string& text) {
  const auto found = std::find(std::begin(oracle::kShaderApiNames), std::end(oracle::kShaderApiNames), text);
  if (found == std::end(oracle::kShaderApiNames))
    throw unknown_name("--api", "there is no", text, oracle::kShaderApiNames);
  return oracle::ShaderApi(found - std::begin(oracle::kShaderApiNames));
}

}  // namespace

CommandTable info_table(InfoOptions& options) {
  CommandTable table{"info", "Say what is in a scene or an image"};
  add_value(table, "FILE", "SCENE", options.file, "Scene (as for render), or image (.png, .exr)").is_required = true;
  table.open_group = "Output";
  add_switch(table, "--json", options.json, "As one JSON document, without what the text leaves out (docs/scenes.md)");
  add_switch(table, "--resolved", options.resolved,
             "Print every number of a scene as the renderer has it, as JSON (docs/resolved.md)");
  const auto read_folder = [](const std::string& text) {
    if (text.empty()) throw usage("-o", "'' is no name of a folder", "name one");
    return text;
  };
  add_read(table, "-o,--output", "FOLDER", options.folder, read_folder,
           "With --resolved: folder for resolved.json and resolved.bin; made if it is not there");
  add_quiet(table, options, "Say neither progress nor which files were written");
  add_size(table, options.size);
  add_time(table, options);
  add_camera(table, options);
  add_layers(table, options);
  add_strategy(table, options);
  add_target(table, options);
  add_profile(table, options);
  add_lenient(table, options.limits);
  add_trust(table, options.limits);
  add_limits(table, options.limits);
  table.examples = {{"trueshade info model.glb", "Bounds, lights, cameras, animations, textures and memory."},
                    {"trueshade info out.exr", "Sizes, channels, and the hashes and pipeline that a file carries."},
                    {"trueshade info builtin:city --resolved -o numbers", "Every number of a scene, as files."}};
  table.see_also = {"render", "list"};
  table.finished = [&options]() -> Command { return finished(std::move(options)); };
  return table;
}

CommandTable list_table(ListOptions& options) {
  CommandTable table{"list", "List scenes, presets, light models, formats, planes and SIMD targets"};
  OptionRow& name = add_value(
      table, "NAME", "NAME", options.name,
      "One list alone (" + joined(kListNames) + "), or what a preset, a light model or a light program's file reads");
  name.known_values.assign(std::begin(kListNames), std::end(kListNames));
  for (const std::string_view preset : preset_names()) name.known_values.emplace_back(preset);
  for (const ShippedModel& shipped : shipped_models())
    if (std::find(name.known_values.begin(), name.known_values.end(), shipped.name) == name.known_values.end())
      name.known_values.emplace_back(shipped.name);
  table.open_group = "Output";
  add_switch(table, "--json", options.json, "As one JSON document");
  add_switch(table, "--text", options.text, "Of a preset or a light model, its GLSL alone");
  add_quiet(table, options, kOnlyAnswerHelp);
  table.examples = {{"trueshade list presets", "One list alone."},
                    {"trueshade list many-lights --text > mine.glsl", "A preset's formula, to be changed."},
                    {"trueshade list gltf", "What a light model is, its parameters, and the fields that it reads."}};
  table.see_also = {"info"};
  table.finished = [&options]() -> Command { return options; };
  return table;
}

CommandTable glsl_table(GlslFilesOptions& options) {
  CommandTable table{"glsl", "Write a pipeline, or a whole frame, as shaders and state for a GPU"};
  add_value(table, "SCENE", "SCENE", options.scene, kSceneHelp);
  table.open_group = "Output";
  add_value(table, "-o,--output", "FOLDER", options.folder, "Folder for the files; made if it is not there")
      .is_required = true;
  of_names(add_read(table, "--api", "NAME", options.api, shader_api_from_text, "Whose GLSL and state, without it gl:"),
           oracle::kShaderApiNames);
  add_switch(table, "--maps", options.maps,
             "Without a scene: materials with colour, specular and normal maps and alpha masks");
  add_quiet(table, options, "Say neither progress nor which files were written");
  add_size(table, options.size);
  add_time(table, options);
  add_camera(table, options);
  add_layers(table, options);
  add_light_program(table, options);
  add_strategy(table, options);
  add_trust(table, options.limits);
  add_limits(table, options.limits);
  table.examples = {{"trueshade glsl --preset redsdk -o shaders", "A preset's shaders, with the state around them."}};
  table.see_also = {"validate"};
  table.finished = [&options]() -> Command { return finished(std::move(options)); };
  return table;
}

CommandTable export_table(ExportOptions& options) {
  CommandTable table{"export", "Write a scene as a GLB file, for other programs and for this one"};
  add_value(table, "SCENE", "SCENE", options.scene, kSceneHelp).is_required = true;
  table.open_group = "Output";
  add_value(table, "-o,--output", "FILE", options.output, "File to write: .glb, or - for standard output").is_required =
      true;
  add_quiet(table, options, "Say neither notes nor progress nor which file was written");
  add_read(table, "--time", "SECONDS", options.time, time_from_text,
           "Write the scene as it stands at this time, without what moves")
      .group = kCameraGroup;
  add_camera(table, options);
  add_trust(table, options.limits);
  add_limits(table, options.limits);
  table.examples = {{"trueshade export builtin:city -o city.glb", "A scene for other programs."}};
  table.see_also = {"render", "info"};
  table.finished = [&options]() -> Command { return finished(std::move(options)); };
  return table;
}

}  // namespace trueshade
