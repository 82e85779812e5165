#pragma once
#include <epoxy/gl.h>

#include <chrono>

#include "gl/driver/renderer.h"

namespace trueshade::oracle {

/// Measures the wall time of passes, each until all of its work on the GPU has ended.
class PassTimer {
 public:
  explicit PassTimer(std::vector<GlPass>& passes) : passes_(passes) {
    glFinish();
    start_ = std::chrono::steady_clock::now();
  }
  void end(const char* name) {
    glFinish();
    const auto now = std::chrono::steady_clock::now();
    passes_.push_back({name, std::chrono::duration<double, std::milli>(now - start_).count()});
    start_ = now;
  }

 private:
  std::vector<GlPass>& passes_;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace trueshade::oracle
