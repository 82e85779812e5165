#include "cli/pages/svg_chart.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>
#include <vector>

#include "cli/pages/page.h"

namespace trueshade {
namespace {

constexpr int kWidth = 640, kBarHeight = 24;
constexpr double kFontSize = 13, kLetterWidth = 8.3;  // the width of a wide font, so that no text is cut off
constexpr int kPlotHeight = 244, kLeft = 56, kRight = 56, kTop = 40, kBottom = 44;
constexpr int kInset = 34;  // of the first point from the axis, so that its text covers none of the axis's

std::string text_at(double x, double y, const std::string& text, const char* anchor,
                    const char* color = "var(--text)") {
  char start[160];
  std::snprintf(start, sizeof start, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\" fill=\"%s\" font-size=\"%g\">", x,
                y, anchor, color, kFontSize);
  return start + escaped(text) + "</text>\n";
}

std::string open_svg(int width, int height, const std::string& about) {
  return "<svg viewBox=\"0 0 " + std::to_string(width) + ' ' + std::to_string(height) +
         "\" role=\"img\" width=\"100%\" aria-label=\"" + escaped(about) + "\">\n";
}

/// A line of the grid, from a point along an axis.
std::string grid_line(double x, double y, char direction, double length) {
  char line[160];
  std::snprintf(line, sizeof line, "<path d=\"M%.1f %.1f %c%.1f\" stroke=\"var(--line)\" stroke-width=\"0.5\"/>\n", x,
                y, direction, length);
  return line;
}

/// A line between two points, as whiskers are drawn.
std::string stroke(double x0, double y0, double x1, double y1) {
  char line[160];
  std::snprintf(line, sizeof line,
                "<path class=\"whisker\" d=\"M%.1f %.1f L%.1f %.1f\" stroke=\"var(--text)\" stroke-width=\"1.2\"/>\n",
                x0, y0, x1, y1);
  return line;
}

std::string tick_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

double width_of(const std::string& text) { return kLetterWidth * double(text.size()); }

/// Texts of a chart, each written where it covers none that is written already.
class Labels {
 public:
  void add(double x, double y, const std::string& text, const char* color) {
    const Box box{x - width_of(text) / 2 - 3, x + width_of(text) / 2 + 3, y};
    for (const Box& other : written_)
      if (box.left < other.right && other.left < box.right && std::fabs(box.y - other.y) < kFontSize) return;
    written_.push_back(box);
    svg_ += text_at(x, y, text, "middle", color);
  }
  const std::string& svg() const { return svg_; }

 private:
  struct Box {
    double left, right, y;
  };
  std::vector<Box> written_;
  std::string svg_;
};

std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, value >= 100 ? "%.0f" : value >= 10 ? "%.1f" : "%.2f", value);
  return text;
}

/// An axis from the least to the most of some values, in units of 0 to 1.
struct Axis {
  double low, high;
  bool logarithmic;
  double at(double value) const {
    if (!(high > low)) return 0.5;
    return logarithmic ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
  }
};

/// Values to mark on an axis of milliseconds: 1, 2 and 5 times powers of ten, at most seven of them.
std::vector<double> ticks_of(const Axis& axis) {
  std::vector<double> ticks;
  const double least = axis.logarithmic ? axis.low : axis.high / 6;
  for (double power = std::pow(10.0, std::floor(std::log10(least))); power <= axis.high; power *= 10)
    for (const double digit : {1.0, 2.0, 5.0}) {
      const double step = digit * power;
      if (axis.logarithmic && step >= axis.low && step <= axis.high) ticks.push_back(step);
      if (!axis.logarithmic && ticks.empty() && step >= least)
        for (double value = 0; value <= axis.high; value += step) ticks.push_back(value);
    }
  while (ticks.size() > 7) {  // every third: powers of ten alone
    std::vector<double> fewer;
    for (size_t i = 0; i < ticks.size(); i += 3) fewer.push_back(ticks[i]);
    ticks = std::move(fewer);
  }
  return ticks;
}

}  // namespace

