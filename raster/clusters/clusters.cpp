#include "raster/clusters/clusters.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/fp_env.h"

namespace trueshade {
namespace {

// Greedy: triangles in submission order until there is a vertex or a triangle too many, or the next triangle is part of
// something else. Order inside a mesh is thus kept, which makes (cluster, triangle) order the submission order.
class Builder {
 public:
  explicit Builder(const Mesh& mesh) : mesh_(mesh), seen_in_(mesh.vertex_count(), 0), local_(mesh.vertex_count()) {
    const size_t triangles = mesh.triangle_count();
    for (auto& stream : out_.corner) stream.reserve(triangles + kCornerSlack);
    const size_t vertices = mesh.vertex_count() + mesh.vertex_count() / 2;  // some are in several clusters
    out_.vertex.reserve(vertices);
    for (auto& stream : out_.position) stream.reserve(vertices);
    out_.surface.reserve(vertices / 16 * size_t(surface_lines()));
  }

  ClusteredMesh build() {
    for (size_t triangle = 0; triangle < mesh_.triangle_count(); ++triangle) {
      const uint32_t* corner = &mesh_.indices[3 * triangle];
      if (triangle == 0 || current_.triangles == kClusterTriangles ||
          current_.vertices + added(corner) > kClusterVertices || leaps(corner))
        start(triangle);
      for (int i = 0; i < 3; ++i) out_.corner[size_t(i)].push_back(local_vertex(corner[i]));
      ++current_.triangles;
    }
    finish();
    for (size_t c = 0; c < 3; ++c) add_box(c, least_[c], greatest_[c]);
    for (auto& stream : out_.corner) stream.resize(stream.size() + kCornerSlack);
    for (auto* ends : {&out_.center, &out_.half_size})
      for (auto& stream : *ends) stream.resize(stream.size() + kBoxSlack);
    ClusteredMesh mesh;
    mesh.clusters = std::move(out_.clusters);
    for (size_t c = 0; c < 3; ++c) {
      mesh.boxes.center[c] = std::move(out_.center[c]), mesh.boxes.half_size[c] = std::move(out_.half_size[c]);
      mesh.position[c] = std::move(out_.position[c]), mesh.corner[c] = std::move(out_.corner[c]);
    }
    mesh.surface = std::move(out_.surface), mesh.surface_lines = surface_lines();
    mesh.vertex = std::move(out_.vertex);
    mesh.pose = mesh_.pose;
    return mesh;
  }

 private:
  int surface_lines() const { return mesh_.has_color() ? 7 : 3; }

  int added(const uint32_t* corner) const {
    int count = 0;
    for (int i = 0; i < 3; ++i) {
      bool known = seen_in_[corner[i]] == stamp_;
      for (int k = 0; k < i; ++k) known |= corner[k] == corner[i];
      count += !known;
    }
    return count;
  }

  /// Whether a triangle shares no vertex with the current cluster and lies so far from it that a box around both is
  /// larger than the cluster's by kFar. Small boxes touch few tiles.
  bool leaps(const uint32_t* corner) const {
    if (current_.triangles < kFewTriangles || added(corner) < 3) return false;
    double before = 0.0, after = 0.0;
    for (size_t c = 0; c < 3; ++c) {
      float low = box_low_[c], high = box_high_[c];
      before += double(high) - double(low);
      for (int i = 0; i < 3; ++i) {
        const float value = mesh_.position[c][corner[i]];
        low = std::min(low, value), high = std::max(high, value);
      }
      after += double(high) - double(low);
    }
    return after > kFar * before;
  }

  void start(size_t triangle) {
    finish();
    box_low_ = {kMost, kMost, kMost}, box_high_ = {-kMost, -kMost, -kMost};
    ++stamp_;
    current_ = {};
    current_.first_vertex = uint32_t(out_.vertex.size());
    current_.first_triangle = uint32_t(triangle);
  }

