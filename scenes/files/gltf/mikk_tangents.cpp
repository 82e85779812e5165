#include "scenes/files/gltf/mikk_tangents.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/vec3.hpp>
#include <limits>
#include <map>
#include <numeric>
#include <tuple>

#include "core/fp_env.h"
#include "scenes/trig.h"

namespace trueshade::gltf {
namespace {

constexpr uint32_t kAbsent = UINT32_MAX;
constexpr std::array<float, 4> kNothing{1.0f, 0.0f, 0.0f, 1.0f};      // of corners for which there is nothing
constexpr double kLeast = double(std::numeric_limits<float>::min());  // lengths up to it count as 0

glm::dvec3 at(const std::array<FloatStream, 3>& streams, uint32_t vertex) {
  return {double(streams[0][vertex]), double(streams[1][vertex]), double(streams[2][vertex])};
}

bool not_zero(const glm::dvec3& v) {
  return std::fabs(v.x) > kLeast || std::fabs(v.y) > kLeast || std::fabs(v.z) > kLeast;
}

/// v without its part along n, and of unit length unless that is 0.
glm::dvec3 across(const glm::dvec3& v, const glm::dvec3& n) {
  const glm::dvec3 out = v - n * dot(n, v);
  return not_zero(out) ? unit(out) : out;
}

/// Between two unit vectors, from 0 to pi.
double angle_between(const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 c = cross(a, b);
  const double sine = std::sqrt(dot(c, c)), cosine = dot(a, b);
  if (sine == 0.0 && cosine == 0.0) return 0.5 * kPi;  // one of them is 0
  return cosine < 0.0 ? kPi - angle_of(sine, -cosine) : angle_of(sine, cosine);
}

/// What the texture coordinates of a triangle say.
struct FaceTangent {
  glm::dvec3 u{0.0};        ///< of unit length, or 0
  bool preserves = false;   ///< uv winds as the triangle does
  bool joins_any = true;    ///< uv has no area
  bool degenerate = false;  ///< two corners are at one place
};

class TangentMaker {
 public:
  TangentMaker(const UvStreams& uv, const Mesh& mesh)
      : mesh_(mesh), uv_(uv), corners_(mesh.indices.size()), group_of_(mesh.indices.size(), kAbsent) {
    weld();
    for (size_t t = 0; t < mesh.triangle_count(); ++t) faces_.push_back(face_tangent(t));
    find_neighbours();
    for (uint32_t corner = 0; corner < corners_.size(); ++corner)
      if (const FaceTangent& face = faces_[corner / 3];
          group_of_[corner] == kAbsent && !face.degenerate && !face.joins_any)
        add_group(corner);
    borrow_groups();
  }

  /// x, y, z, w of each corner.
  std::vector<std::array<float, 4>> tangents() const {
    std::vector<std::array<float, 4>> out;
    out.reserve(corners_.size());
    for (const uint32_t group : group_of_) out.push_back(group == kAbsent ? kNothing : made_[group]);
    return out;
  }

 private:
  /// Numbers corners by what they are equal in: each by the first vertex that has it.
  void weld() {
    const auto values = [this](uint32_t v) {
      return std::tuple(mesh_.position[0][v], mesh_.position[1][v], mesh_.position[2][v], mesh_.normal[0][v],
                        mesh_.normal[1][v], mesh_.normal[2][v], uv_[0][v], uv_[1][v]);
    };
    std::vector<uint32_t> order(mesh_.vertex_count()), first(mesh_.vertex_count());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
      const auto of_a = values(a), of_b = values(b);
      return of_a < of_b || (of_a == of_b && a < b);
    });
    for (size_t i = 0; i < order.size(); ++i)
      first[order[i]] = i > 0 && values(order[i - 1]) == values(order[i]) ? first[order[i - 1]] : order[i];
    for (size_t corner = 0; corner < corners_.size(); ++corner) corners_[corner] = first[mesh_.indices[corner]];
  }

