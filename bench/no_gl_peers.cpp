#include "bench/peers.h"
#include "core/error.h"

namespace trueshade {

std::span<const std::string_view> gl_design_names() { return {}; }

std::string gl_driver_here() { return {}; }

std::unique_ptr<Peers> gl_peers(const Scene&, const Pipeline&, std::span<const std::string>) {
  throw Error(ErrorKind::no_gl_driver, "--against gl", "this build has no OpenGL", "build it with libepoxy's headers");
}

}  // namespace trueshade
