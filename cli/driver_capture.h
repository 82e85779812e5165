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
    double ms = 0;  ///< median of the frames after the first, which pays for compiling; of the first where it took long
  };
  oracle::Capture capture;
  int subpixel_bits = 0;  ///< GL_SUBPIXEL_BITS
  int timed_frames = 0;   ///< how many the median is of
  std::vector<Pass> passes;
  /// Pixels of which something stored differs from that of `first`, this capture: in the same frame drawn again, which
  /// OpenGL rules out (4.6 core, appendix A, rule 1), and in one moved by whole pixels (14.2), which drivers are known
  /// not to keep. They draw when called, but for a repeated frame that `steps` drew meanwhile, if it is the same.
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
