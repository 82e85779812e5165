#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "gl/emit/glsl.h"
#include "programs/front/light_outline.h"
#include "scenes/pipeline/program_inputs.h"

// Light passes as GLSL: what is ours, then the text of a light program as it is (docs/light_programs.md), then functions
// of ours that call it. Light models are light programs that we write (scenes/light_models).
namespace trueshade::oracle {

/// What the shaders of a pipeline must know of its light program.
struct LightText {
  programs::LightOutline outline;
  ProgramReads reads;
};

/// Compiled once a process for each text; null where the pipeline has no light program. Error where the program, its
/// parameters or the strategy are such that no shader can be made.
std::shared_ptr<const LightText> light_text_of(const Pipeline& pipeline);

/// What the program reads of surfaces; the material too where unlit ones show their albedo. Nothing without a program.
ProgramReads surface_reads(const Pipeline& pipeline, const GlslOptions& options);

/// The bytes of the program's block of parameters, by std140; empty where it has none.
std::vector<uint8_t> parameter_bytes(const Pipeline& pipeline);

/// The uniform with the number of a draw's light, -1 where there is none.
inline constexpr const char* kDrawnLight = "drawn_light";

/// A draw of a light pass.
struct LightDraw {
  enum class Kind : uint8_t {
    sum,    ///< of all lights from `first` to `end`
    pass,   ///< one light over the scene; the first with what the sum starts from
    base,   ///< what the sum starts from
    light,  ///< one light alone
  } kind;
  std::string what;                              ///< the draw in words
  std::string declared = {};                     ///< variables that `before`, `first`, `end` or `light` read
  std::string before = {};                       ///< statements
  std::string first = "0", end = "light_count";  ///< of the buffer `lights`
  std::string light = kDrawnLight;               ///< of the buffer
};

std::string light_fragment_text(const Pipeline& pipeline, const GlslOptions& options, const LightDraw& draw);

/// What stands before the user's text in such a shader, or the whole of another.
std::string_view own_text(std::string_view shader);

/// Which texels a light has in the buffer `lights` (light_record.h), one behind the other: the first two, and those of
/// which the light program reads something.
std::vector<size_t> light_texels(const Pipeline& pipeline);

/// Where Vulkan binds the block of parameters, in set 0.
inline constexpr int kParameterBinding = 7;

}  // namespace trueshade::oracle
