#include "scenes/pipeline/program_inputs.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/error.h"
#include "scenes/json/json_value.h"
#include "scenes/pipeline/parameter_ranges.h"

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

constexpr const char* kOption = "--light-parameter";

std::string text_of(float value) {
  char text[32];
  return std::string(text, std::to_chars(text, text + sizeof text, value).ptr);
}

std::string text_of(const ProgramParameter& given) {
  std::string text;
  for (const float value : given.value) text += (text.empty() ? "" : ",") + text_of(value);
  return text;
}

/// Those whose names begin with `start`; all where it is empty.
std::string listed(std::span<const std::string> declared, const std::string& start) {
  constexpr size_t kMost = 8;
  std::string text;
  size_t count = 0;
  for (const std::string& one : declared) {
    if (!parameter_type(one).name.starts_with(start) || ++count > kMost) continue;
    text += (text.empty() ? "" : ", ") + one;
  }
  return text + (count > kMost ? ", ..." : "");
}

/// What a type asks of the value; empty where the value has it.
std::string wanted(const ParameterType& type, const ProgramParameter& given) {
  if (given.value.size() != type.components)
    return type.components == 1 ? "give one number" : "give " + std::to_string(type.components) + " numbers";
  const auto is_finite = [](float x) { return std::isfinite(x); };
  if (!std::all_of(given.value.begin(), given.value.end(), is_finite)) return "give finite numbers";
  if (type.is_float) return {};
  const float most = kLargestWholeParameter, least = type.is_signed ? -most : 0.0f;
  const auto is_whole = [&](float x) { return x == std::floor(x) && x >= least && x <= most; };
  if (std::all_of(given.value.begin(), given.value.end(), is_whole)) return {};
  return "give whole numbers from " + std::to_string(int(least)) + " to " + std::to_string(int(most));
}

void check_type(const std::string& file, const ProgramParameter& given, std::span<const std::string> declared) {
  const auto known = std::find_if(declared.begin(), declared.end(),
                                  [&](const std::string& one) { return parameter_type(one).name == given.name; });
  if (known == declared.end()) {
    const std::string parts = listed(declared, given.name + '[') + listed(declared, given.name + '.');
    if (!parts.empty())
      throw Error(ErrorKind::usage, kOption, "'" + given.name + "' of " + file + " is given by its parts", parts);
    throw Error(ErrorKind::usage, kOption, file + " reads no parameter '" + given.name + "'",
                declared.empty() ? "a member of its block Parameters" : "one of: " + listed(declared, ""));
  }
  const ParameterType type = parameter_type(*known);
  const std::string remedy = wanted(type, given);
  if (remedy.empty()) return;
  const char* const article = type.type[0] == 'i' ? "an " : "a ";
  throw Error(ErrorKind::usage, kOption,
              "'" + given.name + "' is " + article + type.type + ", and " + text_of(given) + " is given", remedy);
}

void check_ranges(const LightProgram& program) {
  if (program.parameters.empty()) return;
  const std::vector<DeclaredParameter> declared = declared_parameters(program.text);
  for (const ProgramParameter& given : program.parameters)
    if (const ParameterRange* const range = range_of(declared, given.name.substr(0, given.name.find('['))))
      for (const float value : given.value)
        if (!range->holds(value))
          throw Error(ErrorKind::usage, kOption,
                      "'" + given.name + "' is " + json::number_text(double(value)) + ", which " + program.file +
                          " is not made for",
                      range->text());
}

}  // namespace

void end_at_range(LightVolumes& volumes) {
  for (LightExtent* extent : {&volumes.point, &volumes.spot})
    if (*extent == LightExtent::unbounded) *extent = LightExtent::range;
}

void end_at_range(std::string_view json, LightVolumes& volumes) {
  const json::Value value = json::parse(json, "");
  const json::Node root(value, "");
  if (!root.find("preset")) return;
  LightVolumes unsaid = volumes;
  end_at_range(unsaid);
  const auto said = root.find("light_volumes");
  if (!said || !said->find("point")) volumes.point = unsaid.point;
  if (!said || !said->find("spot")) volumes.spot = unsaid.spot;
}

namespace {

/// Whether the input is a field that captures alone have.
bool note_captured(const std::string& input, CapturedFields& fields) {
  constexpr std::string_view kUser = "surface.user[";
  const bool uv1 = input.starts_with("surface.uv1."), tangent = input.starts_with("surface.tangent.");
  const bool user = input.starts_with(kUser);
  fields.uv1 |= uv1, fields.tangent |= tangent;
  if (user) fields.user[size_t(input[kUser.size()] - '0')] = true;
  return uv1 || tangent || user;
}

}  // namespace

