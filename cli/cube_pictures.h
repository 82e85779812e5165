#pragma once
#include <string>

#include "scenes/cube_map.h"
#include "shading/frame.h"

namespace trueshade {

/// The name of one face's file: `out/sky.png` is `out/sky.px.png`.
std::string face_name(const std::string& path, CubeFace face);

/// Puts the rows of every picture of a frame in reverse order: what cube_face_camera() drew becomes the face, its texel
/// (0, 0) the first of the file.
void reverse_rows(Frame& frame);

/// Puts a face into the picture of all six, which has 4 x 3 faces; each continues its neighbours:
///        py
///    nx  pz  px  nz
///        ny
/// The first face makes the picture. Texels of no face have all bytes zero. Planes go as the color does.
void put_into_cross(const Frame& face, CubeFace which, Frame& cross);

}  // namespace trueshade
