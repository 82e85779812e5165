#pragma once
#include "judge/bounds/window.h"

namespace trueshade::oracle {

/// An interval of an edge function.
struct EdgeSpan {
  double low, high;
};

/// E of the edge a -> b about the sample (Coverage says what that is), as an interval.
EdgeSpan edge_span(const WindowVertex& a, const WindowVertex& b, double x, double y);

}  // namespace trueshade::oracle