std::string bar_chart(std::span<const Bar> bars, const std::string& unit, const std::string& about) {
  double most = 0.0, labels = 0.0, texts = 0.0;
  for (const Bar& bar : bars) {
    most = std::max({most, bar.value, bar.whisker ? bar.whisker->upper : 0.0});
    labels = std::max(labels, width_of(bar.label)), texts = std::max(texts, width_of(bar.text));
  }
  const double left = labels + 10, room = std::max(kWidth - left - texts - 10, kWidth * 0.1);
  const double width = std::max(double(kWidth), left + room + texts + 10);
  const double bottom = kBarHeight * double(bars.size()) + 4, axis_height = 36;
  std::string svg = open_svg(int(width), int(bottom + axis_height), about);
  Labels ticks;
  for (const double value : ticks_of({0.0, most, false})) {
    const double x = left + (most > 0 ? value / most * room : 0.0);
    svg += grid_line(x, 0, 'v', bottom);
    ticks.add(x, bottom + 14, tick_text(value), "var(--quiet)");
  }
  svg += ticks.svg() + text_at(left + room / 2, bottom + 31, unit, "middle", "var(--quiet)");
  for (size_t i = 0; i < bars.size(); ++i) {
    const double y = kBarHeight * double(i) + 4;
    const double length = most > 0 ? std::max(1.0, bars[i].value / most * room) : 1.0;
    char rect[200];
    std::snprintf(rect, sizeof rect,
                  "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%d\" rx=\"3\" fill=\"%s\"/>\n", left, y, length,
                  kBarHeight - 6, bars[i].accented ? "var(--accent)" : "var(--bar)");
    svg += rect;
    double end = left + length;
    if (bars[i].whisker && most > 0) {
      const auto x = [&](double value) { return left + value / most * room; };
      const Whisker& w = *bars[i].whisker;
      const double middle = y + (kBarHeight - 6) / 2.0;
      svg += stroke(x(w.least), middle, x(w.upper), middle);
      for (const auto& [value, half] : {std::pair{w.least, 3.0}, {w.lower, 5.0}, {w.upper, 5.0}})
        svg += stroke(x(value), middle - half, x(value), middle + half);
      end = std::max(end, x(w.upper));
    }
    svg += text_at(left - 8, y + 13, bars[i].label, "end") +
           text_at(end + 6, y + 13, bars[i].text, "start", "var(--quiet)");
  }
  return svg + "</svg>\n";
}

std::string line_chart(std::span<const ChartPoint> points, const std::string& axis, bool log_axes,
                       const std::string& about) {
  if (points.empty()) return {};
  Axis x{points[0].x, points[0].x, log_axes}, y{log_axes ? points[0].y : 0.0, points[0].y, log_axes};
  for (const ChartPoint& p : points) {
    x.low = std::min(x.low, p.x), x.high = std::max(x.high, p.x);
    const Whisker w = p.whisker.value_or(Whisker{p.y, p.y, p.y});
    y.low = std::min({y.low, p.y, log_axes ? w.least : y.low}), y.high = std::max({y.high, p.y, w.upper});
  }
  const double room_x = kWidth - kLeft - kRight, room_y = kPlotHeight - kTop - kBottom;
  std::string svg = open_svg(kWidth, kPlotHeight, about), path, marks;
  Labels labels;
  for (const ChartPoint& p : points) {
    const double px = kLeft + kInset + x.at(p.x) * (room_x - kInset), py = kTop + (1 - y.at(p.y)) * room_y;
    char mark[160];
    std::snprintf(mark, sizeof mark, "%s%.1f %.1f", path.empty() ? "M" : " L", px, py);
    path += mark;
    std::snprintf(mark, sizeof mark, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3.5\" fill=\"var(--accent)\"/>\n", px, py);
    marks += mark;
    double top = py;
    if (p.whisker) {
      const auto at = [&](double value) { return kTop + (1 - y.at(value)) * room_y; };
      const Whisker& w = *p.whisker;
      marks += stroke(px, at(w.least), px, at(w.upper));
      for (const auto& [value, half] : {std::pair{w.least, 3.0}, {w.lower, 5.0}, {w.upper, 5.0}})
        marks += stroke(px - half, at(value), px + half, at(value));
      top = std::min(top, at(w.upper));
    }
    labels.add(px, kPlotHeight - kBottom + 18, p.label, "var(--text)");
    labels.add(px, top - 8, short_number(p.y) + " ms", "var(--quiet)");
  }
  char frame[200];
  std::snprintf(frame, sizeof frame, "<path d=\"M%d %d V%d H%d\" fill=\"none\" stroke=\"var(--line)\"/>\n", kLeft,
                kTop - 16, kPlotHeight - kBottom + 4, kWidth - kRight);
  svg += frame;
  for (const double value : ticks_of(y)) {
    const double py = kTop + (1 - y.at(value)) * room_y;
    svg += grid_line(kLeft, py, 'h', room_x) + text_at(kLeft - 6, py + 4, tick_text(value), "end", "var(--quiet)");
  }
  svg += text_at(4, 14, "ms a frame", "start", "var(--quiet)");
  svg +=
      "<path d=\"" + path + "\" fill=\"none\" stroke=\"var(--accent)\" stroke-width=\"2\"/>\n" + marks + labels.svg();
  return svg + text_at(kLeft + room_x / 2, kPlotHeight - 8, axis, "middle", "var(--quiet)") + "</svg>\n";
}

}  // namespace trueshade
