#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <span>
#include <vector>

#include "explain/surface.h"
#include "shading/program/program_frame.h"

namespace trueshade {

/// The value of every node of a program, as 32 bits; a boolean is 0 or 1.
using NodeBits = std::vector<uint32_t>;

/// A light program at one surface, computed node by node with the renderer's own operations: a value has the bits that
/// the renderer computes, but for those of NaNs (tests/explain compares the pixels with render_frame()). Lights, view
/// and parameters are the frame's.
class ProgramAtSurface {
 public:
  /// Computes the nodes that depend on the surface alone. `pixel`: the inputs surface.pixel_x and surface.pixel_y.
  ProgramAtSurface(std::shared_ptr<const ProgramFrame> frame, const SurfacePlanes& surface, WindowPixel pixel);
  /// The same frame and surface under an edited program, which has the inputs of the frame's.
  ProgramAtSurface(const ProgramAtSurface& at, programs::Program edited);

  /// The program, which lives as long as this object.
  const programs::Program& program() const { return *program_; }
  /// Whether the surface's material is unlit: it shows its albedo, and no function of the program is run.
  bool is_unlit() const { return unlit_; }

  /// The values of all nodes for one light, by its index in the scene. Nodes that need the sum of the lights are 0.
  NodeBits at_light(size_t light) const;
  /// What light() returns for each of these lights, R, G, B: the bits of at_light(), many lights at a time.
  std::vector<std::array<float, 3>> terms(std::span<const uint32_t> lights) const;
  /// The values of all nodes once the lights are summed up. Nodes that depend on one light are 0.
  NodeBits at_sum(const std::array<float, 3>& sum) const;

  /// n outputs of the program, from `first` on, as floats.
  template <size_t n>
  std::array<float, n> output(const NodeBits& bits, programs::Output first) const {
    std::array<float, n> out;
    for (size_t k = 0; k < n; ++k) out[k] = as_float(bits[program().output[size_t(first) + k]]);
    return out;
  }
  /// What start() returns: R, G, B that the sum of the lights starts from.
  std::array<float, 3> start() const { return output<3>(of_surface_, programs::kStartOutput); }

 private:
  static float as_float(uint32_t bits);
  template <class Input>
  void compute(std::initializer_list<programs::Rate> rates, NodeBits& bits, Input input) const;
  void compute_of_surface();
  std::vector<bool> needed_by_light() const;

  std::shared_ptr<const ProgramFrame> frame_;
  std::shared_ptr<const programs::Program> program_;
  std::vector<uint32_t> place_;  ///< of each input among those of its rate
  std::vector<uint32_t> given_;  ///< the bits of each input of the frame and of the surface
  NodeBits of_surface_;          ///< constants and what depends on the surface alone
  bool unlit_;
};

}  // namespace trueshade
