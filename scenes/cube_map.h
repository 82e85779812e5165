#pragma once
#include <cstdint>
#include <glm/vec3.hpp>
#include <string_view>

#include "scenes/camera.h"

// Cube maps (OpenGL 4.6, section 8.13): what is seen from one place, as six square faces. A texture made of the faces
// gives for a direction in the world the colour that lies there.
namespace trueshade {

/// The faces in OpenGL's order.
enum class CubeFace : uint8_t { positive_x, negative_x, positive_y, negative_y, positive_z, negative_z };

/// As they stand in the names of files.
inline constexpr std::string_view kCubeFaceNames[] = {"px", "nx", "py", "ny", "pz", "nz"};

/// The camera that draws a face, for pictures of equal sides: at `eye` (world), with 90 degrees of view exactly, near
/// and far those of `camera`. As in OpenGL, the face's texel (0, 0) is the lower left pixel that this camera draws: the
/// rows of the picture, from the top down, are the face's rows from the last to the first.
Camera cube_face_camera(const Camera& camera, glm::vec3 eye, CubeFace face);

}  // namespace trueshade
