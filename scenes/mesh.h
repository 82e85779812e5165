#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/array.h"

namespace trueshade {

/// One component of an attribute, a number a vertex. It may lie in a cache file (scene_cache/).
using FloatStream = Array<float>;

/// A set of texture coordinates, u and v.
using UvStreams = std::array<FloatStream, 2>;

/// Indexed triangles, a stream per component (SoA). Positions and normals in object space; every stream has
/// vertex_count() elements or, where marked optional, none. Normals are stored as given: unit length is not required.
struct Mesh {
  std::string name;
  std::array<FloatStream, 3> position;
  std::array<FloatStream, 3> normal;
  UvStreams uv;                      ///< optional; 0 where absent
  std::vector<UvStreams> more_uv{};  ///< the sets behind uv, each optional; fewer than kMaxUvSets
  std::array<FloatStream, 4> color;  ///< optional RGBA, linear; 1 where absent
  /// Optional: x, y, z are where the normal map's red points, and its green points along w (normal x tangent), w being
  /// 1 or -1. Without them, both follow the texture coordinates.
  std::array<FloatStream, 4> tangent{};
  Array<uint32_t> indices;  ///< 3 a triangle, in submission order; front faces counter-clockwise
  uint32_t pose = 0;        ///< counts how often set_time() has moved the vertices

  size_t vertex_count() const { return position[0].size(); }
  size_t triangle_count() const { return indices.size() / 3; }
  bool has_uv() const { return !uv[0].empty(); }
  bool has_color() const { return !color[0].empty(); }
  bool has_tangents() const { return !tangent[0].empty(); }

  /// A set of texture coordinates, that TextureSlot::uv_set names; empty where the mesh has none.
  const UvStreams& uv_set(size_t set) const {
    static const UvStreams none;
    return set == 0 ? uv : set <= more_uv.size() ? more_uv[set - 1] : none;
  }
};

}  // namespace trueshade
