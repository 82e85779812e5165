#pragma once
#include <span>
#include <string>

#include "scenes/scene.h"

namespace trueshade {

/// Whether the ending of a name is glTF's: .gltf or .glb.
bool is_gltf_name(std::string_view name);

/// Whether meshes with normal maps have tangents: those of the file, or of MikkTSpace.
enum class GltfTangents : uint8_t { left_out, kept };

/// The scene of a .gltf or .glb file at time 0; docs/gltf.md says what of it is read. Buffers and images are read from
/// the folder of `path`. Not validated. Error(bad_input) with JSON pointer, line or byte; Error(limit); Error(io);
/// Error(usage) for parts that the file has not.
Scene scene_from_gltf(std::span<const uint8_t> file, const std::string& path, const SceneLimits& limits,
                      const ImageDecoder& decode = {}, const SceneParts& parts = {},
                      GltfTangents tangents = GltfTangents::kept);

}  // namespace trueshade
