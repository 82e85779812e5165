#pragma once
#include <span>
#include <string>

#include "scenes/files/content/faults.h"
#include "scenes/files/obj/mtl_document.h"

namespace trueshade::obj {

/// Reads an MTL file (Wavefront's, and the statements Pr Pm map_Pr map_Pm norm that Exocortex's PBR extension adds);
/// keywords in small letters or capitals. Error(bad_input) with `FILE: line N`, unless faults are passed over: then the
/// statement is. Opens no file.
MtlDocument read_mtl(std::span<const uint8_t> file, const std::string& name, Faults& faults);

}  // namespace trueshade::obj
