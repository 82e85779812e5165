// The numbers that state.json gives to names of the Khronos registry, held to the headers that are installed.
#include "gl/lists/api_numbers.h"

#include <cstdlib>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>

#include "gl/emit/format_words.h"
#include "tests/catch.hpp"

using namespace trueshade;
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

TEST_CASE("The names of all formats and wraps have numbers") {
  for (const ShaderApi api : {ShaderApi::gl, ShaderApi::vulkan}) {
    std::set<std::string_view> known;
    for (const ApiNumber& constant : api_numbers(api)) known.insert(constant.name);
    for (const Format format : kFormats) {
      INFO(info(format).name);
      const FormatWords words = words_of(format);
      CHECK(known.contains(api == ShaderApi::vulkan ? words.vulkan : words.gl));
      CHECK((api == ShaderApi::vulkan || (known.contains(words.channels) && known.contains(words.type))));
    }
    for (size_t i = 0; i < std::size(kWrapNames); ++i) {
      INFO(kWrapNames[i]);
      CHECK(known.contains(wrap_name(api, Wrap(i))));
    }
  }
}

TEST_CASE("Numbers of OpenGL in state.json are those of the registry") {
  check_numbers(ShaderApi::gl, TRUESHADE_EPOXY_HEADER);
}

#ifdef TRUESHADE_VULKAN_HEADER
TEST_CASE("Numbers of Vulkan in state.json are those of the registry") {
  check_numbers(ShaderApi::vulkan, TRUESHADE_VULKAN_HEADER);
}
#endif
