#include "tests/raster/drawn_alike.h"

#include <algorithm>

#include "tests/catch.hpp"

namespace trueshade::testing {

void check_executions_alike(const Scene& scene, const Pipeline& pipeline) {
  Execution plain;
  plain.simd = "scalar";
  plain.geometry_culling = false;
  const Planes expected = drawn(scene, pipeline, plain);
  for (Execution execution : executions())
    for (const bool culling : {false, true}) {
      execution.geometry_culling = culling;
      execution.shuffle_tiles = culling;
      INFO(named(execution) << ", culling " << culling << ", " << pipeline_json(pipeline));
      REQUIRE(drawn(scene, pipeline, execution) == expected);
    }
}

void check_general_alike(const Scene& scene, const Pipeline& pipeline) {
  Execution general;
  general.fast_geometry = false;
  const Planes expected = drawn(scene, pipeline, general);
  for (const Execution& execution : executions()) {
    INFO(named(execution) << ", " << pipeline_json(pipeline));
    REQUIRE(drawn(scene, pipeline, execution) == expected);
  }
}

void check_turned_alike(Random& random, Scene scene, const Pipeline& pipeline, const Execution& execution) {
  const Planes expected = drawn(scene, pipeline, execution);
  for (Mesh& mesh : scene.meshes)
    for (size_t t = 0; t < mesh.indices.size(); t += 3)
      std::rotate(mesh.indices.begin() + int64_t(t), mesh.indices.begin() + int64_t(t + 1 + random() % 2),
                  mesh.indices.begin() + int64_t(t + 3));
  INFO(named(execution) << ", " << pipeline_json(pipeline));
  REQUIRE(drawn(scene, pipeline, execution) == expected);
}

void check_moved_alike(const Scene& scene, Pipeline pipeline, const Execution& execution) {
  Viewport& viewport = pipeline.geometry.viewport;
  if (viewport.width == 0) viewport = {0, 0, pipeline.width, pipeline.height};
  const Planes here = drawn(scene, pipeline, execution);
  INFO(named(execution) << ", " << pipeline_json(pipeline));
  pipeline.width += 64, pipeline.height += 32;
  viewport.x += 64, viewport.y += 32;
  const Planes there = drawn(scene, pipeline, execution);
  for (int y = 0; y < here.height; ++y)
    for (int x = 0; x < here.width; ++x) {
      const size_t p = here.index(x, y), q = there.index(x + 64, y + 32);
      REQUIRE(here.object[p] == there.object[q]);
      REQUIRE(here.depth[p] == there.depth[q]);
      REQUIRE(here.position[p] == there.position[q]);
      REQUIRE(here.normal[p] == there.normal[q]);
      REQUIRE(here.albedo[p] == there.albedo[q]);
      REQUIRE(here.uv[p] == there.uv[q]);
    }
}

Pipeline without_flat(Pipeline pipeline) {
  GBufferState& g = pipeline.gbuffer;
  for (PlaneState* plane : {&g.position, &g.normal, &g.albedo, &g.uv})
    if (plane->interpolation == Interpolation::flat) plane->interpolation = Interpolation::smooth;
  return pipeline;
}

}  // namespace trueshade::testing
