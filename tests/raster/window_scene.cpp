#include "tests/raster/window_scene.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace trueshade::testing {

namespace {

std::array<float, 3> object_position(const Corner& c, Projection projection) {
  const double x = (c.x - 128) / 128, y = (c.y - 128) / 128;
  if (projection == Projection::w_is_z) return {float(x * c.w), float(y * c.w), float(c.w)};
  return {float(x), float(y), float(c.z)};
}

std::vector<std::array<float, 4>> four_floats(const Image& image) {
  std::vector<std::array<float, 4>> out;
  for (int y = image.height - 1; y >= 0; --y)
    for (int x = 0; x < image.width; ++x) {
      std::array<float, 4> texel;
      std::memcpy(texel.data(), image.texel(x, y), sizeof texel);
      out.push_back(texel);
    }
  return out;
}

template <typename T>
std::vector<T> single(const Image& image) {
  std::vector<T> out;
  for (int y = image.height - 1; y >= 0; --y)
    for (int x = 0; x < image.width; ++x) {
      T texel;
      std::memcpy(&texel, image.texel(x, y), sizeof texel);
      out.push_back(texel);
    }
  return out;
}

}  // namespace

Scene window_scene(const std::vector<Corners>& triangles, Projection projection) {
  return window_objects({triangles}, projection);
}

Scene window_objects(const std::vector<std::vector<Corners>>& objects, Projection projection) {
  Scene scene;
  scene.materials.resize(1);
  for (const std::vector<Corners>& triangles : objects) {
    Mesh mesh;
    for (const Corners& corners : triangles)
      for (const Corner& corner : corners) {
        mesh.indices.push_back(uint32_t(mesh.vertex_count()));
        const std::array<float, 3> position = object_position(corner, projection);
        for (size_t k = 0; k < 3; ++k) mesh.position[k].push_back(position[k]);
        for (size_t k = 0; k < 3; ++k) mesh.normal[k].push_back(k == 2 ? 1.0f : 0.0f);
        for (size_t k = 0; k < 2; ++k) mesh.uv[k].push_back(corner.uv[k]);
        for (size_t k = 0; k < 4; ++k) mesh.color[k].push_back(corner.color[k]);
      }
    Instance instance;
    instance.mesh = uint32_t(scene.meshes.size());
    scene.meshes.push_back(std::move(mesh));
    scene.instances.push_back(instance);
  }
  std::array<float, 16> m{};
  m[0] = m[5] = 1;
  if (projection == Projection::w_is_one) {
    m[10] = m[15] = 1;
  } else {
    m[11] = 1, m[10] = 0.5f, m[14] = -1;
  }
  scene.camera.clip_from_world = m;
  return scene;
}

ClipTriangle clip_triangle_of(const Corners& corners) {
  ClipTriangle t{};
  for (size_t i = 0; i < 3; ++i) {
    t.vertex[i][0] = float((corners[i].x - 128) / 128 * corners[i].w);
    t.vertex[i][1] = float((corners[i].y - 128) / 128 * corners[i].w);
    t.vertex[i][2] = float(corners[i].z * corners[i].w);
    t.vertex[i][3] = float(corners[i].w);
  }
  return t;
}

Pipeline window_pipeline() {
  Pipeline pipeline;
  pipeline.width = pipeline.height = kWindow;
  for (PlaneState* plane :
       {&pipeline.gbuffer.position, &pipeline.gbuffer.normal, &pipeline.gbuffer.albedo, &pipeline.gbuffer.uv})
    plane->format = Format::rgba32f;
  return pipeline;
}

int Planes::covered_count() const {
  return int(std::count_if(object.begin(), object.end(), [](uint32_t id) { return id != 0; }));
}

Planes drawn(const Scene& scene, const Pipeline& pipeline, const Execution& execution) {
  const std::string aovs[] = {"id.object", "depth", "position", "normal", "albedo", "uv"};
  const Frame frame = render_frame(PreparedScene(scene), pipeline, execution, aovs);
  Planes planes;
  planes.width = pipeline.width;
  planes.height = pipeline.height;
  planes.object = single<uint32_t>(frame.aovs.at(0).image);
  planes.depth = single<float>(frame.aovs.at(1).image);
  planes.position = four_floats(frame.aovs.at(2).image);
  planes.normal = four_floats(frame.aovs.at(3).image);
  planes.albedo = four_floats(frame.aovs.at(4).image);
  planes.uv = four_floats(frame.aovs.at(5).image);
  return planes;
}

std::vector<Execution> executions() {
  std::vector<Execution> all;
  for (const std::string_view simd : simd_targets())
    for (const int tile : {8, 48, 64}) {
      Execution execution;
      execution.simd = simd;
      execution.tile = tile;
      execution.threads = tile == 48 ? 2 : 1;
      all.push_back(execution);
    }
  return all;
}

std::string named(const Execution& execution) {
  return std::string(execution.simd) + ", tile " + std::to_string(execution.tile) + ", threads " +
         std::to_string(execution.threads);
}

}  // namespace trueshade::testing
