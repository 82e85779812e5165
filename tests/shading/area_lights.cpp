// Frames under lights with an area: one hash whatever draws these, and pixel by pixel the integrals over the lights.
#include <cmath>
#include <glm/geometric.hpp>
#include <string>
#include <tuple>

#include "core/image_hash.h"
#include "core/simd/simd_target.h"
#include "scenes/pipeline/presets.h"
#include "shading/frame.h"
#include "tests/area_scenes.h"
#include "tests/catch.hpp"
#include "tests/programs/area_oracle.h"
#include "tests/scenes/expect_error.h"

using namespace trueshade;
using namespace trueshade::testing;

namespace {

/// In floats, so that no code hides a difference.
Pipeline drawn_by(const char* model) {
  Pipeline p = area_pipeline(model, 90, 70);
  p.target = p.gbuffer.albedo.format = p.gbuffer.normal.format = Format::rgba32f;
  return p;
}

AreaShape shape_of(const Light& l) {
  AreaShape shape;
  shape.kind = AreaShape::Kind(size_t(l.type) - size_t(LightType::sphere));
  shape.centre = glm::dvec3(l.position), shape.right = glm::dvec3(l.right), shape.up = glm::dvec3(l.up);
  shape.radius = double(l.type == LightType::tube ? l.up.x : l.right.x);
  return shape;
}

glm::dvec3 three(const Image& plane, int x, int y) {
  return {plane.value(x, y, 0), plane.value(x, y, 1), plane.value(x, y, 2)};
}

}  // namespace

TEST_CASE("Lights with an area draw one picture whatever draws it") {
  const Scene mixed = area_scene("mixed");  // borrowed
  const PreparedScene scene(mixed);
  for (const char* const model : {"area", "area-lambert"})
    for (const Strategy strategy :
         {Strategy::deferred_loop, Strategy::forward_loop, Strategy::deferred_volumes, Strategy::forward_multipass}) {
      Pipeline pipeline = drawn_by(model);
      pipeline.strategy = strategy;
      pipeline.light_volumes.point = LightExtent::sphere, pipeline.light_volumes.spot = LightExtent::cone;
      std::string first;
      for (const std::string_view target : simd_targets())
        for (const auto& [threads, tile, plain] :
             {std::tuple(1, 32, false), {3, 8, false}, {2, 64, true}, {8, 48, false}}) {
          Execution execution;
          execution.simd = target, execution.threads = threads, execution.tile = tile;
          execution.light_culling = execution.geometry_culling = !plain, execution.shuffle_tiles = plain;
          const std::string hash = image_hash(render_frame(scene, pipeline, execution).color);
          INFO(model << ", " << name_of(strategy) << ", " << target << ", " << threads << " threads, tile " << tile);
          if (first.empty()) first = hash;
          CHECK(hash == first);
        }
    }
}

TEST_CASE("Each pixel under lights with an area is Lambert's integral over them") {
  const Scene scene = area_scene("box");
  const Pipeline pipeline = drawn_by("area-lambert");
  const std::string aovs[] = {"position", "normal", "albedo", "id.object"};
  const Frame frame = render_frame(scene, pipeline, {}, aovs);
  size_t compared = 0, cut = 0;
  double worst = 0;
  for (int y = 0; y < pipeline.height; ++y)
    for (int x = 0; x < pipeline.width; ++x) {
      if (frame.aovs[3].image.value(x, y, 0) == 0) continue;
      const glm::dvec3 position = three(frame.aovs[0].image, x, y), albedo = three(frame.aovs[2].image, x, y);
      const glm::dvec3 normal = glm::normalize(three(frame.aovs[1].image, x, y));
      glm::dvec3 sum(0.0);
      for (const Light& light : scene.lights) {
        const double form = form_factor(shape_of(light), position, normal);
        sum += albedo * glm::dvec3(light.color) * form;
        const double height = glm::dot(normal, glm::dvec3(light.position) - position);
        cut += form > 0 && std::fabs(height) < 0.2;
      }
      ++compared;
      worst = std::max(worst, glm::length(three(frame.color, x, y) - sum));
    }
  CAPTURE(compared, cut, worst);
  CHECK(compared > 4000);
  CHECK(cut > 200);
  CHECK(worst < 1e-3);  // that of the tube, 1e-3 of a colour whose length is 2.3
}

TEST_CASE("Light models without lights that have an area refuse these, and say what draws them") {
  const Scene scene = area_scene("box");
  Pipeline pipeline = *preset_pipeline("many-lights");
  CHECK_STARTS_WITH(error_of(ErrorKind::bad_input, [&] { render_frame(scene, pipeline); }),
                    "many-lights: light 0 is a rectangle, and this light model has no lights with an area");
  pipeline = drawn_by("gltf");
  CHECK_STARTS_WITH(error_of(ErrorKind::bad_input, [&] { render_frame(scene, pipeline); }),
                    "gltf: light 0 is a rectangle");
}