  FaceTangent face_tangent(size_t triangle) const {
    const uint32_t* const v = corners_.data() + 3 * triangle;
    const glm::dvec3 p[3] = {at(mesh_.position, v[0]), at(mesh_.position, v[1]), at(mesh_.position, v[2])};
    FaceTangent face;
    face.degenerate = p[0] == p[1] || p[0] == p[2] || p[1] == p[2];
    const glm::dvec3 e1 = p[1] - p[0], e2 = p[2] - p[0];
    const auto change = [&](size_t k, size_t corner) { return double(uv_[k][v[corner]]) - double(uv_[k][v[0]]); };
    const double a1 = change(0, 1), b1 = change(1, 1), a2 = change(0, 2), b2 = change(1, 2), area = a1 * b2 - a2 * b1;
    const glm::dvec3 u = e1 * b2 - e2 * b1, w = e2 * a1 - e1 * a2;
    face.preserves = area > 0.0;
    if (!(std::fabs(area) > kLeast)) return face;
    const double length_u = std::sqrt(dot(u, u)), length_w = std::sqrt(dot(w, w));
    if (length_u > kLeast) face.u = unit(area > 0.0 ? u : -u);
    face.joins_any = !(length_u / std::fabs(area) > kLeast && length_w / std::fabs(area) > kLeast);
    return face;
  }

  /// The triangle behind each edge, of which edge k goes from corner k to the next: the first one, in the order of
  /// triangles, that has the edge the other way round and has no neighbour there.
  void find_neighbours() {
    struct Edge {
      uint32_t low, high, edge;
      bool operator<(const Edge& other) const {
        return std::tie(low, high, edge) < std::tie(other.low, other.high, other.edge);
      }
    };
    std::vector<Edge> edges;
    for (uint32_t edge = 0; edge < corners_.size(); ++edge) {
      if (faces_[edge / 3].degenerate) continue;
      const auto [low, high] = std::minmax(corners_[edge], corners_[next_corner(edge)]);
      edges.push_back({low, high, edge});
    }
    std::sort(edges.begin(), edges.end());
    neighbour_.assign(corners_.size(), kAbsent);
    std::vector<uint32_t> open[2];  // that go up and that go down, the next to be taken last
    for (size_t first = 0, end = 0; first < edges.size(); first = end) {
      open[0].clear(), open[1].clear();
      end = first;
      while (end < edges.size() && edges[end].low == edges[first].low && edges[end].high == edges[first].high) ++end;
      for (size_t i = end; i-- > first;) open[is_up(edges[i].edge) ? 0 : 1].push_back(edges[i].edge);
      for (; !open[0].empty() && !open[1].empty(); open[0].pop_back(), open[1].pop_back()) {
        const uint32_t a = open[0].back(), b = open[1].back();
        neighbour_[a] = b / 3, neighbour_[b] = a / 3;
      }
    }
  }

  static uint32_t next_corner(uint32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }
  static uint32_t corner_before(uint32_t corner) { return corner % 3 == 0 ? corner + 2 : corner - 1; }
  bool is_up(uint32_t edge) const { return corners_[edge] < corners_[next_corner(edge)]; }

  /// The corner of a triangle at a vertex that it has.
  uint32_t corner_at(uint32_t triangle, uint32_t vertex) const {
    uint32_t corner = 3 * triangle;
    while (corners_[corner] != vertex) ++corner;
    return corner;
  }

  /// Makes the group of a corner that has none.
  void add_group(uint32_t start) {
    const uint32_t vertex = corners_[start];
    const auto group = uint32_t(made_.size());
    const bool preserves = faces_[start / 3].preserves;
    std::vector<uint32_t> members, open{start};
    while (!open.empty()) {
      const uint32_t corner = open.back();
      open.pop_back();
      if (group_of_[corner] != kAbsent || !takes(corner / 3, preserves)) continue;
      group_of_[corner] = group;
      members.push_back(corner);
      for (const uint32_t edge : {corner_before(corner), corner})  // the triangle behind the corner's own edge is next
        if (neighbour_[edge] != kAbsent) open.push_back(corner_at(neighbour_[edge], vertex));
    }
    std::sort(members.begin(), members.end());
    made_.push_back(tangent_of(members, preserves));
  }

  /// Whether a triangle winds as a group does. One without area in uv winds as the first group that meets it.
  bool takes(uint32_t triangle, bool preserves) {
    FaceTangent& face = faces_[triangle];
    const uint32_t* const groups = group_of_.data() + 3 * size_t(triangle);
    if (face.joins_any && groups[0] == kAbsent && groups[1] == kAbsent && groups[2] == kAbsent)
      face.preserves = preserves;
    return face.preserves == preserves;
  }

