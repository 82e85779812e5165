#include "shading/sum/program_tile.h"

#include "core/simd/dispatch.h"

namespace trueshade {

void program_tile(const ProgramTile& in) {
  const ProgramFrame& program = *in.lights.program;
  std::shared_ptr<ProgramWork>& work = in.work.program;
  const size_t pixels = size_t(in.tile) * size_t(in.tile);
  if (work == nullptr || work->executable.get() != &program.executable() || work->surfaces.lanes() != pixels)
    work = std::make_shared<ProgramWork>(program.shared_executable(), pixels);
  kernel<program_tile>()(in);
}

}  // namespace trueshade
