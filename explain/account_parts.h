#pragma once
#include <string>

#include "explain/account.h"
#include "explain/explain.h"

namespace trueshade {

// Parts of a pixel's account that have files of their own.

/// Weights, attributes, maps and planes of the visible surface (account_of_surface.cpp).
Account surface_account(const ExplainedFrame& frame, const PixelFragment& fragment, const PixelSurface& surface);

/// The lights on one surface and their sum (account_of_lights.cpp).
Account lights_account(const ExplainedFrame& frame, const LightTotal& total, const std::string& key,
                       LightDetail detail);

/// GL's name of a depth function.
std::string_view depth_func_name(DepthFunc func);

}  // namespace trueshade
