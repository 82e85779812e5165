#pragma once
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace trueshade::obj {

/// Corners of a concave polygon at most: cutting off ears takes time with their square.
inline constexpr size_t kMostConcaveCorners = 4096;

/// Appends the triangles of a polygon, 3 numbers of corners each, oriented as the polygon is. The polygon is seen along
/// the largest component of its normal (Martin Newell's: the sum of the cross products around it), x, y or z in this
/// order where two are equal. Where it turns one way only there, or has no area, it is a fan from its first corner.
/// Otherwise ears are cut off: the first corner in order whose triangle turns the right way and holds no other corner,
/// again and again; what is left where there is no ear is a fan. Returns false, and appends nothing, for a concave
/// polygon of more than kMostConcaveCorners.
bool append_triangles(std::span<const glm::dvec3> corners, std::vector<uint32_t>& triangles);

}  // namespace trueshade::obj
