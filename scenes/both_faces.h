#pragma once
#include <string_view>

#include "scenes/scene.h"

namespace trueshade {

/// As --faces and the `faces` of a scene file have them.
inline constexpr std::string_view kFaceChoices[] = {"keep", "both"};

/// Makes materials double-sided, but for those of a mesh whose triangles do not run counter-clockwise about their
/// normals, one in 50 aside: its normals do not tell which face is the front.
void light_both_faces(Scene& scene);

}  // namespace trueshade
