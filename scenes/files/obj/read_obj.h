#pragma once
#include <span>
#include <string>

#include "scenes/files/content/faults.h"
#include "scenes/files/obj/obj_document.h"
#include "scenes/scene.h"

namespace trueshade::obj {

/// Reads an OBJ file (Wavefront, "Advanced Visualizer Manual", appendix B1). Negative indices count back from the last
/// element above their line; indices from 1 on may name elements below it. Error(bad_input) with `FILE: line N`; all
/// indices are in range afterwards. Where faults are passed over, so is a statement that has one. Error(limit) over
/// limits.geometry_bytes. Opens no file.
ObjDocument read_obj(std::span<const uint8_t> file, const std::string& name, const SceneLimits& limits, Faults& faults);

}  // namespace trueshade::obj
