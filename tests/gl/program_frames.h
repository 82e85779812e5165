#pragma once
#include <functional>

#include "oracle/capture.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

// Frames that light programs light, drawn by a driver and by us.
namespace trueshade::testing {

using ProgramDrawer = std::function<oracle::Capture(const Scene&, const Pipeline&)>;

/// A driver that draws the preset many-lights, written as a program, as our program does: in rgba8, within one code
/// where both show the same object, but for one pixel of 2000.
void check_many_lights(const ProgramDrawer& drawn);

/// The same of programs that have parameters, start, finish and reaches, variables of the file, and surfaces of every
/// kind, in rgba32f: within 1/2000 of 1 and of the value, but for one pixel of 2000.
void check_program_kinds(const ProgramDrawer& drawn);

/// The models that light by lights with an area, under these and others: within 1/500 of 1 and of the value, but for
/// one pixel of 2000.
void check_area_lights(const ProgramDrawer& drawn);

/// Every field of Surface, Light and View that is filled, shown by a program: within 1/10000 of 1 and of the value
/// where both show the same object, but for one pixel of 2000.
void check_program_fields(const ProgramDrawer& drawn);

/// The GGX of docs/light_programs.md.
std::string documented_ggx();

}  // namespace trueshade::testing
