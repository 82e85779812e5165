// An account as text and as JSON: numbers to the bit, whatever they are.
#include "explain/account.h"

#include <limits>

#include "tests/catch.hpp"

namespace trueshade {
namespace {

TEST_CASE("an account writes each number in the fewest digits that give it back") {
  CHECK(value_text(AccountValue(0.1f)) == "0.1");
  CHECK(value_text(AccountValue(0.1)) == "0.1");
  CHECK(value_text(AccountValue(double(0.1f))) == "0.10000000149011612");
  CHECK(value_text(AccountValue(-0.0f)) == "-0");
  CHECK(value_text(AccountValue(int64_t(-12))) == "-12");
  CHECK(value_text(AccountValue(true)) == "true");
}

TEST_CASE("an account writes integers of 128 bits whole, in JSON as strings where a double would round them") {
  const __int128 large = __int128(1'000'000'000'000'000'000) * 1'000'000'000;  // 10^27
  CHECK(value_text(AccountValue(large)) == "1000000000000000000000000000");
  CHECK(value_text(AccountValue(-large)) == "-1000000000000000000000000000");
  Account account("edge", "an edge");
  account.add("E", large, "").add("small", __int128(-7), "");
  CHECK(account_json(account) ==
        R"({"step": "edge", "title": "an edge", "values": {"E": "1000000000000000000000000000", "small": -7}})");
}

TEST_CASE("an account in JSON has the house's strings for what is not finite, and escapes names of files") {
  Account account("mesh", "a \"name\"\n</script>");
  account.add("d", std::numeric_limits<float>::infinity(), "").add("n", std::numeric_limits<double>::quiet_NaN(), "");
  account.part("inner", "").add("list", std::array{1.5f, -2.0f}, "");
  CHECK(account_json(account) ==
        R"({"step": "mesh", "title": "a \"name\"\n</script>", "values": {"d": "inf", "n": "nan"}, )"
        R"("parts": [{"step": "inner", "title": "", "values": {"list": [1.5, -2]}}]})");
}

TEST_CASE("an account as text has a line a quantity, and smaller steps indented") {
  Account account("pixel", "the pixel");
  account.add("x", int64_t(3), "column");
  account.part("light", "light 0").add("f", 0.5f, "falloff");
  CHECK(account_text(account) ==
        "the pixel\n"
        "  x          3                                         column\n"
        "\n"
        "  light 0\n"
        "    f          0.5                                       falloff\n");
}

}  // namespace
}  // namespace trueshade
