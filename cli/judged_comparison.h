#pragma once
#include "cli/compared_pictures.h"

namespace trueshade {

/// Judges a test picture whose size is the reference's. The scene of the reference's metadata is loaded, from where the
/// command runs or from beside the reference; it must have the hash that the reference names. Planes are the test's, if
/// it has any; else they are drawn here, and the picture alone is what is judged.
JudgedPicture judged_by_scene(const ComparedPictures& pictures, const CompareOptions& options);

}  // namespace trueshade
