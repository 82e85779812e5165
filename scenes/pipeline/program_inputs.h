#pragma once
#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "scenes/camera.h"
#include "scenes/light.h"
#include "scenes/pipeline/pipeline.h"

// What a pipeline makes of the inputs that a light program reads. Their names are those of
// programs/light_interface.glsl, a scalar each: "surface.normal.x", "parameters.gain".
namespace trueshade {

/// What the names of parameters begin with among inputs.
inline constexpr std::string_view kParameterBlock = "parameters.";

/// What a light program's lights are bounded by where nothing else is said: geometry of lights stays.
void end_at_range(LightVolumes& volumes);
/// The same of what a pipeline's JSON leaves unsaid that names a preset: the preset stands in the place of what was there.
void end_at_range(std::string_view json, LightVolumes& volumes);

/// Fields of a surface that captures alone have: planes that --map names.
struct CapturedFields {
  bool uv1 = false, tangent = false;
  std::array<bool, 4> user{};
  bool any() const { return uv1 || tangent || user[0] || user[1] || user[2] || user[3]; }
  bool operator==(const CapturedFields&) const = default;
};

/// Which fields of a surface a light program reads, beside position, normal and albedo.
struct ProgramReads {
  bool gloss = false;     ///< specular, shininess
  bool metals = false;    ///< metallic, roughness
  bool emission = false;  ///< emission, occlusion
  bool uv = false;
  bool object = false, material = false;
  CapturedFields captured;
  bool operator==(const ProgramReads&) const = default;
};

/// Error(bad_input) for fields of lights that nothing fills, and for pairs of fields that share a plane. `file` names
/// the program.
ProgramReads program_reads(const std::string& file, std::span<const std::string> inputs);

/// Error(bad_input) where a program reads what `there` does not have.
void require_fields(const std::string& file, const CapturedFields& reads, const CapturedFields& there = {});

/// The same pipeline with the planes that its light program reads, and nothing of light_model that bounds a light or
/// changes what a program is given.
Pipeline with_planes_of(const Pipeline& pipeline, const ProgramReads& reads);

/// "surface.normal.x" without its component; a scalar's name, "parameters.x", as it is.
std::string without_component(const std::string& name);

/// Error(bad_input) where the inputs have the view's or the projection's matrix alone, and the camera is their product.
void check_camera(const Camera& camera, const std::string& file, std::span<const std::string> inputs);

/// Error(bad_input) where a light has an area and what draws it reads none.
///   by: a light program's file, or a preset; inputs: of the program, none of a preset
void check_lights(std::span<const Light> lights, const std::string& by, std::span<const std::string> inputs);
/// The same of what the pipeline draws them by, unless that is a light program.
void check_lights(std::span<const Light> lights, const Pipeline& pipeline);

/// The value of an input of the block `Parameters`: as given, or as the text says that it usually is; nothing else.
std::optional<float> parameter_value(std::string_view input, const LightProgram& program);

/// The type of a member of the block of parameters, read from its declaration: "ivec2 size", "float weight[3]".
struct ParameterType {
  std::string type, name;
  size_t components = 1;
  bool is_float = true, is_signed = true;
};
ParameterType parameter_type(const std::string& declaration);

/// Whole numbers are kept as floats, which hold each one up to this and round those beyond it.
inline constexpr float kLargestWholeParameter = 16777215.0f;

/// Error(usage) where a parameter is no input, or a value is not one of its type or outside the range that the
/// program's text states. `declared`: what the block of parameters holds, "vec3 tint", each column of a matrix and each
/// element of an array by its own name.
void check_given(const LightProgram& program, std::span<const std::string> inputs,
                 std::span<const std::string> declared);

/// The same, and Error(usage) where an input has no value, as a parameter that is not given.
void check_values(const LightProgram& program, std::span<const std::string> inputs,
                  std::span<const std::string> declared);

}  // namespace trueshade
