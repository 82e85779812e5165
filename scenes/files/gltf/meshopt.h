#pragma once
#include <span>
#include <string>

#include "scenes/files/content/scene_files.h"
#include "scenes/files/gltf/document.h"

namespace trueshade::gltf {

/// What EXT_meshopt_compression packed: count * stride bytes. Error(bad_input) behind `where` for a broken stream.
Bytes unpacked_by_meshopt(const Packing& packing, std::span<const uint8_t> packed, const std::string& where);

}  // namespace trueshade::gltf
