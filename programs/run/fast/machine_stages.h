#pragma once
#include <array>
#include <memory>
#include <mutex>

#include "programs/run/executable.h"

namespace trueshade::programs {

class ExecutableMemory;

/// Runs a stage on the blocks of a view and writes what run_code() makes of Stage::kept to CodeView::results.
using StageFunction = void (*)(const CodeView& view);

/// The stages of one program as machine code, each made when it is first asked for, for each SIMD target. Threads may
/// ask at the same time.
class MachineStages {
 public:
  MachineStages();
  ~MachineStages();

  /// nullptr where the interpreter runs the stage: stages that run seldom, targets and machines without machine code,
  /// systems that refuse executable memory, programs that are too long, and inside a MachineCodeScope that says so.
  StageFunction function(const Executable& executable, Rate rate);

 private:
  struct Made;
  std::unique_ptr<std::array<Made, 2 * kRateCount>> made_;
};

/// For its lifetime, and where `used` is false, programs are interpreted. The choice is the process's: frames that are
/// drawn at the same time share it, and no pixel depends on it.
class MachineCodeScope {
 public:
  explicit MachineCodeScope(bool used);
  ~MachineCodeScope();
  MachineCodeScope(const MachineCodeScope&) = delete;
  MachineCodeScope& operator=(const MachineCodeScope&) = delete;

 private:
  bool used_;
};

}  // namespace trueshade::programs
