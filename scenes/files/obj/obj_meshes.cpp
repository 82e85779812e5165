#include "scenes/files/obj/obj_meshes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "core/error.h"
#include "core/fp_env.h"
#include "scenes/files/obj/creases.h"
#include "scenes/files/obj/geometry_budget.h"
#include "scenes/files/obj/polygons.h"
#include "scenes/trig.h"

namespace trueshade::obj {
namespace {

constexpr uint32_t kNone = UINT32_MAX;
constexpr int kLongestList = 8;          // of the vertices, and of the sums, at a position; others are in a map
constexpr uint64_t kBytesOfEntry = 128;  // of such a map, about

/// Whether creases are looked for: the file says nothing about normals.
bool is_creased(const ObjDocument& document, MissingNormals missing) {
  const auto has_group = [](const Run& run) { return run.smoothing >= 0; };
  return missing == MissingNormals::creased && document.normals.empty() &&
         std::none_of(document.runs.begin(), document.runs.end(), has_group);
}

class MeshMaker {
 public:
  MeshMaker(const ObjDocument& document, MissingNormals missing, const SceneLimits& limits)
      : document_(document),
        missing_(missing),
        creased_(is_creased(document, missing)),
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
    if (!kept_.empty()) add_kept_triangles();
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

  /// Cross products of a smoothing group's triangles about one position, of some of these, or of one triangle.
  struct NormalSum {
    uint32_t next;
    int32_t group;
    glm::dvec3 sum;
  };

  /// A triangle that waits until all triangles around its corners are known.
  struct KeptTriangle {
    uint32_t corners[3];  ///< of the document
    uint32_t part, polygon;
  };

  [[noreturn]] void fail(size_t polygon, const std::string& reason, const std::string& remedy) const {
    throw Error(ErrorKind::limit, document_.file + ": line " + std::to_string(document_.polygon_lines[polygon]), reason,
                remedy);
  }

  void begin(const Run& run) {
    const auto [found, is_new] = part_of_.try_emplace({run.object, run.material}, uint32_t(parts_.size()));
    part_ = found->second;
    group_ = run.smoothing >= 0 ? run.smoothing : missing_ == MissingNormals::flat ? 0 : 1;
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
    for (size_t t = 0; t < triangles_.size(); t += 3)
      if (creased_)
        keep_triangle(first, &triangles_[t]);
      else
        add_triangle(&document_.corners[first], &triangles_[t]);
  }

  void keep_triangle(size_t first_corner, const uint32_t* triangle) {
    take(sizeof(KeptTriangle), polygon_);
    KeptTriangle kept{{}, part_, uint32_t(polygon_)};
    for (int k = 0; k < 3; ++k) kept.corners[k] = uint32_t(first_corner + triangle[k]);
    kept_.push_back(kept);
  }

  void add_kept_triangles() {
    const std::vector<uint32_t> sums = creased_sums();
    for (size_t t = 0; t < kept_.size(); ++t) {
      part_ = kept_[t].part;
      polygon_ = kept_[t].polygon;
      for (size_t k = 0; k < 3; ++k)
        parts_[part_].mesh.indices.push_back(vertex(kept_corner(3 * t + k), file_normals() + sums[3 * t + k]));
    }
  }

  /// Corners of the kept triangles, three a triangle, by their positions: those at p are corners[begin[p]] to
  /// corners[begin[p + 1] - 1], in the file's order.
  struct ByPosition {
    std::vector<uint32_t> begin, corners;
  };

  const Corner& kept_corner(size_t corner) const { return document_.corners[kept_[corner / 3].corners[corner % 3]]; }

  ByPosition corners_by_position() {
    const size_t positions = document_.position_count(), count = 3 * kept_.size();
    take((positions + 1 + count) * sizeof(uint32_t), polygon_);
    ByPosition out{std::vector<uint32_t>(positions + 1, 0), std::vector<uint32_t>(count)};
    // begin[p + 1] is the number of corners at p, then where they begin, and once they are written where they end.
    for (size_t corner = 0; corner < count; ++corner) ++out.begin[size_t(kept_corner(corner).position) + 1];
    uint32_t before = 0;
    for (size_t p = 0; p < positions; ++p) before += std::exchange(out.begin[p + 1], before);
    for (size_t corner = 0; corner < count; ++corner)
      out.corners[out.begin[size_t(kept_corner(corner).position) + 1]++] = uint32_t(corner);
    return out;
  }

  /// Index of the sum of each corner of the kept triangles, three a triangle.
  std::vector<uint32_t> creased_sums() {
    const ByPosition by_position = corners_by_position();
    uint32_t most = 0;  // corners at a position
    for (size_t p = 0; p < document_.position_count(); ++p)
      most = std::max(most, by_position.begin[p + 1] - by_position.begin[p]);
    take((3 * kept_.size() + most) * sizeof(uint32_t) + most * sizeof(glm::dvec3), polygon_);
    std::vector<uint32_t> sums(3 * kept_.size());
    CreasedVertex creased;
    std::vector<glm::dvec3> area_normals;
    area_normals.reserve(most);
    for (size_t p = 0; p < document_.position_count(); ++p) {
      const uint32_t *corner = by_position.corners.data() + by_position.begin[p],
                     *end = by_position.corners.data() + by_position.begin[p + 1];
      area_normals.clear();
      for (const uint32_t* c = corner; c != end; ++c) area_normals.push_back(area_normal_of(kept_[*c / 3]));
      creased.set(area_normals);
      const uint32_t first = uint32_t(sums_.size());
      for (const glm::dvec3& sum : creased.sums()) sums_[new_sum(kNone)].sum = sum;
      for (const uint32_t sum : creased.sum_of_triangle()) sums[*corner++] = first + sum;
    }
    return sums;
  }

  glm::dvec3 area_normal_of(const KeptTriangle& triangle) const {
    const glm::dvec3 a = position(document_.corners[triangle.corners[0]]);
    return cross(position(document_.corners[triangle.corners[1]]) - a,
                 position(document_.corners[triangle.corners[2]]) - a);
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
  bool creased_;
  GeometryBudget budget_;
  std::vector<uint32_t> first_vertex_, first_sum_;  ///< of each position, into the lists below
  std::vector<Vertex> vertices_;
  std::vector<NormalSum> sums_;
  std::map<std::tuple<int32_t, int32_t, uint64_t, uint32_t>, uint32_t> more_vertices_;  ///< indices in their parts
  std::map<std::pair<int32_t, int32_t>, uint32_t> more_sums_;  ///< by position and smoothing group
  std::vector<KeptTriangle> kept_;                             ///< where creases are looked for, in the file's order
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
