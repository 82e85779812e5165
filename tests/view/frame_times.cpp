#include "view/frame_times.h"

#include "scenes/json/json_value.h"
#include "tests/catch.hpp"

namespace trueshade::viewer {
namespace {

TEST_CASE("Quantiles are values of the list: the least that so many are not above") {
  const std::vector<double> ten = {10, 9, 8, 7, 6, 5, 4, 3, 2, 1};
  CHECK(quantile(ten, 0.5) == 5.0);
  CHECK(quantile(ten, 0.95) == 10.0);
  CHECK(quantile(ten, 0.0) == 1.0);
  CHECK(quantile(ten, 1.0) == 10.0);
  CHECK(quantile({}, 0.5) == 0.0);
  CHECK(quantile({7}, 0.99) == 7.0);
}

TEST_CASE("A report counts what was shown since it was begun") {
  FrameTimes times;
  PictureTimes one;
  one[Part::interval] = 1000.0;
  times.add(one);
  times.begin(2.0);
  for (int i = 1; i <= 4; ++i) {
    one[Part::interval] = 5.0 * i;
    one[Part::draw] = i;
    times.add(one);
  }
  const json::Value value = json::parse(times.report(2.1), "report");
  const json::Node report(value, "report");
  CHECK(report.member("pictures").integer(0, 10) == 4);
  CHECK(report.member("seconds").number(0, 1) == Approx(0.05));
  CHECK(report.member("pictures_per_second").number(0, 1e6) == Approx(80.0));
  CHECK(report.member("cpu_ms_per_picture").number(0, 1e6) == Approx(25.0));
  CHECK(report.member("parts_ms").member("draw").member("median").number(0, 10) == 2.0);
  CHECK(report.member("parts_ms").member("interval").member("most").number(0, 100) == 20.0);
}

TEST_CASE("A report of nothing is a report, and graphs show no more than they have room for") {
  FrameTimes times;
  times.begin(0.0);
  CHECK_NOTHROW(json::parse(times.report(1.0), "report"));
  for (size_t i = 0; i < 2 * FrameTimes::kShown; ++i) {
    PictureTimes one;
    one[Part::draw] = double(i);
    times.add(one);
  }
  CHECK(times.shown().size() == FrameTimes::kShown);
  CHECK(times.shown().back()[Part::draw] == double(2 * FrameTimes::kShown - 1));
}

}  // namespace
}  // namespace trueshade::viewer
