#include "shading/program/cut_lights.h"

#include <cmath>
#include <memory>

#include "core/fp_env.h"
#include "scenes/pipeline/light_mesh.h"
#include "shading/program/program_frame.h"

namespace trueshade {
namespace {

constexpr int kPlaces = 6;
static_assert(kPlaces <= int(programs::kBlockLanes));

/// White, half rough, and lit from the middle of the light's range on.
void set_place(const Light& light, int place, SurfaceTile& out) {
  const int axis = place / 2;
  const float side = place % 2 == 0 ? 1.0f : -1.0f;
  for (float* const plane : {out.plane[kAlbedo], out.plane[kAlbedo + 1], out.plane[kAlbedo + 2], out.plane[kAlbedo + 3],
                             out.plane[kOcclusion]})
    plane[place] = 1.0f;
  for (int c = 0; c < 3; ++c) {
    out.plane[kNormal + c][place] = c == axis ? -side : 0.0f;
    out.plane[kPosition + c][place] = light.position[c] + (c == axis ? side * light.range * 1.00001f : 0.0f);
    out.plane[kSpecular + c][place] = 0.5f;
  }
  out.plane[kShininess][place] = 32.0f;
}

}  // namespace

CutLights cut_lights(const Scene& scene, const Pipeline& asked) {
  const FpScope fp;
  const Pipeline pipeline = with_planes_of_program(asked);
  const CapturedFields all{true, true, {true, true, true, true}};
  const ProgramFrame program(scene, pipeline, Unlit::shows_albedo, all);
  const auto tile = std::make_unique<SurfaceTile>();
  *tile = {};
  tile->captured = std::make_unique<CapturedTile>();  // of zeros
  const uint32_t* const pixels[2] = {tile->object, tile->object};
  programs::LaneValues surfaces(program.executable().at(programs::Rate::surface), programs::kBlockLanes);
  for (size_t i = 0; i < program.executable().at(programs::Rate::surface).inputs.size(); ++i)
    surfaces.set_input(i, program.plane_of(i, *tile, pixels));
  programs::Registers registers(program.executable());
  CutLights cut;
  for (uint32_t k = 0; k < scene.lights.size(); ++k) {
    const Light& light = scene.lights[k];
    if (drawn_extent(light, pipeline.light_volumes) == LightExtent::unbounded || !std::isfinite(light.range)) continue;
    for (int place = 0; place < kPlaces; ++place) set_place(light, place, *tile);
    run_surfaces(program.executable(), program.constants(), surfaces, nullptr, registers);
    const programs::PairBlock pair{0, k};
    const programs::PairResults added =
        run_pairs(program.executable(), program.constants(), program.lights(), surfaces, {&pair, 1}, registers);
    float most = 0.0f;
    for (const float* const channel : added.light)
      for (int place = 0; place < kPlaces; ++place) most = std::max(most, std::fabs(channel[place]));
    cut.count += most > 0.0f;
    if (most > cut.added) cut.light = k, cut.added = most;
  }
  return cut;
}

}  // namespace trueshade
