#include "scenes/files/obj/obj_meshes.h"

#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "core/error.h"
#include "core/fp_env.h"
#include "scenes/files/obj/geometry_budget.h"
#include "scenes/files/obj/polygons.h"
#include "scenes/trig.h"

namespace trueshade::obj {
namespace {

constexpr uint32_t kNone = UINT32_MAX;
constexpr int kLongestList = 8;          // of the vertices, and of the sums, at a position; others are in a map
constexpr uint64_t kBytesOfEntry = 128;  // of such a map, about

class MeshMaker {
 public:
  MeshMaker(const ObjDocument& document, MissingNormals missing, const SceneLimits& limits)
      : document_(document),
        missing_(missing),
        budget_(limits, document.file),
        first_vertex_(document.position_count(), kNone),
        first_sum_(document.position_count(), kNone) {}

  std::vector<ObjPart> make() {
    const FpScope fp;
    for (size_t run = 0; run < document_.runs.size(); ++run) {
      begin(document_.runs[run]);
      const size_t last =
          run + 1 == document_.runs.size() ? document_.polygon_count() : document_.runs[run + 1].first_polygon;
      for (size_t polygon = document_.runs[run].first_polygon; polygon < last; ++polygon) add_polygon(polygon);
    }
    write_normals();
    return std::move(parts_);
  }

 private:
  /// A vertex of a part, in a list of those at one position. `normal` is a normal of the file, or behind these a sum.
  struct Vertex {
    uint32_t next, part, index;
    int32_t uv;
    uint64_t normal;
  };

  /// Cross products of a smoothing group's triangles about one position, or of one triangle.
  struct NormalSum {
    uint32_t next;
    int32_t group;
    glm::dvec3 sum;
  };

  [[noreturn]] void fail(size_t polygon, const std::string& reason, const std::string& remedy) const {
    throw Error(ErrorKind::limit, document_.file + ": line " + std::to_string(document_.polygon_lines[polygon]), reason,
                remedy);
  }

  void begin(const Run& run) {
    const auto [found, is_new] = part_of_.try_emplace({run.object, run.material}, uint32_t(parts_.size()));
    part_ = found->second;
    group_ = run.smoothing >= 0 ? run.smoothing : missing_ == MissingNormals::smooth ? 1 : 0;
    if (!is_new) return;
    take(sizeof(ObjPart), run.first_polygon);
    parts_.push_back({Mesh(), run.material, run.object});
  }

  void take(uint64_t bytes, size_t polygon) {
    if (!budget_.take(bytes)) fail(polygon, "the geometry is over the limit", budget_.remedy());
  }

  glm::dvec3 position(const Corner& corner) const {
    const float* at = document_.positions.data() + 3 * size_t(corner.position);
    return {at[0], at[1], at[2]};
  }

  void add_polygon(size_t polygon) {
    const size_t first = polygon == 0 ? 0 : document_.polygon_ends[polygon - 1],
                 count = document_.polygon_ends[polygon] - first;
    polygon_ = polygon;
    corners_.clear();
    for (size_t i = 0; i < count; ++i) corners_.push_back(position(document_.corners[first + i]));
    triangles_.clear();
    if (!append_triangles(corners_, triangles_))
      fail(polygon, "a concave face has " + std::to_string(count) + " corners",
           "at most " + std::to_string(kMostConcaveCorners) + ", or triangles");
    take(triangles_.size() * sizeof(uint32_t), polygon);
    for (size_t t = 0; t < triangles_.size(); t += 3) add_triangle(&document_.corners[first], &triangles_[t]);
  }

  void add_triangle(const Corner* corners, const uint32_t* triangle) {
    const glm::dvec3 &a = corners_[triangle[0]], &b = corners_[triangle[1]], &c = corners_[triangle[2]];
    const bool needs_normal = corners[0].normal < 0;
    const glm::dvec3 area_normal = needs_normal ? cross(b - a, c - a) : glm::dvec3(0.0);
    uint32_t flat = kNone;
    for (int k = 0; k < 3; ++k) {
      const Corner& corner = corners[triangle[k]];
      uint64_t normal = uint64_t(corner.normal);
      if (needs_normal) {
        uint32_t sum = group_ > 0 ? sum_at(corner.position) : flat;
        if (sum == kNone) sum = flat = new_sum(kNone);
        if (group_ > 0 || k == 0) sums_[sum].sum += area_normal;
        normal = file_normals() + sum;
      }
      parts_[part_].mesh.indices.push_back(vertex(corner, normal));
    }
  }

  uint64_t file_normals() const { return document_.normals.size() / 3; }

  uint32_t new_sum(uint32_t next) {
    take(sizeof(NormalSum), polygon_);
    sums_.push_back({next, group_, glm::dvec3(0.0)});
    return uint32_t(sums_.size() - 1);
  }

