#pragma once
#include <span>
#include <string_view>

#include "scenes/scene.h"

namespace trueshade {

/// As --faces and the `faces` of a scene file have them.
inline constexpr std::string_view kFaceChoices[] = {"keep", "both"};

/// Whether triangles run counter-clockwise as seen from where their normals point: of some 65,536 of them all but one
/// in 50.
bool is_wound_by_normals(const Mesh& mesh);

/// Makes materials double-sided, but for those of a mesh that is not wound by its normals, or of an instance that
/// mirrors without saying so (Instance::mirrored): there the normals do not tell which face is the front. `is_wound`:
/// of each mesh, where that is known; empty: found out. Returns how many materials stay one-sided so.
size_t light_both_faces(Scene& scene, std::span<const uint8_t> is_wound = {});

}  // namespace trueshade
