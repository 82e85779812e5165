#include "shading/sum/program_tile.h"

#include "core/simd/dispatch.h"

namespace trueshade {

void program_tile(const ProgramTile& in) {
  program_work(*in.lights.program, in.tile, in.work.program);
  kernel<program_tile>()(in);
}

}  // namespace trueshade
