#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/fp_env.h"
#include "scenes/add_normals.h"
#include "scenes/hierarchy.h"
#include "scenes/trig.h"

// Vertices of meshes that deform: morph targets first, then the skin. docs/arithmetic.md, section 1.
namespace trueshade {
namespace {

constexpr double kLargest = 1e18;

using Streams = std::array<FloatStream, 3>;

glm::dvec3 at(const Streams& streams, size_t vertex) {
  return {double(streams[0][vertex]), double(streams[1][vertex]), double(streams[2][vertex])};
}

/// A matrix a joint: world_from_joint * joint_from_mesh.
std::vector<glm::dmat4x3> joint_matrices(const Skin& skin, std::span<const glm::dmat4x3> world_from_nodes) {
  std::vector<glm::dmat4x3> matrices;
  matrices.reserve(skin.joints.size());
  for (size_t i = 0; i < skin.joints.size(); ++i)
    matrices.push_back(product(world_from_nodes[skin.joints[i]], skin.joint_from_mesh[i]));
  return matrices;
}

/// The joints' matrices by their share of the vertex's weights. A vertex without weights follows its first joint.
glm::dmat4x3 blended(const RestShape& shape, size_t vertex, std::span<const glm::dmat4x3> joints) {
  const size_t first = vertex * shape.influences;
  double all = 0.0;
  for (size_t k = 0; k < shape.influences; ++k) all = all + double(shape.weights[first + k]);
  if (!(all > 0.0)) return joints[shape.joints[first]];
  glm::dmat4x3 sum(0.0);
  for (size_t k = 0; k < shape.influences; ++k) {
    if (shape.weights[first + k] == 0.0f) continue;
    const double share = double(shape.weights[first + k]) / all;
    const glm::dmat4x3& joint = joints[shape.joints[first + k]];
    for (int c = 0; c < 4; ++c)
      for (int r = 0; r < 3; ++r) sum[c][r] = sum[c][r] + share * joint[c][r];
  }
  return sum;
}

glm::dvec3 moved(const glm::dmat4x3& m, const glm::dvec3& p) {
  glm::dvec3 out;
  for (int r = 0; r < 3; ++r) out[r] = ((m[0][r] * p.x + m[1][r] * p.y) + m[2][r] * p.z) + m[3][r];
  return out;
}

/// A matrix whose cofactors and their squares neither overflow nor vanish: `m` itself, or where its magnitudes are
/// extreme, `m` divided by the largest. The direction of transformed normals is the same.
glm::dmat4x3 scaled_for_cofactors(const glm::dmat4x3& m) {
  constexpr double kMost = 1e60;
  double largest = 0.0;
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) largest = std::max(largest, std::fabs(m[c][r]));
  if ((largest <= kMost && largest >= 1.0 / kMost) || largest == 0.0) return m;
  glm::dmat4x3 out = m;
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) out[c][r] = m[c][r] / largest;
  return out;
}

/// By the inverse transpose, up to its length: cofactors, with the sign of the determinant.
glm::dvec3 turned_normal(const glm::dmat4x3& matrix, const glm::dvec3& n) {
  const glm::dmat4x3 m = scaled_for_cofactors(matrix);
  const glm::dvec3 x = cross(m[1], m[2]), y = cross(m[2], m[0]), z = cross(m[0], m[1]);
  glm::dvec3 out;
  for (int r = 0; r < 3; ++r) out[r] = (x[r] * n.x + y[r] * n.y) + z[r] * n.z;
  return unit(dot(m[0], x) < 0.0 ? -out : out);
}

glm::dvec3 turned_tangent(const glm::dmat4x3& m, const glm::dvec3& t) {
  glm::dvec3 out;
  for (int r = 0; r < 3; ++r) out[r] = (m[0][r] * t.x + m[1][r] * t.y) + m[2][r] * t.z;
  return unit(out);
}

/// Deltas of a target that takes part.
struct WeightedDeltas {
  const Streams* deltas;
  double weight;
};

/// The targets that move a stream, in order; those of weight 0 take no part.
std::vector<WeightedDeltas> moving_targets(const RestShape& shape, Streams MorphTarget::*stream,
                                           std::span<const double> weights) {
  std::vector<WeightedDeltas> moving;
  for (size_t i = 0; i < shape.targets.size(); ++i) {
    const Streams& deltas = shape.targets[i].*stream;
    if (weights[i] != 0.0 && !deltas[0].empty()) moving.push_back({&deltas, weights[i]});
  }
  return moving;
}

/// rest + sum of weight * delta.
glm::dvec3 morphed(const Streams& rest, std::span<const WeightedDeltas> moving, size_t vertex) {
  glm::dvec3 value = at(rest, vertex);
  for (const auto& [deltas, weight] : moving) {
    const glm::dvec3 delta = at(*deltas, vertex);
    for (int k = 0; k < 3; ++k) value[k] = value[k] + weight * delta[k];
  }
  return value;
}

bool all_within(const glm::dvec3& v, double most) {
  return std::fabs(v.x) <= most && std::fabs(v.y) <= most && std::fabs(v.z) <= most;  // false for NaN
}

}  // namespace

void pose_mesh(const PosedMesh& posed, const Timeline& timeline, std::span<const glm::dmat4x3> world_from_nodes,
               double time, const std::string& where, Mesh& mesh) {
  const FpScope fp;
  const RestShape& shape = timeline.shapes[posed.shape];
  const std::vector<double> weights = posed.motion ? weights_at(*posed.motion, time) : posed.weights;
  std::vector<glm::dmat4x3> joints;
  if (posed.skin) joints = joint_matrices(timeline.skins[*posed.skin], world_from_nodes);
  const bool skinned = posed.skin.has_value() && shape.influences > 0;
  const std::vector<WeightedDeltas> moved_positions = moving_targets(shape, &MorphTarget::position, weights),
                                    moved_normals = moving_targets(shape, &MorphTarget::normal, weights),
                                    moved_tangents = moving_targets(shape, &MorphTarget::tangent, weights);
  for (size_t v = 0; v < mesh.vertex_count(); ++v) {
    glm::dvec3 p = morphed(shape.position, moved_positions, v), n(0.0), t(0.0);
    if (!shape.flat_normals) n = morphed(shape.normal, moved_normals, v);
    if (!moved_normals.empty()) n = unit(n);
    if (mesh.has_tangents()) t = morphed(shape.tangent, moved_tangents, v);
    if (!moved_tangents.empty()) t = unit(t);
    if (skinned) {
      const glm::dmat4x3 m = blended(shape, v, joints);
      p = moved(m, p);
      n = turned_normal(m, n);
      t = turned_tangent(m, t);
    }
    if (!all_within(p, kLargest))
      throw Error(ErrorKind::bad_input, where + ": vertex " + std::to_string(v), "its pose takes it beyond 1e18",
                  "smaller weights and matrices");
    if (!all_within(n, kLargest) || !all_within(t, kLargest))
      throw Error(ErrorKind::bad_input, where + ": vertex " + std::to_string(v),
                  "its pose takes its normal or its tangent beyond 1e18", "smaller weights and matrices");
    for (int k = 0; k < 3; ++k) {
      mesh.position[size_t(k)][v] = float(p[k]);
      if (!shape.flat_normals) mesh.normal[size_t(k)][v] = float(n[k]);
      if (mesh.has_tangents()) mesh.tangent[size_t(k)][v] = float(t[k]);
    }
  }
  if (shape.flat_normals) set_flat_normals(mesh);
  ++mesh.pose;
}

}  // namespace trueshade
