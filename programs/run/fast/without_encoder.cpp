#include "programs/run/fast/stage_compiler.h"

#ifndef TRUESHADE_XBYAK
namespace trueshade::programs {

std::vector<uint8_t> stage_code(const Executable&, Rate, SimdTarget) { return {}; }

}  // namespace trueshade::programs
#endif
