#pragma once
#include <string>

#include "explain/account.h"
#include "explain/explain.h"

namespace trueshade {

// Parts of a pixel's account that have files of their own.

/// What became of the triangles at the pixel (account_of_triangles.cpp): how many had each fate, then a part for each
/// that covers the sample, and for some that are culled or lie beside it. What `detail` leaves out is counted.
Account triangles_account(const ExplainedFrame& frame, const PixelHistory& history, Surfaces which, Detail detail);

/// `object 3 (cube), triangle 5`, the mesh by its name without folders.
std::string name_of(const ExplainedFrame& frame, uint32_t instance, uint32_t triangle);

/// Weights, attributes, maps and planes of a surface (account_of_surface.cpp).
///   planes: the formats that the surface was rounded to
///   of:     which surface it is, for the title
Account surface_account(const ExplainedFrame& frame, uint32_t instance, const PixelSurface& surface,
                        const GBufferState& planes, const std::string& of);

/// How the target receives lights.
enum class LightsReach : uint8_t { as_a_sum, one_by_one };

/// The lights on one surface and their sum (account_of_lights.cpp). Of an unlit surface only its albedo.
///   reach: whether the target receives the sum, or each light by itself; then the sum is left out
///   of:    which surface it is, for the title
Account lights_account(const ExplainedFrame& frame, const LightTotal& total, LightsReach reach, const std::string& of,
                       Detail detail);

/// Whether a program's lines are told.
enum class ProgramLines : uint8_t { left_out, told };

// What a light program makes of a surface (account_of_program.cpp), appended to an account. A line of the program is
// told with its steps; `usual` detail leaves out steps that only their own line reads where there are many.

/// Adds the program's name, what the sum of the lights starts from, and the lines of start() where the program has one.
void add_program(const ExplainedFrame& frame, const LightTotal& total, Detail detail, Account& to);
/// Adds the numbers of one light and what the program makes of it: its term, whether reaches() counts it where the
/// program has one, and the lines of light(). Of a light that is out of reach it adds no term, but where its reach
/// ends.
void add_program_light(const ExplainedFrame& frame, const LightTotal& total, size_t light, ProgramLines lines,
                       Detail detail, Account& to);
/// Adds the sum of the lights and the lines of finish(); adds nothing where the program has no finish().
void add_program_sum(const ExplainedFrame& frame, const LightTotal& total, Detail detail, Account& to);

/// A line of a program's text without its indent; empty for SPIR-V, and where there is none of that number.
std::string source_line(const LightProgram& program, uint32_t line);

/// Adds where the pixel's light first is NaN or infinite, and what the target stores then (account_of_nonfinite.cpp).
/// Adds nothing where all is finite; a light whose own numbers are infinite counts as finite.
void add_nonfinite(const ExplainedFrame& frame, const PixelHistory& history, Account& to);

/// GL's name of a depth function, without `GL_`.
std::string_view depth_func_name(DepthFunc func);

}  // namespace trueshade
