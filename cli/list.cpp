#include <algorithm>
#include <iterator>
#include <optional>
#include <string>
#include <utility>

#include "cli/commands.h"
#include "cli/json_text.h"
#include "cli/option_values.h"
#include "cli/preparation.h"
#include "core/numeric_profile.h"
#include "core/standard_input.h"
#include "judge/bounds/profile_names.h"
#include "judge/diagnosis/finding.h"
#include "programs/front/light_outline.h"
#include "scenes/builtin/builtin.h"
#include "scenes/light_models/stated_model.h"
#include "scenes/pipeline/parameter_ranges.h"
#include "scenes/pipeline/presets.h"
#include "scenes/pipeline/program_inputs.h"
#include "scenes/pipeline/shipped_models.h"
#include "shading/frame.h"

namespace trueshade {
namespace {

/// One heading of the list: names, each with a line about it or none.
struct Section {
  std::string key, heading;
  std::vector<std::pair<std::string, std::string>> entries;
};

std::vector<Section> sections() {
  Section scenes{"scenes", "Scenes (render builtin:NAME)", {}}, rows{"presets", "Presets (--preset)", {}};
  Section strategies{"strategies", "Strategies (--strategy)", {}};
  constexpr std::pair<Strategy, const char*> kAbout[] = {
      {Strategy::forward_multipass, "every object once a light, added to the target after each"},
      {Strategy::forward_loop, "every object once, all lights summed in float32, one store"},
      {Strategy::deferred_volumes, "G-buffer, then each light's geometry, blended and rounded light by light"},
      {Strategy::deferred_loop, "G-buffer, then all lights summed in float32, one store"}};
  static_assert(std::size(kAbout) == std::size(kStrategyNames));
  for (const auto& [strategy, about] : kAbout) strategies.entries.emplace_back(name_of(strategy), about);
  Section profiles{"profiles", "Profiles (--profile): whose bits where OpenGL leaves a choice", {}};
  constexpr std::pair<NumericProfile, const char*> kWhose[] = {
      {NumericProfile::ideal, "our own: exact snapping, nearest stores, blending in float32"},
      {NumericProfile::mesa_llvmpipe_22_3, "that driver's, on a CPU with FMA (docs/arithmetic.md section 11)"}};
  static_assert(std::size(kWhose) == std::size(kProfileNames));
  for (const auto& [profile, whose] : kWhose) profiles.entries.emplace_back(profile_name(profile), whose);
  Section drivers{"driver_profiles", "Profiles that validate holds a driver to (--profile)", {}};
  for (const std::string_view name : oracle::kDriverProfileNames) drivers.entries.emplace_back(name, "");
  Section models{"light_models", "Light models (--light-shader; `trueshade list NAME` says what one reads)", {}};
  for (const ShippedModel& model : shipped_models()) models.entries.emplace_back(model.name, model.about);
  Section formats{"formats", "Formats", {}}, planes{"aovs", "Planes (--aov)", {}};
  Section views{"views", "Views (--view)", {}};
  Section simd{"simd", "SIMD targets of this build that this machine runs, best first (--simd)", {}};
  for (const BuiltinInfo& scene : builtin_scenes()) scenes.entries.emplace_back(scene.name, scene.description);
  for (const Preset& preset : presets()) rows.entries.emplace_back(preset.name, preset.source);
  for (const Format format : kFormats) formats.entries.emplace_back(info(format).name, "");
  for (const std::string_view name : aov_names()) planes.entries.emplace_back(name, "");
  planes.entries.emplace_back("light.<i>", "what light i alone adds; i counts from 0");
  for (const std::string_view name : kViewNames) views.entries.emplace_back(name, "");
  for (const std::string_view name : simd_targets()) simd.entries.emplace_back(name, "");
  Section faults{"faults", "Faults that validate looks for (--suppose)", {}};
  for (const oracle::KnownFault& fault : oracle::known_faults()) faults.entries.emplace_back(fault.name, fault.text);
  Section schemas{
      "schemas", "JSON Schemas, for editors (installed in share/trueshade, in the sources in scenes/schemas)", {}};
  schemas.entries = {{"scene.schema.json", "of scene files"}, {"pipeline.schema.json", "of pipeline files"}};
  return {scenes, rows, models, strategies, profiles, drivers, formats, planes, views, simd, faults, schemas};
}

std::string json_of(const std::vector<Section>& list) {
  JsonObject json;
  for (const Section& section : list) {
    JsonArray names;
    for (const auto& [name, about] : section.entries)
      names.add_raw(about.empty() ? json_string(name)
                                  : JsonObject().put("name", name).put("description", about).text());
    json.put_raw(section.key, names.text());
  }
  return json.text() + '\n';
}

std::string text_of(const std::vector<Section>& list) {
  std::string text;
  for (const Section& section : list) {
    text += section.heading + '\n';
    for (const auto& [name, about] : section.entries)
      text += "  " + (about.empty() ? name : name + std::string(name.size() < 16 ? 16 - name.size() : 1, ' ') + about) +
              '\n';
  }
  return text;
}

struct ParameterFacts {
  std::string name, type, range;  ///< type: of GLSL; range: empty where the program states none
  std::optional<float> usual;
};

/// What a user of a light program must know of it.
struct ProgramFacts {
  LightProgram program;
  std::string about;  ///< of a model that ships
  std::vector<ParameterFacts> parameters;
  std::vector<std::string> fields;              ///< that it reads: surface.normal, light.range
  std::vector<std::string> functions{"light"};  ///< that it defines
};

std::string glsl_type(programs::Type type, size_t components) {
  constexpr const char *kScalar[] = {"float", "int", "uint", "bool"}, *kVector[] = {"vec", "ivec", "uvec", "bvec"};
  return components == 1 ? kScalar[size_t(type)] : kVector[size_t(type)] + std::to_string(components);
}

/// The program of a preset's light model, of a model that ships, or of a file. A preset that draws by a model that
/// ships has that one's name.
void find_program(const std::string& name, ProgramFacts& facts) {
  const auto preset = std::find_if(presets().begin(), presets().end(),
                                   [&](const Preset& p) { return p.name == name && !p.pipeline.light_program.used(); });
  if (preset == presets().end()) {
    facts.program = light_program_of(name);
    if (names_shipped_model(name)) facts.about = shipped_model(name).about;
    return;
  }
  facts.program = program_of(preset->pipeline.light_model, name);
  facts.about = preset->source;
}

ProgramFacts facts_of(const std::string& name) {
  ProgramFacts facts;
  find_program(name, facts);
  const programs::LightOutline outline = programs::light_outline(facts.program.file, facts.program.text);
  const std::vector<DeclaredParameter> declared = declared_parameters(facts.program.text);
  for (size_t i = 0, next = 0; i < outline.parameters.size(); i = next) {
    const std::string whole = without_component(outline.parameters[i].name);
    for (next = i; next < outline.parameters.size() && without_component(outline.parameters[next].name) == whole;)
      ++next;
    const std::string own = whole.substr(kParameterBlock.size());
    const ParameterRange* const range = range_of(declared, own);
    facts.parameters.push_back({own, glsl_type(outline.parameters[i].type, next - i),
                                range ? range->text() : std::string(), range ? range->usual : std::nullopt});
  }
  for (const std::string& input : outline.inputs)
    if (const std::string field = without_component(input); !field.starts_with(kParameterBlock) &&
                                                            !field.starts_with("sum.") &&
                                                            (facts.fields.empty() || facts.fields.back() != field))
      facts.fields.push_back(field);
  if (outline.defines_reaches) facts.functions.emplace_back("reaches");
  if (outline.defines_start) facts.functions.emplace_back("start");
  if (outline.defines_finish) facts.functions.emplace_back("finish");
  return facts;
}

std::string json_of(const ProgramFacts& facts) {
  JsonObject json;
  json.put("name", facts.program.file);
  if (!facts.about.empty()) json.put("description", facts.about);
  json.put("sha256", facts.program.sha256);
  if (!is_spirv(facts.program.text)) json.put("text", facts.program.text);
  JsonArray parameters, reads, defines;
  for (const ParameterFacts& parameter : facts.parameters) {
    JsonObject one;
    one.put("name", parameter.name).put("type", parameter.type);
    if (!parameter.range.empty()) one.put("range", parameter.range);
    if (parameter.usual) one.put("usual", double(*parameter.usual));
    parameters.add_raw(one.text());
  }
  for (const std::string& field : facts.fields) reads.add_raw(json_string(field));
  for (const std::string& function : facts.functions) defines.add_raw(json_string(function));
  json.put_raw("parameters", parameters.text()).put_raw("reads", reads.text()).put_raw("defines", defines.text());
  return json.text() + '\n';
}

std::string text_of(const ProgramFacts& facts) {
  Section what{"", facts.program.file, {{"sha256", facts.program.sha256}}};
  if (!facts.about.empty()) what.heading += ": " + facts.about;
  Section parameters{"", "Parameters (--light-parameter NAME=VALUE)", {}};
  for (const ParameterFacts& one : facts.parameters)
    parameters.entries.emplace_back(one.name, one.type + (one.range.empty() ? "" : ", " + one.range) +
                                                  (one.usual ? ", usually " + json_number(double(*one.usual)) : ""));
  if (facts.parameters.empty()) parameters.entries = {{"none", ""}};
  Section reads{"", "Reads", {}}, defines{"", "Defines", {}};
  for (const std::string& field : facts.fields) reads.entries.emplace_back(field, "");
  for (const std::string& function : facts.functions) defines.entries.emplace_back(function, "");
  const std::string& text = facts.program.text;
  return text_of(std::vector{what, parameters, reads, defines}) + (is_spirv(text) ? "" : "Text\n" + text);
}

/// All lists, or the one that is named, as it is called here or in the JSON. Nothing where a light program is named.
/// Error(usage) for a name that is neither.
std::optional<std::vector<Section>> lists_of(const std::string& name) {
  std::vector<Section> all = sections();
  if (name.empty()) return all;
  for (size_t i = 0; i < std::size(kListNames); ++i)
    if (name == kListNames[i] || name == all.at(i).key) return std::vector{std::move(all.at(i))};
  std::vector<std::string_view> known(std::begin(kListNames), std::end(kListNames));
  for (const std::string_view preset : preset_names()) known.push_back(preset);
  for (const ShippedModel& model : shipped_models()) known.push_back(model.name);
  if (name != kStandardInputName && names_shipped_model(name) &&
      std::find(known.begin(), known.end(), name) == known.end())
    throw usage("NAME", "there is no list, preset or light model '" + name + "'",
                did_you_mean(name, known) + "one of: " + joined(kListNames) +
                    ", or a preset, a light model, or a light program's file with its ending");
  return std::nullopt;
}

}  // namespace

void print_list(const ListOptions& options) {
  const std::optional<std::vector<Section>> lists = lists_of(options.name);
  if (lists && options.text)
    throw usage("--text", "lists are no GLSL", "name a preset or a light model, or leave it out");
  if (lists) return print(options.json ? json_of(*lists) : text_of(*lists));
  const ProgramFacts facts = facts_of(options.name);
  if (options.text) return print(facts.program.text);
  print(options.json ? json_of(facts) : text_of(facts));
}

}  // namespace trueshade
