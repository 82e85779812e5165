#include "core/likeliest_name.h"

#include <array>

#include "tests/catch.hpp"

namespace trueshade {
namespace {

constexpr std::array<std::string_view, 6> kNames{"render", "--preset", "--pipeline", "depth", "city", "many-lights"};

TEST_CASE("A slip of one letter, or two that changed places, is known again") {
  const auto meant = [](std::string_view name) { return likeliest_name(name, kNames); };
  CHECK(meant("rendr") == "render");
  CHECK(meant("redner") == "render");
  CHECK(meant("ctiy") == "city");
  CHECK(meant("City") == "city");
  CHECK(meant("--PRESET") == "--preset");
  CHECK(meant("-preset") == "--preset");
  CHECK(meant("manylights") == "many-lights");
  CHECK(meant("dephts") == "depth");
}

TEST_CASE("A name that is cut off is known again where it is five letters or more and begins one name alone") {
  const std::array<std::string_view, 3> options{"--max-difference", "--max-file", "--max-memory"};
  CHECK(likeliest_name("--max-diff", options) == "--max-difference");
  CHECK(likeliest_name("--max-", options).empty());
  CHECK(likeliest_name("man", kNames).empty());
  CHECK(likeliest_name("many-", kNames) == "many-lights");
}

TEST_CASE("What is near no name is not taken for one") {
  const auto meant = [](std::string_view name) { return likeliest_name(name, kNames); };
  for (const std::string_view far : {"", "x", "-", "--view", "sphere", "paint"}) {
    INFO(far);
    CHECK(meant(far).empty());
  }
  CHECK(meant(std::string(100000, 'a')).empty());
  CHECK(likeliest_name("city", {}).empty());
  CHECK(did_you_mean("paint", kNames).empty());
  CHECK(did_you_mean("rendr", kNames) == "did you mean render? ");
}

}  // namespace
}  // namespace trueshade
