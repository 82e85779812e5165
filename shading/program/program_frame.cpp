#include "shading/program/program_frame.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string_view>

#include "core/error.h"
#include "programs/building/specialised.h"
#include "programs/front/light_program.h"
#include "raster/view.h"
#include "scenes/pipeline/light_values.h"

namespace trueshade {
namespace {

using programs::Executable;
using programs::ProgramInput;
using programs::Rate;

bool starts(std::string_view name, std::string_view field) { return name.starts_with(field); }

std::vector<std::string> input_names(const Executable& executable) {
  std::vector<std::string> names;
  for (const ProgramInput& input : executable.program.inputs) names.push_back(input.name);
  return names;
}

/// The number behind the last point of a name, "x" to "w" as 0 to 3.
int component_of(std::string_view name) {
  const size_t at = std::string_view("xyzw").find(name.back());
  return at == std::string_view::npos ? 0 : int(at);
}

/// The element of a matrix, "view.projection[2].y", column-major.
size_t element_of(std::string_view name) {
  const size_t column = size_t(name[name.find('[') + 1] - '0');
  return 4 * column + size_t(component_of(name));
}

uint32_t bits_of(float value) { return std::bit_cast<uint32_t>(value); }

double aspect_of(const Pipeline& pipeline) {
  const Viewport& v = pipeline.geometry.viewport;
  const bool whole = v.width == 0 && v.height == 0;
  return whole ? double(pipeline.width) / pipeline.height : double(v.width) / v.height;
}

/// An element of a matrix of the view, as the vertex shader has it before it is rounded; check_camera() has seen it.
std::optional<uint32_t> of_matrices(std::string_view name, const Camera& camera, const Pipeline& pipeline) {
  const ClipRange range = clip_range(pipeline.geometry);
  const auto element = [name](const Matrix4& matrix) { return bits_of(float(matrix[element_of(name)])); };
  if (starts(name, "view.view_projection[")) return element(clip_from_world(camera, aspect_of(pipeline), range));
  if (starts(name, "view.projection[")) return element(clip_from_view(camera, aspect_of(pipeline), range));
  if (starts(name, "view.view[")) return element(view_from_world(camera));
  return std::nullopt;
}

/// A value that holds for the whole frame; nothing where the name is no field of the view.
std::optional<uint32_t> of_view(std::string_view name, const Scene& scene, const Pipeline& pipeline) {
  const Camera& camera = scene.camera;
  const glm::vec3 axis = view_axis(camera);
  const int c = component_of(name);
  if (starts(name, "view.eye")) return bits_of(camera.eye[c]);
  if (starts(name, "view.axis")) return bits_of(-axis[c]);
  if (starts(name, "view.size")) return bits_of(float(c == 0 ? pipeline.width : pipeline.height));
  if (name == "view.time") return bits_of(float(scene.time));
  if (name == "view.frame") return frame_at(scene);
  return of_matrices(name, camera, pipeline);
}

/// A parameter, whose value is a number, as its type has it.
std::optional<uint32_t> of_parameters(const ProgramInput& input, const LightProgram& program) {
  const std::optional<float> value = parameter_value(input.name, program);
  if (!value) return std::nullopt;
  return input.type == programs::Type::f32 ? bits_of(*value) : uint32_t(int64_t(*value));
}

}  // namespace

namespace {

/// types: of lights, all where it is empty.
std::shared_ptr<const Executable> kept_executable(const LightProgram& program, const std::vector<uint32_t>& types) {
  static std::mutex mutex;
  static std::map<std::pair<std::string, std::vector<uint32_t>>, std::shared_ptr<const Executable>> kept;
  constexpr size_t kMost = 64;  // programs of a process; then all are compiled anew
  const std::shared_ptr<const programs::Program> made = programs::kept_program(program.file, program.text);
  const std::pair key(made->name + '\n' + made->sha256, types);
  const std::lock_guard lock(mutex);
  if (const auto there = kept.find(key); there != kept.end()) return there->second;
  if (kept.size() >= kMost) kept.clear();
  const auto wanted = made->defines_reaches ? programs::Wanted::light_and_reaches : programs::Wanted::light;
  const programs::Program of_types = types.empty() ? *made : programs::specialised(*made, {{"light.type", types}});
  return kept[key] = std::make_shared<Executable>(programs::executable_of(of_types, wanted));
}

}  // namespace

std::shared_ptr<const Executable> executable_of(const LightProgram& program) { return kept_executable(program, {}); }

std::shared_ptr<const Executable> executable_of(const LightProgram& program, std::span<const Light> lights) {
  std::set<uint32_t> types;
  for (const Light& light : lights) types.insert(uint32_t(light.type));
  return kept_executable(program, {types.begin(), types.end()});
}

Pipeline with_planes_of_program(const Pipeline& pipeline) {
  if (!pipeline.light_program.used()) return pipeline;
  const std::shared_ptr<const Executable> executable = executable_of(pipeline.light_program);
  return with_planes_of(pipeline, program_reads(executable->program.name, input_names(*executable)));
}

ProgramFrame::ProgramFrame(const Scene& scene, const Pipeline& pipeline, Unlit unlit, const CapturedFields& there)
    : executable_(trueshade::executable_of(pipeline.light_program, scene.lights)), constants_(*executable_) {
  // What it lacks is said whatever the lights are.
  const std::shared_ptr<const Executable> whole = trueshade::executable_of(pipeline.light_program);
  const std::vector<std::string> inputs = input_names(*whole);
  const std::string& name = whole->program.name;
  reads_ = program_reads(name, inputs);
  require_fields(name, reads_.captured, there);
  check_values(pipeline.light_program, inputs, whole->program.parameters);
  check_camera(scene.camera, name, inputs);
  check_lights(scene.lights, name, inputs);
  for (const Material& m : scene.materials) {
    unlit_.push_back(m.unlit && unlit == Unlit::shows_albedo);
    has_unlit_ = has_unlit_ || unlit_.back() != 0;
  }
  set_constants(scene, pipeline);
  set_lights(scene);
}

void ProgramFrame::set_constants(const Scene& scene, const Pipeline& pipeline) {
  const programs::Program& program = executable_->program;
  const programs::Stage& stage = executable_->at(Rate::constant);
  for (size_t i = 0; i < stage.inputs.size(); ++i) {
    const ProgramInput& input = program.inputs[stage.inputs[i]];
    std::optional<uint32_t> value = of_view(input.name, scene, pipeline);
    if (!value) value = of_parameters(input, pipeline.light_program);
    constants_.set_input(i, value.value());  // check_values() has refused what has none
  }
  programs::Registers registers(*executable_);
  run_constants(*executable_, constants_, registers);
}

void ProgramFrame::set_lights(const Scene& scene) {
  const programs::Stage& stage = executable_->at(Rate::light);
  const size_t blocks = scene.lights.size() / programs::kBlockLanes + 1;
  lights_ = std::make_unique<programs::LaneValues>(stage, blocks * programs::kBlockLanes);
  light_planes_.resize(stage.inputs.size() * blocks);
  for (size_t i = 0; i < stage.inputs.size(); ++i) {
    float* const plane = light_planes_[i * blocks].lane;
    const LightValue value = light_value(executable_->program.inputs[stage.inputs[i]].name);
    std::fill_n(plane, blocks * programs::kBlockLanes, 0.0f);
    for (size_t k = 0; k < scene.lights.size(); ++k) {
      const uint32_t bits = value.of(scene.lights[k], uint32_t(k));
      std::memcpy(plane + k, &bits, sizeof bits);
    }
    lights_->set_input(i, plane);
  }
  programs::Registers registers(*executable_);
  run_lights(*executable_, constants_, *lights_, registers);
}

const void* ProgramFrame::plane_of(size_t input, const SurfaceTile& surface, const uint32_t* const pixels[2]) const {
  const std::string_view name = executable_->program.inputs[executable_->at(Rate::surface).inputs[input]].name;
  const int c = component_of(name);
  if (starts(name, "surface.position")) return surface.plane[kPosition + c];
  if (starts(name, "surface.normal")) return surface.plane[kNormal + c];
  if (starts(name, "surface.albedo")) return surface.plane[kAlbedo + c];
  if (starts(name, "surface.specular")) return surface.plane[kSpecular + c];
  if (name == "surface.shininess") return surface.plane[kShininess];
  if (name == "surface.metallic") return surface.plane[kSpecular];
  if (name == "surface.roughness") return surface.plane[kSpecular + 1];
  if (starts(name, "surface.emission")) return surface.plane[kEmission + c];
  if (name == "surface.occlusion") return surface.plane[kOcclusion];
  if (starts(name, "surface.uv.")) return surface.plane[kUv + c];
  if (starts(name, "surface.uv1.")) return surface.captured->plane[kUv1 + c];
  if (starts(name, "surface.tangent.")) return surface.captured->plane[kTangent + c];
  if (constexpr std::string_view kField = "surface.user["; starts(name, kField))
    return surface.captured->plane[kUser + 4 * (name[kField.size()] - '0') + c];
  if (name == "surface.object") return surface.object;
  if (name == "surface.material") return surface.material;
  return name == "surface.pixel_x" ? pixels[0] : pixels[1];
}

}  // namespace trueshade
