#include "scenes/builtin/surface_net.h"

#include <cmath>
#include <vector>

#include "scenes/shapes.h"
#include "scenes/trig.h"

namespace trueshade {
namespace {

constexpr int kBlock = 4;  // nodes along a side of a block that is skipped together where the surface is far

class Net {
 public:
  Net(const DistanceField& field, const glm::dvec3& low, const glm::ivec3& cells, double step)
      : field_(field),
        low_(low),
        nodes_(cells + glm::ivec3(1)),
        step_(step),
        value_(size_t(nodes_.x) * size_t(nodes_.y) * size_t(nodes_.z), 1.0f),
        vertex_(value_.size(), kNone) {}

  Mesh build() {
    sample();
    for (int z = 0; z + 1 < nodes_.z; ++z)
      for (int y = 0; y + 1 < nodes_.y; ++y)
        for (int x = 0; x + 1 < nodes_.x; ++x) add_cell_vertex({x, y, z});
    for (int z = 1; z + 1 < nodes_.z; ++z)
      for (int y = 1; y + 1 < nodes_.y; ++y)
        for (int x = 1; x + 1 < nodes_.x; ++x)
          for (int axis = 0; axis < 3; ++axis) add_edge_quad({x, y, z}, axis);
    return std::move(mesh_);
  }

 private:
  static constexpr uint32_t kNone = UINT32_MAX;

  size_t at(const glm::ivec3& n) const {
    return (size_t(n.z) * size_t(nodes_.y) + size_t(n.y)) * size_t(nodes_.x) + size_t(n.x);
  }
  glm::dvec3 place(const glm::ivec3& n) const { return low_ + glm::dvec3(n) * step_; }

  /// Field values at the nodes. A block whose middle is farther from the surface than its corners keeps one sign.
  void sample() {
    const double reach = 1.1 * std::sqrt(3.0) * 0.5 * kBlock * step_;
    for (int z = 0; z < nodes_.z; z += kBlock)
      for (int y = 0; y < nodes_.y; y += kBlock)
        for (int x = 0; x < nodes_.x; x += kBlock) {
          const double middle = field_(place({x, y, z}) + glm::dvec3(0.5 * (kBlock - 1) * step_));
          const bool far = std::fabs(middle) > reach;
          for (int k = z; k < z + kBlock && k < nodes_.z; ++k)
            for (int j = y; j < y + kBlock && j < nodes_.y; ++j)
              for (int i = x; i < x + kBlock && i < nodes_.x; ++i)
                value_[at({i, j, k})] = float(far ? middle : field_(place({i, j, k})));
        }
  }

  bool inside(const glm::ivec3& n) const { return value_[at(n)] < 0.0f; }

  /// The mean of the points where the cell's edges cross the surface, then one Newton step onto it.
  void add_cell_vertex(const glm::ivec3& cell) {
    int crossings = 0;
    glm::dvec3 sum(0.0);
    for (int corner = 0; corner < 8; ++corner)
      for (int axis = 0; axis < 3; ++axis) {
        if (corner >> axis & 1) continue;
        const glm::ivec3 a = cell + glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
        glm::ivec3 b = a;
        ++b[axis];
        if (inside(a) == inside(b)) continue;
        const double va = double(value_[at(a)]), vb = double(value_[at(b)]);
        glm::dvec3 p = place(a);
        p[axis] += step_ * (va / (va - vb));
        sum += p;
        ++crossings;
      }
    if (crossings == 0) return;
    glm::dvec3 p = sum * (1.0 / crossings);
    const glm::dvec3 slope = gradient(p);
    const double slope2 = dot(slope, slope);
    if (slope2 > 0.0) p -= slope * (field_(p) / slope2);
    vertex_[at(cell)] = uint32_t(mesh_.vertex_count());
    add_vertex(mesh_, p, unit(slope));  // the step is far shorter than the gradient takes to turn
  }

  glm::dvec3 gradient(const glm::dvec3& p) const {
    const double h = 0.25 * step_;
    glm::dvec3 g(0.0);
    for (int k = 0; k < 3; ++k) {
      glm::dvec3 ahead = p, behind = p;
      ahead[k] += h;
      behind[k] -= h;
      g[k] = (field_(ahead) - field_(behind)) / (2.0 * h);
    }
    return g;
  }

  /// The four cells around the edge from `node` along `axis`, counter-clockwise seen from outside.
  void add_edge_quad(const glm::ivec3& node, int axis) {
    glm::ivec3 end = node;
    ++end[axis];
    const bool starts_inside = inside(node);
    if (starts_inside == inside(end)) return;
    glm::ivec3 s(0), t(0);
    s[(axis + 1) % 3] = 1;
    t[(axis + 2) % 3] = 1;
    uint32_t q[4] = {vertex_[at(node - s - t)], vertex_[at(node - t)], vertex_[at(node)], vertex_[at(node - s)]};
    if (!starts_inside) std::swap(q[1], q[3]);
    const bool cut_02 = distance2(q[0], q[2]) <= distance2(q[1], q[3]);
    if (cut_02)
      add_quad(mesh_, q[0], q[1], q[2], q[3]);
    else
      add_quad(mesh_, q[1], q[2], q[3], q[0]);
  }

  double distance2(uint32_t a, uint32_t b) const {
    double sum = 0.0;
    for (const auto& stream : mesh_.position) {
      const double d = double(stream[a]) - double(stream[b]);
      sum += d * d;
    }
    return sum;
  }

  const DistanceField& field_;
  glm::dvec3 low_;
  glm::ivec3 nodes_;
  double step_;
  std::vector<float> value_;
  std::vector<uint32_t> vertex_;
  Mesh mesh_;
};

}  // namespace

Mesh surface_net(const DistanceField& field, const glm::dvec3& low, const glm::ivec3& cells, double step) {
  return Net(field, low, cells, step).build();
}

}  // namespace trueshade
