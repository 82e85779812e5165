#include "shading/gl_counts.h"

#include <algorithm>

#include "scenes/pipeline/light_mesh.h"

namespace trueshade {
namespace {

int planes_read(const Pipeline& pipeline) {
  return 3 + int(reads_specular_plane(pipeline.light_model)) + int(pipeline.light_model.emission);
}

uint64_t geometry_triangles(const Scene& scene, const LightVolumes& volumes, const LightMeshes& meshes) {
  constexpr uint64_t kQuad = 2;
  uint64_t triangles = volumes.base ? kQuad : 0;
  for (const Light& light : scene.lights) {
    const LightExtent extent = drawn_extent(light, volumes);
    triangles += is_mesh(extent) ? meshes[extent].triangles() : kQuad;
  }
  return triangles;
}

uint64_t transparent_instances(const Scene& scene) {
  return uint64_t(std::count_if(scene.instances.begin(), scene.instances.end(),
                                [&](const Instance& i) { return scene.materials[i.material].transparent; }));
}

// Draws of transparent surfaces, once each, in whatever strategy.
void add_transparent(const Scene& scene, const Pipeline& pipeline, uint64_t fragments, GlCounts& c) {
  const bool into_albedo = pipeline.transparency.mode == TransparencyMode::into_albedo;
  c.draws += transparent_instances(scene);
  c.fragments_written += fragments;
  if (!into_albedo) c.material_computations += fragments * scene.lights.size();
  if (pipeline.transparency.blend.enabled)
    (into_albedo ? c.gbuffer_fragments_read : c.target_fragments_read) += fragments;
}

}  // namespace

GlCounts counted_as_gl(const Scene& scene, const Pipeline& pipeline, const LightMeshes& meshes,
                       const FrameStats& stats) {
  GlCounts c;
  const bool transparent = draws_transparent(scene, pipeline);
  const uint64_t n = stats.covered_pixels, lights = scene.lights.size();
  const uint64_t instances = scene.instances.size() - (transparent ? transparent_instances(scene) : 0);
  const uint64_t passes = std::max<uint64_t>(lights, 1);
  switch (pipeline.strategy) {
    case Strategy::forward_multipass:
      c.material_computations = c.fragments_written = n * passes;
      c.target_fragments_read = n * (passes - 1);
      c.draws = instances * passes;
      break;
    case Strategy::forward_loop:
      c.material_computations = n * lights;
      c.fragments_written = n;
      c.draws = instances;
      break;
    case Strategy::deferred_volumes:
      c.planes = planes_read(pipeline);
      c.light_pixels = c.material_computations = stats.gl.light_pixels;
      c.target_fragments_read = pipeline.blend.enabled ? c.light_pixels : 0;
      if (pipeline.light_volumes.base) c.light_pixels += n;
      c.draws = instances + lights + uint64_t(pipeline.light_volumes.base);
      c.light_triangles = geometry_triangles(scene, pipeline.light_volumes, meshes);
      break;
    case Strategy::deferred_loop:
      c.planes = planes_read(pipeline);
      c.light_pixels = n;
      c.material_computations = n * lights;
      c.draws = instances + 1;
      c.light_triangles = 2;
      break;
  }
  const auto planes = uint64_t(c.planes);
  if (!is_forward(pipeline.strategy)) {
    c.gbuffer_fragments_read = planes * c.light_pixels;
    c.fragments_written = planes * n + c.light_pixels;
  }
  if (transparent) add_transparent(scene, pipeline, stats.transparent_fragments, c);
  return c;
}

}  // namespace trueshade
