#pragma once
#include <string>

#include "explain/account.h"
#include "explain/explain.h"

namespace trueshade {

// Parts of a pixel's account that have files of their own.

/// What became of every triangle at the pixel (account_of_triangles.cpp).
Account triangles_account(const ExplainedFrame& frame, const PixelHistory& history, Surfaces which, Detail detail);

/// `object 3 (cube), triangle 5`, the mesh by its name without folders.
std::string name_of(const ExplainedFrame& frame, uint32_t instance, uint32_t triangle);

/// Weights, attributes, maps and planes of a surface (account_of_surface.cpp).
///   planes: the formats that the surface was rounded to
///   of:     which surface it is, for the title
Account surface_account(const ExplainedFrame& frame, uint32_t instance, const PixelSurface& surface,
                        const GBufferState& planes, const std::string& of);

/// The lights on one surface and their sum (account_of_lights.cpp).
///   reach: whether the target receives the sum, or each light by itself; then the sum is left out
///   of:    which surface it is, for the title
enum class LightsReach : uint8_t { as_a_sum, one_by_one };
Account lights_account(const ExplainedFrame& frame, const LightTotal& total, LightsReach reach, const std::string& of,
                       Detail detail);

/// What a light program makes of a surface before its lights, of one of them, and of their sum
/// (account_of_program.cpp).
///   lines: whether every line of the program that contributes is told, with its steps; `usual` detail leaves out steps
///          that only their own line reads where there are many
enum class ProgramLines : uint8_t { left_out, told };
void add_program(const ExplainedFrame& frame, const LightTotal& total, Detail detail, Account& to);
void add_program_light(const ExplainedFrame& frame, const LightTotal& total, size_t light, ProgramLines lines,
                       Detail detail, Account& to);
void add_program_sum(const ExplainedFrame& frame, const LightTotal& total, Detail detail, Account& to);

/// A line of a program's text without its indent; empty for SPIR-V, and where there is none of that number.
std::string source_line(const LightProgram& program, uint32_t line);

/// Adds where the pixel's light first is NaN or infinite, and what the target stores then; adds nothing where all is
/// finite (account_of_nonfinite.cpp).
void add_nonfinite(const ExplainedFrame& frame, const PixelHistory& history, Account& to);

/// GL's name of a depth function.
std::string_view depth_func_name(DepthFunc func);

}  // namespace trueshade
