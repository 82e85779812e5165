#pragma once
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "oracle/capture.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade {

/// A frame that OpenGL drew on this machine.
struct DriverFrame {
  struct Pass {
    std::string name;
    double ms = 0;  ///< in the median frame without the first, which pays for compiling; in the first if slow
  };
  oracle::Capture capture;
  int subpixel_bits = 0;  ///< GL_SUBPIXEL_BITS
  int timed_frames = 0;   ///< how many frames the median is taken of
  std::vector<Pass> passes;
  /// Draw another frame when they are called, and return how many pixels it stores otherwise than `first`, this
  /// capture: the same frame, which OpenGL requires to be equal (4.6 core, appendix A, rule 1), or one moved by whole
  /// pixels (14.2), which drivers are known to draw otherwise. repeat_changes takes a frame that `steps` has drawn, if
  /// it is equal.
  std::function<uint64_t(const oracle::Capture&first)> repeat_changes, move_changes;
  std::vector<std::string> notes;  ///< what the driver could not do, and what was done instead
  oracle::LightSteps steps;        ///< of strategies that draw light by light
  oracle::LightSteps objects;      ///< of surfaces transparent after the lights, object by object
};

/// Draws with the driver of that name (`--driver`), which the functions of the result keep open; `scene` must outlive
/// them. Throws Error(no_gl_driver) where there is none, and always in a
/// build without OpenGL. This header is all the command sees of OpenGL.
DriverFrame drawn_by_driver(std::string_view driver, const Scene& scene, const Pipeline& pipeline);

}  // namespace trueshade
