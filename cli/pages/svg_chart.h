#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace trueshade {

/// What was measured beside a value: drawn as a line from the least to the upper quartile, with an end at each of the
/// three.
struct Whisker {
  double least, lower, upper;
};

/// One bar of a chart: what it stands for and how long it is.
struct Bar {
  std::string label;
  double value;
  std::string text;  ///< written at its end
  bool accented = false;
  std::optional<Whisker> whisker = {};
};

/// Horizontal bars from 0 over an axis of `unit`, as inline SVG; a scale of their own a chart. `about` is what a reader
/// who does not see the chart is told.
std::string bar_chart(std::span<const Bar> bars, const std::string& unit, const std::string& about);

/// A line through points, both axes logarithmic where asked; labels are written under the points, and `axis` beneath
/// them says what they are.
struct ChartPoint {
  double x, y;
  std::string label;
  std::optional<Whisker> whisker = {};
};
std::string line_chart(std::span<const ChartPoint> points, const std::string& axis, bool log_axes,
                       const std::string& about);

}  // namespace trueshade
