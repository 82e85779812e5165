// Faults of what is drawn: one object, its matrix, its triangles; the camera and the window.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "tests/judge/captured.h"
#include "tests/judge/diagnosis/plants.h"
#include "tests/judge/diagnosis/wrong_lights.h"

namespace trueshade::testing {

namespace {

/// A plane that slides along itself shows nothing of it.
bool is_flat(const Mesh& mesh) {
  for (size_t k = 0; k < 3; ++k) {
    const auto [low, high] = std::minmax_element(mesh.position[k].begin(), mesh.position[k].end());
    if (low == mesh.position[k].end() || *low == *high) return true;
  }
  return false;
}

/// Objects of all sizes, by the variant.
Instance& object_of(Scene& s, int variant) {
  size_t at = (size_t(variant) * 7 + 1) % s.instances.size();
  for (size_t i = 0; i < s.instances.size() && is_flat(s.meshes[s.instances[at].mesh]); ++i)
    at = (at + 1) % s.instances.size();
  return s.instances[at];
}

template <class Change>
Input of_object(Change change) {
  return [change](Scene& s, Pipeline&, int variant) {
    change(object_of(s, variant), variant);
    return true;
  };
}

/// A mesh of the object's own.
Mesh& own_mesh(Scene& s, Instance& object) {
  s.meshes.push_back(Mesh(s.meshes[object.mesh]));
  object.mesh = uint32_t(s.meshes.size() - 1);
  return s.meshes.back();
}

/// By an angle about the y axis, or about x.
void turn(Instance& object, float degrees, bool about_x) {
  const float a = degrees * std::acos(-1.0f) / 180, c = std::cos(a), s = std::sin(a);
  for (int k = 0; k < 3; ++k) {
    glm::vec3& v = object.world_from_object[k];
    v = about_x ? glm::vec3(v.x, c * v.y - s * v.z, s * v.y + c * v.z)
                : glm::vec3(c * v.x + s * v.z, v.y, c * v.z - s * v.x);
  }
}

/// Indices above 65,535: as many vertices that nothing else uses come first, each a copy of one that is used.
void many_vertices(Scene& s, Pipeline&) {
  constexpr uint32_t kUnused = 65560;
  for (Mesh& mesh : s.meshes) {
    const auto prepend = [&](FloatStream& stream) {
      if (stream.empty()) return;
      std::vector<float> all(kUnused + stream.size());
      for (uint32_t i = 0; i < kUnused; ++i) all[i] = stream[(i * 7u) % stream.size()];
      for (size_t i = 0; i < stream.size(); ++i) all[kUnused + i] = stream[i];
      stream = std::move(all);
    };
    for (FloatStream& stream : mesh.position) prepend(stream);
    for (FloatStream& stream : mesh.normal) prepend(stream);
    for (FloatStream& stream : mesh.uv) prepend(stream);
    for (FloatStream& stream : mesh.color) prepend(stream);
    for (uint32_t& i : mesh.indices) i += kUnused;
  }
}

template <class Change>
Input of_matrix(Change change) {
  return [change](Scene& s, Pipeline& p, int variant) {
    const Matrix4 m = clip_from_world(s.camera, double(p.width) / p.height);
    s.camera.clip_from_world.emplace();
    for (size_t i = 0; i < 16; ++i) (*s.camera.clip_from_world)[i] = float(m[i]);
    change(*s.camera.clip_from_world, p, variant);
    return true;
  };
}

void add_objects(const std::function<Plant&(std::string_view, Names, Input, int)>& in) {
  in("an object moved", {"object-moved"}, of_object([](Instance& i, int v) {
       i.world_from_object[3] +=
           glm::vec3(pick({0.3f, -0.1f, 0.05f}, v), pick({0.2f, 0.0f}, v), pick({0.1f, -0.4f, 0.0f}, v));
     }),
     6);
  in("an object turned", {"object-turned"}, of_object([](Instance& i, int v) {
       turn(i, pick({10.0f, 30.0f, -5.0f, 2.0f}, v), v % 2 == 1);
     }),
     6);
  in("an object of another size", {"object-scaled"}, of_object([](Instance& i, int v) {
       const float f = pick({1.1f, 0.9f, 1.5f, 1.02f}, v);
       for (int k = 0; k < 3; ++k) i.world_from_object[k] *= v == 4 && k != 1 ? 1.0f : f;
     }),
     6);
  in("an object's matrix missing", {"object-matrix-missing", "object-missing"},
     of_object([](Instance& i, int) { i.world_from_object = glm::mat4x3(1.0f); }), 4);
  in(
      "an object wound the other way", {"object-wound"},
      [](Scene& s, Pipeline&, int v) {
        Mesh& mesh = own_mesh(s, object_of(s, v));
        for (size_t t = 0; t + 2 < mesh.indices.size(); t += 3) std::swap(mesh.indices[t], mesh.indices[t + 1]);
        return true;
      },
      6)
      .base = culled_back;
  in(
      "an object of another material", {"object-material"},
      [](Scene& s, Pipeline&, int v) {
        Instance& object = object_of(s, v);
        const uint32_t other = (object.material + 1) % uint32_t(s.materials.size());
        const bool differs = s.materials[other].base_color != s.materials[object.material].base_color;
        object.material = other;
        return differs;
      },
      6);
  in(
      "triangles missing", {"triangles-missing"},
      [](Scene& s, Pipeline&, int v) {
        Mesh& mesh = own_mesh(s, object_of(s, v));
        const size_t count = mesh.triangle_count(), keep = count - (v % 2 == 0 ? 2 : (count + 3) / 4);
        std::vector<uint32_t> indices(mesh.indices.begin(), mesh.indices.begin() + ptrdiff_t(3 * keep));
        mesh.indices = std::move(indices);
        return true;
      },
      8);
  in(
      "a vertex wrong", {"vertex-moved"},
      [](Scene& s, Pipeline&, int v) {
        Mesh& mesh = own_mesh(s, object_of(s, v));
        const size_t at = size_t(v) * 5 % mesh.vertex_count();
        for (size_t k = 0; k < 3; ++k) mesh.position[k][at] *= pick({1.5f, 0.0f, -0.5f}, v);
        return true;
      },
      6);
  in(
      "indices of 16 bits", {"indices-16-bits"},
      [](Scene& s, Pipeline&, int) {
        for (Mesh& mesh : s.meshes)
          for (uint32_t& i : mesh.indices) i &= 0xffff;
        return true;
      },
      1)
      .base = many_vertices;
}

void add_cameras(const std::function<Plant&(std::string_view, Names, Input, int)>& in) {
  in(
      "the camera moved", {"camera-moved"},
      [](Scene& s, Pipeline&, int v) {
        const glm::vec3 by = glm::vec3(0.1f, -0.05f, 0.2f) * pick({1.0f, 0.1f, -3.0f}, v);
        s.camera.eye += by, s.camera.target += by;
        return true;
      },
      3);
  in(
      "the eye moved", {"camera-eye"},
      [](Scene& s, Pipeline&, int v) {
        s.camera.eye += glm::vec3(0.2f, 0.1f, -0.1f) * pick({1.0f, 0.2f, -2.0f}, v);
        return true;
      },
      3);
  in(
      "the camera turned", {"camera-target", "camera-turned"},
      [](Scene& s, Pipeline&, int v) {
        s.camera.target += glm::vec3(0.3f, 0.1f, 0.0f) * pick({1.0f, 0.1f, -2.0f}, v);
        return true;
      },
      3);
  in(
      "another field of view", {"camera-angle"},
      [](Scene& s, Pipeline&, int v) {
        s.camera.fov_y_rad *= pick({1.02f, 0.9f, 1.001f, 1.2f}, v);
        return true;
      },
      4);
  in("another aspect", {"camera-aspect", "viewport-size"}, of_matrix([](std::array<float, 16>& m, Pipeline&, int v) {
       for (size_t c = 0; c < 4; ++c) m[4 * c] *= pick({0.75f, 1.01f}, v);
     }),
     2);
  in(
      "another near plane", {"camera-near"},
      [](Scene& s, Pipeline&, int v) {
        s.camera.near *= pick({0.5f, 1.1f, 10.0f}, v);
        return s.camera.near < 1;
      },
      3);
  in(
      "another far plane", {"camera-far", "depth-bias"},
      [](Scene& s, Pipeline&, int v) {
        s.camera.far *= pick({2.0f, 0.9f}, v);
        return true;
      },
      2);
  in("jitter below half a pixel", {"picture-jitter"}, of_matrix([](std::array<float, 16>& m, Pipeline& p, int v) {
       const float dx = pick({0.25f, -0.375f, 0.1f}, v), dy = pick({0.125f, 0.3f}, v);
       for (size_t c = 0; c < 4; ++c) {
         m[4 * c] += m[4 * c + 3] * 2 * dx / float(p.width);
         m[4 * c + 1] += m[4 * c + 3] * 2 * dy / float(p.height);
       }
     }),
     3);
  in("another viewport", {"viewport-size"}, of_matrix([](std::array<float, 16>&, Pipeline& p, int v) {
       p.geometry.viewport = {0, 0, p.width + (v == 0 ? 1 : v == 1 ? -8 : 0), p.height + (v == 2 ? 2 : 0)};
     }),
     3);
  in(
      "a viewport elsewhere", {"viewport-origin", "gbuffer-shift-x", "gbuffer-shift-y"},
      [](Scene&, Pipeline& p, int v) {
        p.geometry.viewport = {v == 0 ? 5 : v == 1 ? -1 : 3, v == 0 ? 0 : 2, p.width, p.height};
        return true;
      },
      3);
}

/// Planes of four samples a pixel, drawn as two by two pixels each and averaged.
void resolve_samples(const Scene& s, const Pipeline& p, oracle::Capture& c, int) {
  Pipeline fine = p;
  fine.width *= 2, fine.height *= 2;
  const oracle::Capture samples = captured(s, fine);
  for (NamedImage& plane : c.planes) {
    const Image* from = samples.plane(plane.name);
    if (from == nullptr || info(plane.image.format).number_class == NumberClass::integer) continue;
    for (int y = 0; y < p.height; ++y)
      for (int x = 0; x < p.width; ++x) {
        const uint32_t first = samples.plane("id.object")->code(2 * x, 2 * y, 0);
        bool edge = false;
        for (int i = 1; i < 4; ++i)
          edge = edge || samples.plane("id.object")->code(2 * x + i % 2, 2 * y + i / 2, 0) != first;
        for (int k = 0; edge && k < info(plane.image.format).channels; ++k) {
          double sum = 0;
          for (int i = 0; i < 4; ++i) sum += from->value(2 * x + i % 2, 2 * y + i / 2, k);
          const auto mean = float(sum / 4);
          if (plane.image.format == Format::rgba8)
            plane.image.set_code(x, y, k, uint32_t(std::lround(mean * 255)));
          else
            std::memcpy(plane.image.texel(x, y) + 4 * k, &mean, 4);
        }
      }
  }
  c.color = slipped_picture(s, p, c, LightSlip::none);
}

std::vector<Plant> made_scenes() {
  std::vector<Plant> all;
  const auto in = [&](std::string_view name, Names names, Input input, int variants) -> Plant& {
    all.push_back({name, std::move(names), "G-buffer", {"many-lights", "touchdesigner"}, variants, std::move(input)});
    return all.back();
  };
  add_objects(in), add_cameras(in);
  all.push_back({"edges as means of samples",
                 {"edges-averaged"},
                 "G-buffer",
                 {"many-lights", "touchdesigner"},
                 1,
                 nullptr,
                 resolve_samples});
  all.back().lights_again = true;
  return all;
}

}  // namespace

const std::vector<Plant>& plants_of_scenes() {
  static const std::vector<Plant> all = made_scenes();
  return all;
}

}  // namespace trueshade::testing
