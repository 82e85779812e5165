// Texts of charts: all of each is in the picture, and none covers another.
#include "cli/pages/svg_chart.h"

#include <cmath>
#include <regex>

#include "tests/catch.hpp"

namespace trueshade {
namespace {

constexpr double kLetterWidth = 7.2, kLetterHeight = 13;  // of a wide font of that size

struct Text {
  double left, right, y;
  std::string letters;
};

std::vector<Text> texts_of(const std::string& svg) {
  std::vector<Text> texts;
  const std::regex form("<text x=\"([-0-9.]+)\" y=\"([-0-9.]+)\" text-anchor=\"(\\w+)\"[^>]*>([^<]*)<");
  for (std::sregex_iterator i(svg.begin(), svg.end(), form), end; i != end; ++i) {
    const double x = std::stod((*i)[1]), width = kLetterWidth * double((*i)[4].length());
    const double left = (*i)[3] == "start" ? x : (*i)[3] == "end" ? x - width : x - width / 2;
    texts.push_back({left, left + width, std::stod((*i)[2]), (*i)[4]});
  }
  return texts;
}

double width_of(const std::string& svg) {
  std::smatch match;
  REQUIRE(std::regex_search(svg, match, std::regex("viewBox=\"0 0 (\\d+) ")));
  return std::stod(match[1]);
}

TEST_CASE("Bars leave room for the longest label and the longest text beside them") {
  for (const size_t length : {1, 20, 40, 60}) {
    const std::vector<Bar> bars = {{"a", 1.0, "1 ms"},
                                   {std::string(length, 'x'), 90.0, "90 ms, 31.0x, another picture"}};
    const std::string svg = bar_chart(bars, "ms a frame", "a chart");
    const std::vector<Text> texts = texts_of(svg);
    REQUIRE(texts.size() >= 7);  // those of both bars, the unit, and two ticks at least
    for (const Text& text : texts) {
      INFO(length << ": " << text.letters);
      CHECK(text.left >= 0.0);
      CHECK(text.right <= width_of(svg));
    }
  }
}

TEST_CASE("Whiskers reach from the least time to the upper quartile, and the text stands behind them") {
  const std::vector<Bar> bars = {{"a", 50.0, "50 ms", false, Whisker{40.0, 45.0, 100.0}}};
  const std::string svg = bar_chart(bars, "ms a frame", "a chart");
  std::smatch bar, line;
  REQUIRE(std::regex_search(svg, bar, std::regex("<rect x=\"([0-9.]+)\" y=\"[0-9.]+\" width=\"([0-9.]+)\"")));
  REQUIRE(std::regex_search(svg, line, std::regex("whisker\" d=\"M([0-9.]+) [0-9.]+ L([0-9.]+) ")));
  const double left = std::stod(bar[1]), unit = std::stod(bar[2]) / 50;
  CHECK(std::stod(line[1]) == Approx(left + 40 * unit).margin(0.1));
  CHECK(std::stod(line[2]) == Approx(left + 100 * unit).margin(0.1));
  for (const Text& text : texts_of(svg))
    if (text.letters == "50 ms") CHECK(text.left > std::stod(line[2]));
  const std::vector<ChartPoint> points = {{1, 5, "one", Whisker{4, 5, 50}}, {2, 6, "two"}};
  for (const bool logarithmic : {false, true}) {
    const std::string curve = line_chart(points, "axis", logarithmic, "a chart");
    REQUIRE(std::regex_search(curve, line, std::regex("whisker\" d=\"M[0-9.]+ ([0-9.]+) L[0-9.]+ ([0-9.]+)\"")));
    CHECK(std::stod(line[1]) > std::stod(line[2]));
    CHECK(std::stod(line[2]) == Approx(40.0));  // the top of the plot
  }
}

TEST_CASE("Labels of points that lie close together do not cover each other, and the first is there") {
  std::vector<ChartPoint> points;
  for (int i = 0; i < 12; ++i) points.push_back({1.0 + 0.01 * i, 5.0 + 0.01 * i, "label" + std::to_string(i)});
  points.push_back({3.0, 9.0, "far"});
  std::vector<Text> labels;
  for (const Text& text : texts_of(line_chart(points, "axis", false, "a chart")))
    if (text.letters.ends_with(" ms") || text.letters.starts_with("label") || text.letters == "far")
      labels.push_back(text);
  REQUIRE(labels.size() >= 4);
  CHECK(labels[0].letters == "label0");
  for (size_t i = 0; i < labels.size(); ++i)
    for (size_t k = 0; k < i; ++k) {
      INFO(labels[i].letters << " and " << labels[k].letters);
      CHECK((labels[i].left >= labels[k].right || labels[k].left >= labels[i].right ||
             std::fabs(labels[i].y - labels[k].y) >= kLetterHeight));
    }
}

}  // namespace
}  // namespace trueshade
