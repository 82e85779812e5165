#pragma once
#include <cstdint>
#include <span>
#include <string_view>

#include "scenes/add_normals.h"
#include "scenes/files/content/faults.h"
#include "scenes/mesh.h"

namespace trueshade {

/// Reads a PLY file (Greg Turk, "The PLY Polygon File Format", 1994): ascii, binary_little_endian, binary_big_endian.
/// Element vertex: x y z, and where present nx ny nz, red green blue [alpha] (integers as value / maximum, floats as
/// they are; taken as linear), u v (or s t, texture_u texture_v). Element face: the list vertex_indices or
/// vertex_index; polygons become fans around their first vertex. Other elements and properties are skipped.
/// Error(bad_input): `WHERE: line N` in text, `WHERE: byte N` in binary data. Faults that may be passed over: lines of
/// the header of no keyword; normals, coordinates or colours of which only some are there, or of another type; faces of
/// fewer than 3 corners.
Mesh mesh_from_ply(std::span<const uint8_t> file, std::string_view where, MissingNormals missing_normals,
                   Faults& faults);

}  // namespace trueshade
