#pragma once
#include "judge/bounds/window.h"

namespace trueshade::oracle {

/// The least and the greatest value that an edge function may have.
struct EdgeSpan {
  double low, high;
};

/// The range of the edge function of a -> b at the sample (x, y), in pixels, over all places that a and b may have
/// (window.h, Coverage): above 0 where the sample lies to the left.
EdgeSpan edge_span(const WindowVertex& a, const WindowVertex& b, double x, double y);

}  // namespace trueshade::oracle