  /// The sum of the smoothing group at a position.
  uint32_t sum_at(int32_t position) {
    uint32_t& first = first_sum_[size_t(position)];
    int listed = 0;
    for (uint32_t sum = first; sum != kNone; sum = sums_[sum].next, ++listed)
      if (sums_[sum].group == group_) return sum;
    if (listed < kLongestList) return first = new_sum(first);
    const auto [found, is_new] = more_sums_.try_emplace({position, group_}, kNone);
    if (!is_new) return found->second;
    take(kBytesOfEntry, polygon_);
    return found->second = new_sum(kNone);
  }

  uint32_t vertex(const Corner& corner, uint64_t normal) {
    uint32_t& first = first_vertex_[size_t(corner.position)];
    int listed = 0;
    for (uint32_t v = first; v != kNone; v = vertices_[v].next, ++listed) {
      const Vertex& known = vertices_[v];
      if (known.normal == normal && known.uv == corner.uv && known.part == part_) return known.index;
    }
    if (listed < kLongestList) {
      const uint32_t index = new_vertex(corner, normal, first);
      first = uint32_t(vertices_.size() - 1);
      return index;
    }
    const auto [found, is_new] = more_vertices_.try_emplace({corner.position, corner.uv, normal, part_}, kNone);
    if (!is_new) return found->second;
    take(kBytesOfEntry, polygon_);
    return found->second = new_vertex(corner, normal, kNone);
  }

  /// Its index in the part.
  uint32_t new_vertex(const Corner& corner, uint64_t normal, uint32_t next) {
    Mesh& mesh = parts_[part_].mesh;
    const uint32_t index = uint32_t(mesh.vertex_count());
    take(sizeof(Vertex) + 12 * sizeof(float), polygon_);
    vertices_.push_back({next, part_, index, corner.uv, normal});
    append(mesh, corner, normal);
    return index;
  }

  void append(Mesh& mesh, const Corner& corner, uint64_t normal) {
    const size_t index = mesh.vertex_count();
    for (size_t k = 0; k < 3; ++k) {
      mesh.position[k].push_back(document_.positions[3 * size_t(corner.position) + k]);
      mesh.normal[k].push_back(normal < file_normals() ? document_.normals[3 * size_t(normal) + k] : 0.0f);
    }
    if (corner.uv >= 0 || mesh.has_uv())
      for (size_t k = 0; k < 2; ++k) {
        mesh.uv[k].resize(index, 0.0f);
        mesh.uv[k].push_back(corner.uv >= 0 ? document_.uvs[2 * size_t(corner.uv) + k] : 0.0f);
      }
    if (!document_.colors.empty())
      for (size_t k = 0; k < 4; ++k) mesh.color[k].push_back(document_.colors[4 * size_t(corner.position) + k]);
  }

  /// Sums are whole once all triangles were added.
  void write_normals() {
    for (const Vertex& v : vertices_) {
      if (v.normal < file_normals()) continue;
      const glm::dvec3 normal = unit_along(sums_[size_t(v.normal - file_normals())].sum);
      for (int k = 0; k < 3; ++k) parts_[v.part].mesh.normal[size_t(k)][v.index] = float(normal[k]);
    }
  }

  /// Squares of small areas vanish in double: the largest component is made 1 first.
  static glm::dvec3 unit_along(const glm::dvec3& v) {
    double largest = 0.0;
    for (int k = 0; k < 3; ++k) largest = std::max(largest, std::fabs(v[k]));
    return largest > 0.0 ? unit({v.x / largest, v.y / largest, v.z / largest}) : v;
  }

  const ObjDocument& document_;
  MissingNormals missing_;
  GeometryBudget budget_;
  std::vector<uint32_t> first_vertex_, first_sum_;  ///< of each position, into the lists below
  std::vector<Vertex> vertices_;
  std::vector<NormalSum> sums_;
  std::map<std::tuple<int32_t, int32_t, uint64_t, uint32_t>, uint32_t> more_vertices_;  ///< indices in their parts
  std::map<std::pair<int32_t, int32_t>, uint32_t> more_sums_;  ///< by position and smoothing group
  std::vector<ObjPart> parts_;
  std::map<std::pair<int32_t, int32_t>, uint32_t> part_of_;  ///< by object and material
  uint32_t part_ = 0;
  int32_t group_ = 0;
  size_t polygon_ = 0;               // that is being added
  std::vector<glm::dvec3> corners_;  // of the polygon at hand
  std::vector<uint32_t> triangles_;
};

}  // namespace

std::vector<ObjPart> parts_of(const ObjDocument& document, MissingNormals missing, const SceneLimits& limits) {
  return MeshMaker(document, missing, limits).make();
}

}  // namespace trueshade::obj
