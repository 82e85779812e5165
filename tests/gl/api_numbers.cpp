// The numbers that state.json gives to names of the Khronos registry, held to the headers that are installed.
#include "gl/lists/api_numbers.h"

#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "tests/catch.hpp"

using namespace trueshade::oracle;

namespace {

/// What a header says: "#define NAME NUMBER" a line, or "NAME = NUMBER," of an enumeration.
void check_numbers(ShaderApi api, const char* header) {
  std::map<std::string, std::string> values;
  std::ifstream in(header);
  for (std::string line; std::getline(in, line);) {
    std::string first, second, third;
    std::istringstream(line) >> first >> second >> third;
    values[second == "=" ? first : second] = third;
  }
  for (const ApiNumber& constant : api_numbers(api)) {
    INFO(constant.name);
    const auto found = values.find(std::string(constant.name));
    REQUIRE(found != values.end());
    CHECK(std::strtoul(found->second.c_str(), nullptr, 0) == constant.number);
  }
}

}  // namespace

TEST_CASE("Numbers of OpenGL in state.json are those of the registry") {
  check_numbers(ShaderApi::gl, TRUESHADE_EPOXY_HEADER);
}

#ifdef TRUESHADE_VULKAN_HEADER
TEST_CASE("Numbers of Vulkan in state.json are those of the registry") {
  check_numbers(ShaderApi::vulkan, TRUESHADE_VULKAN_HEADER);
}
#endif