void require_fields(const std::string& file, const CapturedFields& reads, const CapturedFields& there) {
  const auto require = [&file](bool is_read, bool is_there, const std::string& field, const std::string& plane) {
    if (is_read && !is_there)
      throw Error(ErrorKind::bad_input, file, "reads surface." + field + ", which nothing fills here",
                  "shade or validate of a capture, with --map " + plane + "=FILE.CHANNELS");
  };
  require(reads.uv1, there.uv1, "uv1", "uv1");
  require(reads.tangent, there.tangent, "tangent", "tangent");
  for (size_t i = 0; i < reads.user.size(); ++i)
    require(reads.user[i], there.user[i], "user[" + std::to_string(i) + "]", "user" + std::to_string(i));
}

ProgramReads program_reads(const std::string& file, std::span<const std::string> inputs) {
  ProgramReads reads;
  for (const std::string& name : inputs) {
    if (name.starts_with("light.user"))
      throw Error(ErrorKind::bad_input, file, "reads " + name + ", which nothing fills", "another field");
    if (note_captured(name, reads.captured)) continue;
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

std::string without_component(const std::string& name) {
  const size_t end = name.size() - 2;
  const bool is_component =
      name.find('.') < end && name[end] == '.' && std::string_view("xyzw").find(name.back()) != std::string_view::npos;
  return is_component ? name.substr(0, end) : name;
}

std::optional<float> parameter_value(std::string_view input, const LightProgram& program) {
  for (const ProgramParameter& given : program.parameters) {
    const std::optional<std::string_view> rest = behind(given, input);
    if (!rest || (!rest->empty() && rest->size() != 2)) continue;
    const size_t c = rest->empty() ? 0 : std::string_view("xyzw").find((*rest)[1]);
    if (c < given.value.size()) return given.value[c];
  }
  if (!input.starts_with(kParameterBlock)) return std::nullopt;
  const std::vector<DeclaredParameter> declared = declared_parameters(program.text);
  const std::string whole = without_component(std::string(input));
  const ParameterRange* const range = range_of(declared, whole.substr(std::string_view(kParameterBlock).size()));
  return range != nullptr ? range->usual : std::nullopt;
}

ParameterType parameter_type(const std::string& declaration) {
  const size_t space = declaration.find(' ');
  ParameterType out{declaration.substr(0, space), declaration.substr(space + 1)};
  const char last = out.type.back();
  if (last >= '2' && last <= '4') out.components = size_t(last - '0');
  out.is_float = out.type[0] == 'f' || out.type[0] == 'v';
  out.is_signed = out.type[0] != 'u';
  return out;
}

void check_given(const LightProgram& program, std::span<const std::string> inputs,
                 std::span<const std::string> declared) {
  for (const ProgramParameter& given : program.parameters) {
    const auto is_same = [&](const ProgramParameter& p) { return p.name == given.name; };
    if (std::count_if(program.parameters.begin(), program.parameters.end(), is_same) > 1)
      throw Error(ErrorKind::usage, kOption, "'" + given.name + "' is given twice", "give it once");
    check_type(program.file, given, declared);
    if (std::none_of(inputs.begin(), inputs.end(), [&](const std::string& input) { return behind(given, input); }))
      throw Error(ErrorKind::usage, kOption,
                  program.file + " reads no parameter '" + given.name + "', which it declares", "leave it out");
  }
  check_ranges(program);
}

void check_values(const LightProgram& program, std::span<const std::string> inputs,
                  std::span<const std::string> declared) {
  check_given(program, inputs, declared);
  for (const std::string& input : inputs)
    if (input.starts_with(kParameterBlock) && !parameter_value(input, program))
      throw Error(ErrorKind::usage, program.file, "nothing gives " + input,
                  "--light-parameter " + input.substr(std::string_view(kParameterBlock).size()) + "=VALUE");
}

void check_lights(std::span<const Light> lights, const std::string& by, std::span<const std::string> inputs) {
  if (std::any_of(inputs.begin(), inputs.end(), [](const std::string& i) { return i.starts_with("light.right"); }))
    return;
  const auto light = std::find_if(lights.begin(), lights.end(), [](const Light& l) { return has_area(l.type); });
  if (light != lights.end())
    throw Error(ErrorKind::bad_input, by,
                "light " + std::to_string(light - lights.begin()) + " is a " + std::string(name_of(light->type)) +
                    ", and this light model has no lights with an area",
                "--light-shader area, or a light program that reads `right`");
}

void check_lights(std::span<const Light> lights, const Pipeline& pipeline) {
  if (!pipeline.light_program.used()) check_lights(lights, pipeline.preset, {});
}

void check_camera(const Camera& camera, const std::string& file, std::span<const std::string> inputs) {
  if (!camera.clip_from_world) return;
  for (const std::string& input : inputs)
    if (input.starts_with("view.view[") || input.starts_with("view.projection["))
      throw Error(ErrorKind::bad_input, file,
                  "reads " + without_component(input) + ", and the camera is one matrix, their product",
                  "view_projection, or a camera with eye and target");
}

}  // namespace trueshade
