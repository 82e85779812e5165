#include <iterator>
#include <string>
#include <utility>

#include "cli/commands.h"
#include "cli/json_text.h"
#include "core/numeric_profile.h"
#include "judge/bounds/profile_names.h"
#include "judge/diagnosis/finding.h"
#include "scenes/builtin/builtin.h"
#include "scenes/pipeline/presets.h"
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
  Section formats{"formats", "Formats", {}}, planes{"aovs", "Planes (--aov)", {}};
  Section views{"views", "Views (--view)", {}};
  Section simd{"simd", "SIMD targets of this machine, best first (--simd)", {}};
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
  return {scenes, rows, strategies, profiles, drivers, formats, planes, views, simd, faults, schemas};
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

}  // namespace

void print_list(const ListOptions& options) { print(options.json ? json_of(sections()) : text_of(sections())); }

}  // namespace trueshade