  std::array<float, 4> tangent_of(const std::vector<uint32_t>& members, bool preserves) const {
    const glm::dvec3 n = unit(at(mesh_.normal, corners_[members[0]]));
    glm::dvec3 sum(0.0);
    for (const uint32_t corner : members) {
      if (faces_[corner / 3].joins_any) continue;
      const glm::dvec3 here = at(mesh_.position, corners_[corner]);
      const glm::dvec3 before = at(mesh_.position, corners_[corner_before(corner)]) - here;
      const glm::dvec3 after = at(mesh_.position, corners_[next_corner(corner)]) - here;
      sum = sum + across(faces_[corner / 3].u, n) * angle_between(across(before, n), across(after, n));
    }
    if (not_zero(sum)) sum = unit(sum);
    return {float(sum.x), float(sum.y), float(sum.z), preserves ? -1.0f : 1.0f};
  }

  /// Corners of degenerate triangles take the group that the first other triangle has at the vertex.
  void borrow_groups() {
    std::vector<uint32_t> at_vertex(mesh_.vertex_count(), kAbsent);
    for (size_t corner = corners_.size(); corner-- > 0;)
      if (!faces_[corner / 3].degenerate) at_vertex[corners_[corner]] = group_of_[corner];
    for (size_t corner = 0; corner < corners_.size(); ++corner)
      if (faces_[corner / 3].degenerate) group_of_[corner] = at_vertex[corners_[corner]];
  }

  const Mesh& mesh_;
  const UvStreams& uv_;
  std::vector<uint32_t> corners_;  ///< the vertex that each corner counts as
  std::vector<FaceTangent> faces_;
  std::vector<uint32_t> neighbour_;         ///< a triangle, by edge
  std::vector<uint32_t> group_of_;          ///< by corner
  std::vector<std::array<float, 4>> made_;  ///< by group
};

/// The values of the vertices that vertices were.
template <class Streams>
void part_streams(Streams& streams, const std::vector<uint32_t>& from) {
  for (FloatStream& stream : streams) {
    if (stream.empty()) continue;
    std::vector<float> out;
    out.reserve(from.size());
    for (const uint32_t v : from) out.push_back(stream[v]);
    stream = std::move(out);
  }
}

}  // namespace

std::vector<uint32_t> add_mikk_tangents(const UvStreams& uv, Mesh& mesh) {
  const FpScope fp;
  const std::vector<std::array<float, 4>> of_corner = TangentMaker(uv, mesh).tangents();
  const size_t before = mesh.vertex_count();
  std::vector<uint32_t> from(before);
  std::iota(from.begin(), from.end(), 0u);
  std::map<std::pair<uint32_t, std::array<float, 4>>, uint32_t> parted;  // by the vertex that it was and its tangent
  std::vector<std::array<float, 4>> of_vertex(before);                   // w is 0 until there is one
  for (size_t corner = 0; corner < mesh.indices.size(); ++corner) {
    const std::array<float, 4>& wanted = of_corner[corner];
    const uint32_t v = mesh.indices[corner];
    if (of_vertex[v][3] == 0.0f) of_vertex[v] = wanted;
    if (of_vertex[v] == wanted) continue;
    const auto [found, is_new] = parted.try_emplace({v, wanted}, uint32_t(from.size()));
    if (is_new) from.push_back(v), of_vertex.push_back(wanted);
    mesh.indices[corner] = found->second;
  }
  part_streams(mesh.position, from), part_streams(mesh.normal, from), part_streams(mesh.color, from);
  part_streams(mesh.uv, from);
  for (UvStreams& set : mesh.more_uv) part_streams(set, from);
  for (size_t k = 0; k < 4; ++k) {
    std::vector<float> stream;
    stream.reserve(from.size());
    for (const std::array<float, 4>& value : of_vertex) stream.push_back(value[3] != 0.0f ? value[k] : kNothing[k]);
    mesh.tangent[k] = std::move(stream);
  }
  return from;
}

}  // namespace trueshade::gltf
