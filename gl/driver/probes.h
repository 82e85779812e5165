#pragma once
#include "core/format.h"

namespace trueshade::oracle {

// What a driver can do, found by doing it: neither a version nor an extension tells.

/// Whether a framebuffer with one colour attachment of this format is complete.
bool renders_to(Format format);

/// Whether fragment shaders can read gl_PrimitiveID: one that does draws, and reads 0 in the first triangle. In Mesa
/// 22.3's softpipe such a program draws no triangle.
bool counts_primitives();

}  // namespace trueshade::oracle
