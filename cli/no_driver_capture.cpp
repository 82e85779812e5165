// Stands in for driver_capture.cpp where epoxy's headers were absent when this was built.
#include "cli/driver_capture.h"
#include "core/error.h"

namespace trueshade {

DriverFrame drawn_by_driver(std::string_view, const Scene&, const Pipeline&) {
  throw Error(ErrorKind::no_gl_driver, "OpenGL", "this build has none",
              "build with libepoxy-dev, or judge a capture with --gbuffer");
}

}  // namespace trueshade
