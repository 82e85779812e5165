#include <algorithm>
#include <array>
#include <tuple>
#include <vector>

#include "scenes/shapes.h"
#include "scenes/builtin/surface_net.h"
#include "scenes/trig.h"

namespace trueshade {
namespace {

constexpr size_t kPatchVertices = 64, kPatchTriangles = 126;  // a cluster of the rasterizer

glm::dvec3 vec(const std::array<FloatStream, 3>& streams, uint32_t vertex) {
  return {streams[0][vertex], streams[1][vertex], streams[2][vertex]};
}

/// Grows patches over a mesh, each from a triangle beside the last.
class PatchGrower {
 public:
  explicit PatchGrower(const Mesh& mesh)
      : mesh_(mesh),
        used_(mesh.triangle_count()),
        in_patch_(mesh.vertex_count(), 0),
        listed_(mesh.triangle_count(), 0) {
    first_.assign(mesh.vertex_count() + 1, 0);
    for (const uint32_t v : mesh.indices) ++first_[v + 1];
    for (size_t v = 0; v < mesh.vertex_count(); ++v) first_[v + 1] += first_[v];
    std::vector<uint32_t> next(first_.begin(), first_.end() - 1);
    around_.resize(mesh.indices.size());
    for (size_t i = 0; i < mesh.indices.size(); ++i) around_[next[mesh.indices[i]]++] = uint32_t(i / 3);
    for (uint32_t t = 0; t < mesh.triangle_count(); ++t)
      centre_.push_back((vec(mesh.position, corner(t, 0)) + vec(mesh.position, corner(t, 1))) +
                        vec(mesh.position, corner(t, 2)));
  }

  std::vector<uint32_t> order() {
    for (uint32_t seed = 0; seed < used_.size(); ++seed)
      for (uint32_t start = seed; !used_[start];) start = grow(start);
    return std::move(order_);
  }

 private:
  uint32_t corner(uint32_t triangle, size_t k) const { return mesh_.indices[3 * triangle + k]; }

  size_t new_vertices(uint32_t triangle) const {
    size_t count = 0;
    for (size_t k = 0; k < 3; ++k) count += in_patch_[corner(triangle, k)] != patch_;
    return count;
  }

  void take(uint32_t triangle) {
    used_[triangle] = true;
    order_.push_back(triangle);
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t v = corner(triangle, k);
      if (in_patch_[v] == patch_) continue;
      in_patch_[v] = patch_;
      ++vertices_;
      for (uint32_t i = first_[v]; i < first_[v + 1]; ++i) {
        const uint32_t beside = around_[i];
        if (used_[beside] || listed_[beside] == patch_) continue;
        listed_[beside] = patch_;
        candidates_.push_back(beside);
      }
    }
  }

  /// Takes triangles that add fewest vertices, nearest the start first. Returns where the next patch may start: beside
  /// this one, or `start` (then used) if nothing is left there.
  uint32_t grow(uint32_t start) {
    ++patch_;
    vertices_ = 0;
    candidates_.clear();
    const glm::dvec3 middle = centre_[start];
    take(start);
    for (size_t taken = 1;; ++taken) {
      std::erase_if(candidates_, [&](uint32_t t) { return used_[t]; });
      if (candidates_.empty()) return start;
      std::tuple<size_t, double, uint32_t> best{4, 0.0, 0};
      for (const uint32_t t : candidates_) {
        const glm::dvec3 away = centre_[t] - middle;
        best = std::min(best, {new_vertices(t), dot(away, away), t});
      }
      const uint32_t next = std::get<2>(best);
      if (vertices_ + std::get<0>(best) > kPatchVertices || taken == kPatchTriangles) return next;
      take(next);
    }
  }

  const Mesh& mesh_;
  std::vector<bool> used_;
  std::vector<uint32_t> in_patch_;        // number of the patch a vertex was last taken into
  std::vector<uint32_t> listed_;          // number of the patch a triangle was last a candidate of
  std::vector<uint32_t> first_, around_;  // triangles around each vertex
  std::vector<uint32_t> candidates_, order_;
  std::vector<glm::dvec3> centre_;  // of each triangle, times 3
  uint32_t patch_ = 0;
  size_t vertices_ = 0;
};

template <size_t N>
void reorder(std::array<FloatStream, N>& streams, const std::vector<uint32_t>& old_of_new) {
  for (FloatStream& stream : streams) {
    if (stream.empty()) continue;
    std::vector<float> moved;
    moved.reserve(old_of_new.size());
    for (const uint32_t old : old_of_new) moved.push_back(stream[old]);
    stream = std::move(moved);
  }
}

struct Edge {
  uint32_t low, high;  // vertices
  uint32_t triangle;
  double length2;
};

}  // namespace

void order_in_patches(Mesh& mesh) {
  const std::vector<uint32_t> order = PatchGrower(mesh).order();
  std::vector<uint32_t> new_of_old(mesh.vertex_count(), UINT32_MAX), old_of_new, indices;
  indices.reserve(mesh.indices.size());
  for (const uint32_t triangle : order)
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t old = mesh.indices[3 * triangle + k];
      if (new_of_old[old] == UINT32_MAX) {
        new_of_old[old] = uint32_t(old_of_new.size());
        old_of_new.push_back(old);
      }
      indices.push_back(new_of_old[old]);
    }
  mesh.indices = std::move(indices);
  reorder(mesh.position, old_of_new);
  reorder(mesh.normal, old_of_new);
  reorder(mesh.uv, old_of_new);
  reorder(mesh.color, old_of_new);
}

void split_edges(Mesh& mesh, size_t triangles) {
  std::vector<Edge> edges;
  for (uint32_t t = 0; t < mesh.triangle_count(); ++t)
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t a = mesh.indices[3 * t + k], b = mesh.indices[3 * t + (k + 1) % 3];
      const glm::dvec3 along = vec(mesh.position, a) - vec(mesh.position, b);
      edges.push_back({std::min(a, b), std::max(a, b), t, dot(along, along)});
    }
  // A heap, since few of the edges are wanted. The two sides of an edge come out one after the other.
  const auto later = [](const Edge& a, const Edge& b) {
    return std::tuple(a.length2, a.low, a.high, a.triangle) < std::tuple(b.length2, b.low, b.high, b.triangle);
  };
  std::make_heap(edges.begin(), edges.end(), later);
  const auto longest = [&] {
    std::pop_heap(edges.begin(), edges.end(), later);
    const Edge edge = edges.back();
    edges.pop_back();
    return edge;
  };
  std::vector<bool> touched(mesh.triangle_count());
  while (edges.size() >= 2 && mesh.triangle_count() < triangles) {
    const Edge one = longest(), two = longest();
    if (touched[one.triangle] || touched[two.triangle]) continue;
    const uint32_t middle = uint32_t(mesh.vertex_count());
    add_vertex(mesh, (vec(mesh.position, one.low) + vec(mesh.position, one.high)) * 0.5,
               unit(vec(mesh.normal, one.low) + vec(mesh.normal, one.high)));
    for (const uint32_t t : {one.triangle, two.triangle}) {
      touched[t] = true;
      // The old triangle keeps the corner `low`, a copy gets `high`; both turn the same way round.
      for (size_t k = 0; k < 3; ++k) {
        const uint32_t v = mesh.indices[3 * t + k];
        mesh.indices.push_back(v == one.low ? middle : v);
      }
      for (size_t k = 0; k < 3; ++k)
        if (mesh.indices[3 * t + k] == one.high) mesh.indices[3 * t + k] = middle;
    }
  }
}

}  // namespace trueshade
