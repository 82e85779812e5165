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

/// Horizontal bars from 0, as inline SVG; a scale of their own a chart.
std::string bar_chart(std::span<const Bar> bars);

/// A line through points, both axes logarithmic where asked; labels are written under the points.
struct ChartPoint {
  double x, y;
  std::string label;
};
std::string line_chart(std::span<const ChartPoint> points, const std::string& axis, bool log_axes);

}  // namespace trueshade
