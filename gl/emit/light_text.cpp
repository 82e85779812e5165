#include "gl/emit/light_text.h"

#include <cstring>
#include <map>
#include <mutex>

#include "core/error.h"

namespace trueshade::oracle {
namespace {

/// The names outside functions that shaders of this folder have before a light program's text.
constexpr const char* kOwnNames =
    "float world_position, world_normal, color, base, texcoord, along_u, along_v, ids, alpha_cutoff, double_sided, "
    "normal_scale, materials, lights, light_count, drawn_light, eye, view_axis, clip_from_world, picture_place, position_plane, "
    "normal_plane, albedo_plane, uv_plane, specular_plane, emission_plane, object_plane, material_plane, depth_plane, "
    "world_from_clip, ndc_from_window, ndc_origin, depth_to_ndc, target, color_map, specular_map, normal_map, "
    "metallic_roughness_map, emission_map, occlusion_map, color_texcoord, specular_texcoord, normal_texcoord, "
    "metallic_roughness_texcoord, emission_texcoord, occlusion_texcoord;\n"
    "float unit_normal(vec3 n) { return 0.0; }\nfloat bent_normal(vec3 n, vec3 t) { return 0.0; }\n"
    "float texel_of(int i) { return 0.0; }\n"
    "Light ts_light_of(int i) { Light l; return l; }\nView ts_view() { View v; return v; }\n"
    "vec3 ts_added(Surface s, Light l, View v) { return vec3(0); }\n"
    "bool ts_reaches(Surface s, Light l, View v) { return false; }\n"
    "vec3 ts_start(Surface s, View v) { return vec3(0); }\n"
    "vec4 ts_finish(Surface s, View v, vec3 sum) { return vec4(0); }\n"
    "void ts_keep() {}\nvoid ts_fresh() {}\n";

LightText made(const LightProgram& program) {
  LightText out;
  out.outline = programs::light_outline(program.file, program.text, kOwnNames);
  out.reads = program_reads(program.file, out.outline.inputs);
  return out;
}

}  // namespace

std::shared_ptr<const LightText> light_text_of(const Pipeline& pipeline) {
  static std::mutex mutex;
  static std::map<std::string, std::shared_ptr<const LightText>> kept;
  constexpr size_t kMost = 64;  // programs of a process; then all are compiled anew
  const LightProgram& program = pipeline.light_program;
  if (!program.used()) return nullptr;
  if (program.text.empty())
    throw Error(ErrorKind::usage, program.file, "the text of this light program is not here", "give it with its name");
  std::shared_ptr<const LightText> out;
  {
    const std::lock_guard lock(mutex);
    if (kept.size() >= kMost) kept.clear();
    std::shared_ptr<const LightText>& there = kept[program.file + '\n' + program.text];
    if (there == nullptr) there = std::make_shared<LightText>(made(program));
    out = there;
  }
  check_values(program, out->outline.inputs);
  return out;
}

ProgramReads surface_reads(const Pipeline& pipeline, const GlslOptions& options) {
  const std::shared_ptr<const LightText> text = light_text_of(pipeline);
  if (text == nullptr) return {};
  ProgramReads reads = text->reads;
  reads.material = reads.material || options.unlit;
  return reads;
}

std::vector<uint8_t> parameter_bytes(const Pipeline& pipeline) {
  const std::shared_ptr<const LightText> text = light_text_of(pipeline);
  if (text == nullptr) return {};
  std::vector<uint8_t> bytes(text->outline.parameter_bytes);
  for (const programs::ParameterPlace& place : text->outline.parameters) {
    const float value = parameter_value(place.name, pipeline.light_program).value_or(0.0f);  // else it is not read
    const auto whole = uint32_t(int64_t(place.type == programs::Type::f32 ? 0.0f : value));
    std::memcpy(&bytes[place.offset], place.type == programs::Type::f32 ? static_cast<const void*>(&value) : &whole, 4);
  }
  return bytes;
}

}  // namespace trueshade::oracle
