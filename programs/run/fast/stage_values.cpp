#include "programs/run/fast/stage_values.h"

#include <algorithm>

namespace trueshade::programs {

size_t source_count(const Instruction& one) {
  if (one.product != Product::none) return 3;
  return one.op == Op::input ? 1 : size_t(info(one.op).operands);
}

StageValues::StageValues(const Stage& stage, uint32_t parts)
    : parts_(parts), uses_(stage.code.size()), kept_(stage.code.size(), kNone) {
  std::vector<uint32_t> held(stage.registers, kNone);  // by register, the instruction whose result it holds
  for (uint32_t i = 0; i < stage.code.size(); ++i) {
    const Instruction& one = stage.code[i];
    operand_.push_back({kNone, kNone, kNone});
    for (size_t k = 0; k < source_count(one); ++k) {
      if (one.from[k].place != Place::lanes) continue;
      const uint32_t maker = held[one.from[k].slot];
      operand_[i][k] = maker;
      if (uses_[maker].empty() || uses_[maker].back() != i) uses_[maker].push_back(i);
    }
    held[one.to] = i;
  }
  for (uint32_t k = 0; k < stage.kept.size(); ++k)
    if (stage.kept_from[k].place == Place::lanes) kept_[held[stage.kept_from[k].slot]] = k;
}

ValueId StageValues::operand(uint32_t step, size_t source) const {
  const uint32_t maker = operand_[step / parts_][source];
  return maker == kNone ? kNone : maker * parts_ + step % parts_;
}

uint32_t StageValues::next_use(ValueId value, uint32_t from) const {
  const std::vector<uint32_t>& uses = uses_[value / parts_];
  const uint32_t part = value % parts_, first = from <= part ? 0 : (from - part + parts_ - 1) / parts_;
  const auto found = std::lower_bound(uses.begin(), uses.end(), first);
  return found == uses.end() ? kNone : *found * parts_ + part;
}

}  // namespace trueshade::programs
