#include "programs/run/fast/machine_stages.h"

#include <atomic>

#include "core/simd/dispatch.h"
#include "programs/run/fast/executable_memory.h"
#include "programs/run/fast/stage_compiler.h"

namespace trueshade::programs {
namespace {

std::atomic<int> scopes_without{0};

}  // namespace

struct MachineStages::Made {
  std::once_flag once;
  ExecutableMemory memory;
};

MachineStages::MachineStages() : made_(std::make_unique<std::array<Made, 2 * kRateCount>>()) {}
MachineStages::~MachineStages() = default;

StageFunction MachineStages::function(const Executable& executable, Rate rate) {
  const SimdTarget target = simd_target();
  if (target != SimdTarget::avx512 && target != SimdTarget::avx2) return nullptr;
  if (scopes_without.load(std::memory_order_relaxed) > 0 || rate == Rate::constant || rate == Rate::light)
    return nullptr;
  Made& made = (*made_)[size_t(target == SimdTarget::avx2) * kRateCount + size_t(rate)];
  std::call_once(made.once, [&] {
    const std::vector<uint8_t> code = stage_code(executable, rate, target);
    if (!code.empty()) made.memory = ExecutableMemory(code);
  });
  return reinterpret_cast<StageFunction>(const_cast<void*>(made.memory.data()));
}

MachineCodeScope::MachineCodeScope(bool used) : used_(used) { scopes_without += used_ ? 0 : 1; }
MachineCodeScope::~MachineCodeScope() { scopes_without -= used_ ? 0 : 1; }

}  // namespace trueshade::programs
