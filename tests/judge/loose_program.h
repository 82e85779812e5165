#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "programs/values/program.h"
#include "scenes/builtin/pcg32.h"

namespace trueshade::testing {

/// A driver that takes every liberty of GLSL's with a light program: sums in any order, products fused or not, either
/// neighbour of a result, divisions, roots, exponentials and logarithms as far off as they may be, tiny numbers
/// flushed. Of WGSL: as far off as the WebGPU CTS accepts, an ulp more, roots by inverse roots, normalize() by a
/// length.
class LooseProgram {
 public:
  LooseProgram(const programs::Program& program, Pcg32& random, bool wgsl = false)
      : program_(program), random_(random), more_(wgsl ? 1 : 0) {}

  /// The program's outputs, of inputs by name. Every call is another driver.
  std::vector<double> outputs(const std::function<double(const std::string&)>& input);

 private:
  double value(programs::NodeId id) const { return value_[id]; }
  double compute(programs::NodeId id);
  double sum(programs::NodeId id);
  void gather(programs::NodeId id, double sign, std::vector<double>& terms);
  double rounded(double x);
  double off(double x, double relative) { return rounded(x * (1 + relative * random_.between(-1, 1))); }
  double logarithm(double x);
  double exponential(double x);
  double inverse_root(double x);
  double root(double x);
  double quotient(double x, double y);
  bool normalizes(const programs::ProgramNode& node) const;

  const programs::Program& program_;
  Pcg32& random_;
  double more_;  ///< ulps, of WGSL
  std::vector<double> value_;
};

}  // namespace trueshade::testing