  uint8_t local_vertex(uint32_t vertex) {
    if (seen_in_[vertex] != stamp_) {
      seen_in_[vertex] = stamp_;
      local_[vertex] = uint8_t(current_.vertices++);
      out_.vertex.push_back(vertex);
      for (size_t c = 0; c < 3; ++c) {
        box_low_[c] = std::min(box_low_[c], mesh_.position[c][vertex]);
        box_high_[c] = std::max(box_high_[c], mesh_.position[c][vertex]);
      }
    }
    return local_[vertex];
  }

  void add_box(size_t axis, float low, float high) {
    const float center = low * 0.5f + high * 0.5f, half = std::max(high - center, center - low);
    out_.center[axis].push_back(center);
    out_.half_size[axis].push_back(half + std::abs(half) * 0x1p-22f + std::numeric_limits<float>::min());
  }

  void add_line(const FloatStream& from, size_t first) {
    VertexLine line{};
    for (size_t k = 0; k < 16 && !from.empty(); ++k) line.value[k] = from[out_.vertex[first + k]];
    out_.surface.push_back(line);
  }

  void finish() {
    if (current_.triangles == 0) return;
    while (out_.vertex.size() % 16 != 0) out_.vertex.push_back(out_.vertex.back());
    for (size_t c = 0; c < 3; ++c) {
      float low = std::numeric_limits<float>::max(), high = std::numeric_limits<float>::lowest();
      for (size_t i = current_.first_vertex; i < out_.vertex.size(); ++i) {
        const float value = mesh_.position[c][out_.vertex[i]];
        out_.position[c].push_back(value);
        low = std::min(low, value);
        high = std::max(high, value);
      }
      add_box(c, low, high);
      least_[c] = std::min(least_[c], low);
      greatest_[c] = std::max(greatest_[c], high);
    }
    for (size_t i = current_.first_vertex; i < out_.vertex.size(); i += 16) {
      for (size_t c = 0; c < 3; ++c) add_line(mesh_.normal[c], i);
      for (size_t c = 0; c < 4 && mesh_.has_color(); ++c) add_line(mesh_.color[c], i);
    }
    out_.clusters.push_back(current_);
  }

  const Mesh& mesh_;
  struct {  // of ClusteredMesh; vectors, because elements are added one by one
    std::vector<Cluster> clusters;
    std::array<std::vector<float>, 3> center, half_size;
    std::array<HugeVector<float>, 3> position;
    HugeVector<VertexLine> surface;
    HugeVector<uint32_t> vertex;
    std::array<HugeVector<uint8_t>, 3> corner;
  } out_;
  static constexpr size_t kBoxSlack = 16;
  static constexpr int kFewTriangles = 8;  ///< of a cluster that a far triangle may still join
  static constexpr double kFar = 1.25;     ///< times the sum of a box's sides
  static constexpr float kMost = std::numeric_limits<float>::max();
  float least_[3] = {kMost, kMost, kMost}, greatest_[3] = {-kMost, -kMost, -kMost};
  Cluster current_{};
  std::array<float, 3> box_low_{}, box_high_{};  ///< of the current cluster
  uint32_t stamp_ = 0;
  std::vector<uint32_t> seen_in_;
  std::vector<uint8_t> local_;
};

}  // namespace

ClusteredMesh cluster_mesh(const Mesh& mesh) { return Builder(mesh).build(); }

ClusteredScene cluster_scene(const Scene& scene) {
  const FpScope fp;
  ClusteredScene out;
  for (const Mesh& mesh : scene.meshes) out.meshes.push_back(cluster_mesh(mesh));
  return out;
}

void cluster_posed_meshes(const Scene& scene, ClusteredScene& clusters) {
  const FpScope fp;
  for (size_t i = 0; i < scene.meshes.size(); ++i)
    if (clusters.meshes[i].pose != scene.meshes[i].pose) clusters.meshes[i] = cluster_mesh(scene.meshes[i]);
}

}  // namespace trueshade
