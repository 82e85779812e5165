#pragma once
#include <span>
#include <string>
#include <vector>

namespace trueshade {

/// One bar of a chart: what it stands for and how long it is.
struct Bar {
  std::string label;
  double value;
  std::string text;  ///< written at its end
  bool accented = false;
};

/// Horizontal bars from 0 over an axis of `unit`, as inline SVG; a scale of their own a chart. `about` is what a reader
/// who does not see the chart is told.
std::string bar_chart(std::span<const Bar> bars, const std::string& unit, const std::string& about);

/// A line through points, both axes logarithmic where asked; labels are written under the points, and `axis` beneath
/// them says what they are.
struct ChartPoint {
  double x, y;
  std::string label;
};
std::string line_chart(std::span<const ChartPoint> points, const std::string& axis, bool log_axes,
                       const std::string& about);

}  // namespace trueshade
