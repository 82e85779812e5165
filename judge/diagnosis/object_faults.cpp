// What people get wrong of one object: its matrix, its triangles, its vertices.
#include <algorithm>
#include <cmath>
#include <map>

#include "judge/diagnosis/plane_evidence.h"
#include "judge/diagnosis/triple.h"

namespace trueshade::oracle {

namespace {

using P = FaultParameter;
using Suspects = std::vector<FaultParameter>;

Instance* object_of(Scene& s, const P& p) {
  return p.number < double(s.instances.size()) ? &s.instances[size_t(p.number)] : nullptr;
}

/// Gives the object its own copy of its mesh, and returns the copy; null where the scene has no such object.
Mesh* own_mesh(Scene& s, const P& p) {
  Instance* object = object_of(s, p);
  if (object == nullptr) return nullptr;
  Mesh copy = s.meshes[object->mesh];
  object->mesh = uint32_t(s.meshes.size());
  s.meshes.push_back(std::move(copy));
  return &s.meshes.back();
}

bool move_object(Scene& s, Pipeline&, const P& p) {
  Instance* o = object_of(s, p);
  if (o != nullptr) o->world_from_object[3] += vec3_of(p.vector);
  return o != nullptr && p.vector != Triple3{};
}

/// v turned about the direction of `degrees`, by its length in degrees (Rodrigues).
Triple3 turned_about(const Triple3& v, const Triple3& degrees) {
  const double angle = std::sqrt(inner(degrees, degrees)) * std::acos(-1.0) / 180;
  const Triple3 axis = unit(degrees), across = cross(axis, v),
                along = times(axis, inner(axis, v) * (1 - std::cos(angle)));
  return plus(plus(times(v, std::cos(angle)), times(across, std::sin(angle))), along);
}

bool turn_object(Scene& s, Pipeline&, const P& p) {
  Instance* o = object_of(s, p);
  if (o == nullptr) return false;
  for (int c = 0; c < 3; ++c)
    o->world_from_object[c] = vec3_of(turned_about(triple(o->world_from_object[c]), p.vector));
  return p.vector != Triple3{};
}

bool scale_object(Scene& s, Pipeline&, const P& p) {
  Instance* o = object_of(s, p);
  if (o == nullptr) return false;
  for (int c = 0; c < 3; ++c) {
    if (p.vector[size_t(c)] == 0) return false;
    o->world_from_object[c] *= float(p.vector[size_t(c)]);
  }
  return p.vector != Triple3{1, 1, 1};
}

bool drop_matrix(Scene& s, Pipeline&, const P& p) {
  Instance* o = object_of(s, p);
  if (o == nullptr || o->world_from_object == glm::mat4x3(1.0f)) return false;
  o->world_from_object = glm::mat4x3(1.0f);
  return true;
}

bool wind_other_way(Scene& s, Pipeline&, const P& p) {
  Mesh* mesh = own_mesh(s, p);
  if (mesh == nullptr) return false;
  for (size_t t = 0; t + 2 < mesh->indices.size(); t += 3) std::swap(mesh->indices[t + 1], mesh->indices[t + 2]);
  return true;
}

bool turn_normals(Scene& s, Pipeline&, const P& p) {
  Mesh* mesh = own_mesh(s, p);
  if (mesh == nullptr) return false;
  for (FloatStream& stream : mesh->normal)
    for (float& n : stream) n = -n;
  return true;
}

/// Deletes triangles of the object: vector[1] of them, from number vector[0] on. False where there are none.
bool drop_triangles(Scene& s, Pipeline&, const P& p) {
  Mesh* mesh = own_mesh(s, p);
  if (mesh == nullptr || !(p.vector[0] >= 0) || !(p.vector[1] >= 1)) return false;
  const auto count = double(mesh->triangle_count());
  const auto first = size_t(std::min(p.vector[0], count)), end = size_t(std::min(p.vector[0] + p.vector[1], count));
  if (first == end) return false;
  std::vector<uint32_t> left(mesh->indices.begin(), mesh->indices.begin() + ptrdiff_t(3 * first));
  left.insert(left.end(), mesh->indices.begin() + ptrdiff_t(3 * end), mesh->indices.end());
  mesh->indices = std::move(left);
  return true;
}

/// Moves vertex `part` of the object's mesh, for all objects that share the mesh.
bool move_vertex(Scene& s, Pipeline&, const P& p) {
  Instance* o = object_of(s, p);
  if (o == nullptr || !(p.part < double(s.meshes[o->mesh].vertex_count())) || p.vector == Triple3{}) return false;
  for (size_t k = 0; k < 3; ++k) s.meshes[o->mesh].position[k][size_t(p.part)] += float(p.vector[k]);
  return true;
}

bool other_material(Scene& s, Pipeline&, const P& p) {
  Instance* o = object_of(s, p);
  if (o == nullptr || !(p.part < double(s.materials.size())) || o->material == uint32_t(p.part)) return false;
  o->material = uint32_t(p.part);
  return true;
}

bool wrap_indices(Scene& s, Pipeline&, double) {
  constexpr uint32_t kMost = 65536;
  bool any = false;
  for (Mesh& mesh : s.meshes) {
    if (mesh.vertex_count() <= kMost) continue;
    for (uint32_t& i : mesh.indices) any = any || i >= kMost, i %= kMost;
  }
  return any;
}

// --- which objects, and from where to start

Suspects every_object(const PlaneEvidence& e, std::initializer_list<Triple3> from) {
  Suspects all;
  for (const uint32_t object : suspected_objects(e))
    for (const Triple3& v : from) all.emplace_back(double(object), v);
  return all;
}

Suspects that_are_wrong(const PlaneEvidence& e) { return every_object(e, {Triple3{}}); }

/// Each suspected object, not moved, and moved as the mean position of its pixels is.
Suspects that_moved(const PlaneEvidence& e) {
  Suspects all;
  for (const uint32_t object : suspected_objects(e)) {
    Triple3 given{}, expected{};
    double of_given = 0, of_expected = 0;
    for (const EvidentPixel& p : e.pixels) {
      const auto add = [&](const PlaneValues& v, Triple3& sum, double& weight) {
        if (v.object == object + 1.0) sum = plus(sum, times(v.position, p.at.weight)), weight += p.at.weight;
      };
      add(p.given, given, of_given), add(p.expected, expected, of_expected);
    }
    all.emplace_back(double(object), Triple3{});
    if (of_given > 0 && of_expected > 0 && e.has_plane(Plane::position))
      all.emplace_back(double(object), minus(times(given, 1 / of_given), times(expected, 1 / of_expected)));
  }
  return all;
}

Suspects that_turned(const PlaneEvidence& e) {
  return every_object(
      e, {{0, 0, 0},   {0, 10, 0}, {0, -10, 0}, {10, 0, 0},  {-10, 0, 0}, {0, 0, 10},  {0, 0, -10}, {0, 30, 0},
          {0, -30, 0}, {30, 0, 0}, {-30, 0, 0}, {0, 0, 30},  {0, 0, -30}, {0, 90, 0},  {0, -90, 0}, {90, 0, 0},
          {-90, 0, 0}, {0, 0, 90}, {0, 0, -90}, {0, 180, 0}, {180, 0, 0}, {0, 0, 180}, {0, 60, 0},  {0, -60, 0}});
}

Suspects that_have_another_size(const PlaneEvidence& e) {
  return every_object(e, {{1, 1, 1},
                          {0.5, 0.5, 0.5},
                          {0.75, 0.75, 0.75},
                          {1.5, 1.5, 1.5},
                          {2, 2, 2},
                          {-1, 1, 1},
                          {1, -1, 1},
                          {1, 1, -1},
                          {1, 2, 1},
                          {1, 0.5, 1},
                          {2, 1, 1},
                          {1, 1, 2},
                          {0.5, 1, 1},
                          {1, 1, 0.5}});
}

/// Each suspected object, without the triangles from the first to the last one that should be seen and is not, and
/// without more on either side.
Suspects that_lack_triangles(const PlaneEvidence& e) {
  Suspects all;
  for (const uint32_t object : suspected_objects(e)) {
    std::map<uint32_t, std::array<double, 2>> seen;  // by triangle: right, wrong
    for (const EvidentPixel& p : e.pixels)
      if (p.expected.object == object + 1.0) seen[p.triangle][p.wrong ? 1 : 0] += p.at.weight;
    double first = -1, last = -1;
    for (const auto& [triangle, weights] : seen) {
      if (!(weights[1] > weights[0])) continue;
      if (first < 0) first = triangle;
      last = triangle;
    }
    if (first < 0) continue;
    const auto count = double(e.scene.meshes[e.scene.instances[object].mesh].triangle_count());
    all.push_back(P(double(object), {first, last - first + 1, 0}));
    all.push_back(P(double(object), {first, count - first, 0}));
    all.push_back(P(double(object), {0, last + 1, 0}));
    // Those before it may be hidden.
    for (const double from : {first - 1, first - 2, std::floor(count / 2), std::floor(count * 3 / 4)})
      if (from > 0 && from <= first) all.push_back(P(double(object), {from, count - from, 0}));
  }
  return all;
}

/// Each suspected object with four vertices: those of the triangles of the most wrong pixels and the fewest right ones.
Suspects that_have_a_wrong_vertex(const PlaneEvidence& e) {
  Suspects all;
  for (const uint32_t object : suspected_objects(e)) {
    const Mesh& mesh = e.scene.meshes[e.scene.instances[object].mesh];
    std::map<uint32_t, double> votes;
    for (const EvidentPixel& p : e.pixels)
      for (size_t i = 0; i < 3 && p.expected.object == object + 1.0; ++i)
        votes[mesh.indices[3 * size_t(p.triangle) + i]] += p.at.weight * (p.wrong ? 1 : -1);
    std::vector<std::pair<double, uint32_t>> ranked;
    for (const auto& [vertex, weight] : votes) ranked.emplace_back(-weight, vertex);
    std::sort(ranked.begin(), ranked.end());
    for (size_t i = 0; i < std::min<size_t>(4, ranked.size()); ++i)
      all.push_back(P(double(object), {}, double(ranked[i].second)));
  }
  return all;
}

/// Each suspected object with the material that most of its pixels show: by the identifier or, where that was not
/// captured, by the base color that comes nearest.
Suspects that_have_another_material(const PlaneEvidence& e) {
  Suspects all;
  for (const uint32_t object : suspected_objects(e)) {
    std::map<double, double> votes;
    for (const EvidentPixel& p : e.pixels) {
      if (p.expected.object != object + 1.0) continue;
      if (e.has_plane(Plane::material)) votes[p.given.material - 1] += p.at.weight;
      if (e.has_plane(Plane::material) || !e.has_plane(Plane::albedo)) continue;
      double nearest = HUGE_VAL, at = 0;
      for (size_t m = 0; m < std::min<size_t>(e.scene.materials.size(), 64); ++m) {
        double off = 0;
        for (int k = 0; k < 3; ++k)
          off += std::fabs(double(e.scene.materials[m].base_color[k]) - p.given.albedo[size_t(k)]);
        if (off < nearest) nearest = off, at = double(m);
      }
      votes[at] += p.at.weight;
    }
    const auto best =
        std::max_element(votes.begin(), votes.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
    if (best != votes.end() && best->first >= 0) all.push_back(P(double(object), {}, best->first));
  }
  return all;
}

using Fault = PlaneFault;
constexpr double kObjectChange = -3e-4;  ///< of the extent: PlaneFault::change_of

constexpr PlaneFault of_object(std::string_view name, std::string_view text, bool (*edit)(Scene&, Pipeline&, const P&),
                               Suspects (*suspects)(const PlaneEvidence&), ParameterForm numbers, Fit fit = Fit::none,
                               double change_of = 0, double start = 0) {
  return {.name = name,
          .text = text,
          .search = Fault::Search::suspected,
          .edit = edit,
          .suspects = suspects,
          .numbers = numbers,
          .fit = fit,
          .start = start,
          .change_of = change_of};
}

constexpr PlaneFault kObjectFaults[] = {
    of_object("object-matrix-missing", "the matrix of object %s is not applied", drop_matrix, that_are_wrong,
              {true, false, 0}),
    of_object("object-wound", "the triangles of object %s are wound the other way", wind_other_way, that_are_wrong,
              {true, false, 0}),
    of_object("object-normals-turned", "the normals of object %s point inward", turn_normals, that_are_wrong,
              {true, false, 0}),
    of_object("object-material", "object %s has material %p", other_material, that_have_another_material,
              {true, true, 0}),
    of_object("object-moved", "object %s is moved by %v", move_object, that_moved, {true, false, 3}, Fit::object,
              kObjectChange),
    of_object("object-turned",
              "object %s is turned about its own origin by %v, an axis as long as the angle in degrees", turn_object,
              that_turned, {true, false, 3}, Fit::object, 0.05),
    of_object("object-scaled", "object %s is %v times as large along its own axes", scale_object,
              that_have_another_size, {true, false, 3}, Fit::object, 1e-3, 1),
    of_object("triangles-missing", "object %s lacks triangles: %v are the first and how many", drop_triangles,
              that_lack_triangles, {true, false, 2}),
    of_object("vertex-moved", "vertex %p of the mesh of object %s is moved by %v, in the object's space", move_vertex,
              that_have_a_wrong_vertex, {true, true, 3}, Fit::object, kObjectChange),
    {.name = "indices-16-bits", .text = "indices of vertices are taken modulo 65,536", .redraw = wrap_indices},
};

}  // namespace

std::span<const PlaneFault> object_faults() { return kObjectFaults; }

}  // namespace trueshade::oracle
