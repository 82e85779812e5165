#pragma once
#include <string>

#include "explain/account.h"
#include "explain/explain.h"

namespace trueshade {

// The parts of a pixel's account, in the files that are named here.

/// What became of the triangles at the pixel (account_of_triangles.cpp): how many had each Fate, then a part for each
/// that covers the sample, and for some that are culled or lie beside the sample. The triangles that `detail` leaves
/// out are only counted.
///   which: the opaque or the transparent surfaces
Account triangles_account(const ExplainedFrame& frame, const PixelHistory& history, Surfaces which, Detail detail);

/// The name of a triangle, `object 3 (cube), triangle 5`; the mesh is named without its folders.
std::string name_of(const ExplainedFrame& frame, uint32_t instance, uint32_t triangle);

/// What makes up a surface: its weights, attributes, texture lookups and planes (account_of_surface.cpp).
///   planes: the formats that the surface was rounded to
///   of:     which surface it is, for the title
Account surface_account(const ExplainedFrame& frame, uint32_t instance, const PixelSurface& surface,
                        const GBufferState& planes, const std::string& of);

/// How the target receives the lights: their sum at once, or each light's draw.
enum class LightsReach : uint8_t { as_a_sum, one_by_one };

/// What each light gives one surface, and the sum (account_of_lights.cpp). For an unlit surface only its albedo.
///   reach: as_a_sum: the target receives the sum; one_by_one: each light by itself, and the sum is left out
///   of:    which surface it is, for the title
Account lights_account(const ExplainedFrame& frame, const LightTotal& total, LightsReach reach, const std::string& of,
                       Detail detail);

/// Whether an account has the lines of a light program.
enum class ProgramLines : uint8_t { left_out, told };

// What a light program computes for a surface, appended to an account (account_of_program.cpp). Each line of the
// program stands with its steps. Detail::usual leaves out steps that only their own line reads, where there are many.

/// Appends the program's name, what the sum of the lights starts from, and the lines of start(), if it has one.
void add_program(const ExplainedFrame& frame, const LightTotal& total, Detail detail, Account& to);
/// Appends the numbers of one light, by its index in the scene, and what the program makes of it: its term, the result
/// of reaches() where the program has one, and the lines of light(). For a light that does not reach the surface,
/// appends where its reach ends, and no term.
void add_program_light(const ExplainedFrame& frame, const LightTotal& total, size_t light, ProgramLines lines,
                       Detail detail, Account& to);
/// Appends the sum of the lights and the lines of finish(); nothing where the program has no finish().
void add_program_sum(const ExplainedFrame& frame, const LightTotal& total, Detail detail, Account& to);

/// A line of a program's text without its indent, counted from 1; empty for SPIR-V, and for a line that is not there.
std::string source_line(const LightProgram& program, uint32_t line);

/// Appends where the light of the pixel first becomes NaN or infinite, and what the target stores then
/// (account_of_nonfinite.cpp). Appends nothing where all is finite; a light whose own numbers are infinite counts as
/// finite.
void add_nonfinite(const ExplainedFrame& frame, const PixelHistory& history, Account& to);

/// The name that GL has for a depth function, without `GL_`: `LESS`.
std::string_view depth_func_name(DepthFunc func);

}  // namespace trueshade
