#pragma once
#include <hwy/highway.h>

#include "raster/surfaces/surface_task.h"

namespace trueshade::HWY_NAMESPACE {

/// Resolves a tile whose attributes are all smooth, by the triangles that each block of pixels sees. False, with
/// nothing done, where an attribute is not smooth or fast paths are off.
bool resolve_by_blocks(const SurfaceTask& task);

}  // namespace trueshade::HWY_NAMESPACE
