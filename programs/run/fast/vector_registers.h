#pragma once
#include <optional>
#include <vector>

#include "programs/run/fast/stage_values.h"

namespace trueshade::programs {

/// Where the values of straight-line code are: in a vector register, in the frame, in both or no more. A register is
/// taken from the value that is read last, as L. A. Belady's rule has it (A study of replacement algorithms for a
/// virtual-storage computer, IBM Systems Journal 5 (2), 1966).
class VectorRegisters {
 public:
  VectorRegisters(const StageValues& values, int count)
      : values_(values), held_(size_t(count), kNone), in_(values.count(), -1), in_frame_(values.count(), false) {}

  int register_of(ValueId value) const { return in_[value]; }  ///< -1: in none
  bool in_frame(ValueId value) const { return in_frame_[value]; }
  void set_in_frame(ValueId value) { in_frame_[value] = true; }

  /// The register that `value` gets for what instruction `now` writes or, `loading`, first loads; a loaded value takes
  /// no register from one that this instruction reads. `evicted` is a value that must be stored before.
  int take(ValueId value, uint32_t now, bool loading, std::optional<ValueId>& evicted);
  ValueId held(int reg) const { return held_[size_t(reg)]; }
  void release(int reg) { in_[held_[size_t(reg)]] = -1, held_[size_t(reg)] = kNone; }

 private:
  const StageValues& values_;
  std::vector<ValueId> held_;  // by register
  std::vector<int> in_;        // by value
  std::vector<bool> in_frame_;
};

}  // namespace trueshade::programs
