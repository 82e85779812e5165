#pragma once
#include "core/format.h"

namespace trueshade::oracle {

// What a driver can do, found by doing it: neither a version nor an extension tells.

/// Whether a colour attachment of this format makes a complete framebuffer.
bool renders_to(Format format);

/// Whether a fragment shader that reads gl_PrimitiveID draws anything, and reads 0 in the first triangle. Mesa 22.3's
/// softpipe drops all triangles of such a program.
bool counts_primitives();

}  // namespace trueshade::oracle
