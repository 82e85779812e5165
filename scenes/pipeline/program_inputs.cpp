#include "scenes/pipeline/program_inputs.h"

#include <algorithm>

#include "core/error.h"

namespace trueshade {
namespace {

/// What stands behind the whole name of a parameter in an input; nothing where it is another's.
std::optional<std::string_view> behind(const ProgramParameter& given, std::string_view input) {
  const std::string whole = "parameters." + given.name;
  if (!input.starts_with(whole)) return std::nullopt;
  const std::string_view rest = input.substr(whole.size());
  if (!rest.empty() && rest[0] != '.' && rest[0] != '[') return std::nullopt;
  return rest;
}

}  // namespace

void end_at_range(LightVolumes& volumes) {
  for (LightExtent* extent : {&volumes.point, &volumes.spot})
    if (*extent == LightExtent::unbounded) *extent = LightExtent::range;
}

ProgramReads program_reads(const std::string& file, std::span<const std::string> inputs) {
  ProgramReads reads;
  for (const std::string& name : inputs) {
    for (const std::string_view absent : {"surface.uv1", "surface.tangent", "surface.user", "light.user"})
      if (name.starts_with(absent))
        throw Error(ErrorKind::bad_input, file, "reads " + name + ", which nothing fills yet", "another field");
    const auto is = [&name](std::string_view field) { return name.starts_with(field); };
    reads.gloss = reads.gloss || is("surface.specular") || is("surface.shininess");
    reads.metals = reads.metals || is("surface.metallic") || is("surface.roughness");
    reads.emission = reads.emission || is("surface.emission") || is("surface.occlusion");
    reads.uv = reads.uv || is("surface.uv");
    reads.object = reads.object || is("surface.object");
    reads.material = reads.material || is("surface.material");
  }
  if (reads.gloss && reads.metals)
    throw Error(ErrorKind::bad_input, file,
                "reads both specular or shininess and metallic or roughness, which share a plane", "one pair of them");
  return reads;
}

Pipeline with_planes_of(const Pipeline& pipeline, const ProgramReads& reads) {
  Pipeline out = pipeline;
  LightModel& m = out.light_model;
  m = {};
  m.alpha_from_albedo = pipeline.light_model.alpha_from_albedo;
  m.falloff = Falloff::none, m.diffuse = Diffuse::unclamped, m.cone = Cone::none;
  m.order = TermOrder::albedo_last;  // unlit surfaces keep their colour as albedo
  m.specular = reads.gloss || reads.metals ? Specular::blinn_phong : Specular::none;
  m.specular_source = reads.metals ? SpecularSource::metallic_roughness : SpecularSource::material;
  m.keeps_metals = reads.metals;
  m.emission = reads.emission;
  return out;
}

std::optional<float> parameter_value(std::string_view input, const LightProgram& program) {
  for (const ProgramParameter& given : program.parameters) {
    const std::optional<std::string_view> rest = behind(given, input);
    if (!rest || (!rest->empty() && rest->size() != 2)) continue;
    const size_t c = rest->empty() ? 0 : std::string_view("xyzw").find((*rest)[1]);
    if (c < given.value.size()) return given.value[c];
  }
  return std::nullopt;
}

void check_values(const LightProgram& program, std::span<const std::string> inputs) {
  for (const ProgramParameter& given : program.parameters) {
    const auto is_same = [&](const ProgramParameter& p) { return p.name == given.name; };
    if (std::count_if(program.parameters.begin(), program.parameters.end(), is_same) > 1)
      throw Error(ErrorKind::usage, "--light-parameter", "'" + given.name + "' is given twice", "give it once");
    const bool is_scalar = std::find(inputs.begin(), inputs.end(), "parameters." + given.name) != inputs.end();
    if (is_scalar && given.value.size() > 1)
      throw Error(ErrorKind::usage, "--light-parameter",
                  "'" + given.name + "' is one number, not " + std::to_string(given.value.size()), "give one number");
  }
  for (const ProgramParameter& given : program.parameters)
    if (std::none_of(inputs.begin(), inputs.end(), [&](const std::string& input) { return behind(given, input); }))
      throw Error(ErrorKind::usage, "--light-parameter", program.file + " reads no parameter '" + given.name + "'",
                  "a member of its block Parameters");
  for (const std::string& input : inputs) {
    const bool parameter = input.starts_with("parameters.");
    if (parameter ? !parameter_value(input, program)
                  : input.starts_with("view.view[") || input.starts_with("view.projection["))
      throw Error(ErrorKind::usage, program.file, "nothing gives " + input,
                  parameter ? "--light-parameter NAME=VALUE" : "another field");
  }
}

}  // namespace trueshade
