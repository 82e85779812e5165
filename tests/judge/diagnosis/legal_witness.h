#pragma once
// Whether a picture with a fault is one that a renderer without any draws: shown by such a renderer.
#include <cstdint>

#include "oracle/capture.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"

namespace trueshade::testing {

/// Pixels of the capture's picture that the likeliest of right renderers does not draw, bit for bit. It sums the lights
/// in long double over the capture's own planes, or within sixteen roundings of floats, and converts to codes by one
/// function that does not decrease and stays within 0.6 of a code (D3D11.3 functional spec, 3.2.3.6). 0: the picture is
/// legal, whatever made it.
///   Targets of codes without sRGB; lights that are summed, or added one by one without meshes. Of others all pixels.
uint64_t pixels_without_witness(const Scene& scene, const Pipeline& pipeline, const oracle::Capture& capture);

}  // namespace trueshade::testing
