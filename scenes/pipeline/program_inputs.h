#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "scenes/pipeline/pipeline.h"

// What a pipeline makes of the inputs that a light program reads. Their names are those of
// programs/light_interface.glsl, a scalar each: "surface.normal.x", "parameters.gain".
namespace trueshade {

/// What a light program's lights are bounded by where nothing else is said: geometry of lights stays.
void end_at_range(LightVolumes& volumes);

/// Which fields of a surface a light program reads, beside position, normal and albedo.
struct ProgramReads {
  bool gloss = false;     ///< specular, shininess
  bool metals = false;    ///< metallic, roughness
  bool emission = false;  ///< emission, occlusion
  bool uv = false;
  bool object = false, material = false;
  bool operator==(const ProgramReads&) const = default;
};

/// Error(bad_input) for fields that nothing fills, and for pairs of fields that share a plane. `file` names the
/// program.
ProgramReads program_reads(const std::string& file, std::span<const std::string> inputs);

/// The same pipeline with the planes that its light program reads, and nothing of light_model that bounds a light or
/// changes what a program is given.
Pipeline with_planes_of(const Pipeline& pipeline, const ProgramReads& reads);

/// The value of an input of the block `Parameters`; nothing where none is given.
std::optional<float> parameter_value(std::string_view input, const LightProgram& program);

/// Error(usage) where an input has no value, as a parameter that is not given, or a parameter is no input.
void check_values(const LightProgram& program, std::span<const std::string> inputs);

}  // namespace trueshade
