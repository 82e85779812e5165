#include "shading/sum/program_work.h"

namespace trueshade {

ProgramWork& program_work(const ProgramFrame& program, int tile, std::shared_ptr<ProgramWork>& kept) {
  const size_t pixels = size_t(tile) * size_t(tile);
  if (kept == nullptr || kept->executable.get() != &program.executable() || kept->surfaces.lanes() != pixels)
    kept = std::make_shared<ProgramWork>(program.shared_executable(), pixels);
  return *kept;
}

namespace {

/// The numbers of the tile's columns and rows, pixel by pixel.
void number_pixels(const SurfaceTile& surface, int tile, ProgramWork& work) {
  for (int y = 0; y < tile; ++y)
    for (int x = 0; x < tile; ++x) {
      const int i = tile_index(tile, x, y);
      work.pixel[0][i] = uint32_t(surface.x + x), work.pixel[1][i] = uint32_t(surface.y + y);
    }
}

}  // namespace

void give_surfaces(const ProgramFrame& program, const SurfaceTile& surface, int tile, float* const* start,
                   ProgramWork& work) {
  const uint32_t* const pixels[2] = {work.pixel[0], work.pixel[1]};
  const size_t inputs = program.executable().at(programs::Rate::surface).inputs.size();
  bool reads_pixels = false;
  for (size_t i = 0; i < inputs; ++i) {
    const void* const plane = program.plane_of(i, surface, pixels);
    reads_pixels = reads_pixels || plane == pixels[0] || plane == pixels[1];
    work.surfaces.set_input(i, plane);
  }
  if (reads_pixels) number_pixels(surface, tile, work);
  run_surfaces(program.executable(), program.constants(), work.surfaces, start, work.registers);
}

void finish_surfaces(const ProgramFrame& program, const SurfaceTile& surface, int tile, const LightModel& model,
                     const float* const sum[3], ProgramWork& work) {
  float* const finished[4] = {work.finished[0], work.finished[1], work.finished[2], work.finished[3]};
  run_finish(program.executable(), program.constants(), work.surfaces, sum, finished, work.registers);
  const bool albedo_alpha = takes_albedo(program, model);
  for (int i = 0; i < tile * tile; ++i) {
    const bool unlit = surface.covered[i] != 0 && program.is_unlit(surface.material[i] - 1);
    for (int c = albedo_alpha && !unlit ? 3 : 0; c < 4 && (unlit || albedo_alpha); ++c)
      finished[c][i] = surface.plane[kAlbedo + c][i];
  }
}

bool takes_albedo(const ProgramFrame& program, const LightModel& model) {
  return !program.executable().program.defines_finish && model.alpha_from_albedo;
}

}  // namespace trueshade
