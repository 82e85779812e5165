#include "programs/run/fast/vector_registers.h"

namespace trueshade::programs {

int VectorRegisters::take(ValueId value, uint32_t now, bool loading, std::optional<ValueId>& evicted) {
  size_t best = 0;
  uint32_t latest = 0;
  for (size_t k = 0; k < held_.size(); ++k) {
    const uint32_t next = held_[k] == kNone ? kNone : values_.next_use(held_[k], loading ? now : now + 1);
    if (next < latest || (loading && next == now)) continue;
    best = k, latest = next;
    if (held_[k] == kNone) break;
  }
  if (held_[best] != kNone) {
    if (!in_frame_[held_[best]] && latest != kNone) evicted = held_[best];
    release(int(best));
  }
  held_[best] = value, in_[value] = int(best);
  return int(best);
}

}  // namespace trueshade::programs
