#include "cli/json_text.h"

#include <limits>

#include "cli/progress_bar.h"
#include "tests/catch.hpp"

namespace trueshade {
namespace {

TEST_CASE("strings become JSON whatever bytes they hold") {
  CHECK(json_string("a\"b\\c\n\x01") == "\"a\\\"b\\\\c\\n\\u0001\"");
  CHECK(json_string("\xc3\xa4 \xe2\x82\xac \xf0\x9f\x98\x80") == "\"\xc3\xa4 \xe2\x82\xac \xf0\x9f\x98\x80\"");
  const std::string replaced = "\xef\xbf\xbd";
  CHECK(json_string("\xff") == '"' + replaced + '"');
  CHECK(json_string("\xc0\x80") == '"' + replaced + replaced + '"');                 // overlong
  CHECK(json_string("\xed\xa0\x80") == '"' + replaced + replaced + replaced + '"');  // a surrogate
  CHECK(json_string("\xe2\x82") == '"' + replaced + replaced + '"');                 // cut short
}

TEST_CASE("numbers become the shortest JSON that gives them back") {
  CHECK(json_number(0.1) == "0.1");
  CHECK(json_number(uint64_t(18446744073709551615u)) == "18446744073709551615");
  CHECK(json_number(std::numeric_limits<double>::infinity()) == "\"inf\"");
  CHECK(json_number(-std::numeric_limits<double>::infinity()) == "\"-inf\"");
  CHECK(json_number(std::numeric_limits<double>::quiet_NaN()) == "\"nan\"");
  CHECK(JsonObject().put("a", 1).put("b", true).put_raw("c", JsonArray().add_raw("1").add_raw("2").text()).text() ==
        R"({"a": 1, "b": true, "c": [1, 2]})");
}

TEST_CASE("the progress line says what is done, how fast and how long it will take") {
  CHECK(progress_line("rendering", "tiles", 50, 200, 2.0) ==
        "rendering [#######.......................]  25%  25 tiles/s  6 s left");
  CHECK(progress_line("rendering", "tiles", 0, 0, 0.0).find("0%") != std::string::npos);
}

}  // namespace
}  // namespace trueshade
