#include "view/script.h"

#include <algorithm>
#include <string>
#include <utility>

#include "core/error.h"
#include "tests/catch.hpp"
#include "view/keys.h"

namespace trueshade::viewer {
namespace {

std::string error_of(const std::string& text) {
  try {
    script_from_text(text, "flight.txt");
  } catch (const Error& error) {
    CHECK(error.kind() == ErrorKind::bad_input);
    return error.what();
  }
  return "none";
}

TEST_CASE("A script is read line by line: numbers, names, the rest of a line, comments") {
  const auto steps = script_from_text(
      "# a flight\n\nkey w 0.5\r\n  camera 1 2 3  -4 5e-1 6\npreset many-lights\nview normal\nclick 400 300\n"
      "save a picture.png \nlight 3 off\nquit",
      "flight.txt");
  REQUIRE(steps.size() == 8);
  CHECK(steps[0].command == "key");
  CHECK(steps[0].words == std::vector<std::string>{"w"});
  CHECK(steps[0].numbers == std::vector<double>{0.5});
  CHECK(steps[0].line == 3);
  CHECK(steps[1].numbers == std::vector<double>{1, 2, 3, -4, 0.5, 6});
  CHECK(steps[5].words == std::vector<std::string>{"a picture.png"});
  CHECK(steps[6].numbers == std::vector<double>{3});
  CHECK(steps[6].words == std::vector<std::string>{"off"});
  CHECK(steps[7].line == 10);
}

TEST_CASE("Every key has a name that a script can hold and press, also where it is of two words") {
  for (const Key& key : keys()) {
    INFO(key.name);
    const std::string name(key.name);
    const auto steps = script_from_text("key " + name + " 0.5\npress " + name, "flight.txt");
    REQUIRE(steps.size() == 2);
    CHECK(steps[0].words == std::vector<std::string>{name});
    CHECK(steps[0].numbers == std::vector<double>{0.5});
    CHECK(steps[1].words == std::vector<std::string>{name});
  }
}

TEST_CASE("What is no script is refused with its line, in one line") {
  const std::pair<const char*, const char*> cases[] = {
      {"fly 3", "line 1: no line begins with 'fly'"},
      {"still\nkey w", "line 2: it ends too soon (key KEY SECONDS)"},
      {"key w fast", "line 1: 'fast' is no number"},
      {"key w nan", "line 1: 'nan' is no number"},
      {"key w 1e9", "line 1: 1e9 is out of range (a number from 0 to 3600)"},
      {"key nokey 1", "line 1: the key 'nokey' does nothing"},
      {"preset best", "line 1: there is no preset 'best'"},
      {"view inside-out", "line 1: there is no view 'inside-out'"},
      {"target d32f", "line 1: there is no target 'd32f'"},
      {"save picture.gif", "line 1: no format has the ending of 'picture.gif'"},
      {"screenshot window.exr", "line 1: 'window.exr' does not end in .png"},
      {"size 10.5 20", "line 1: 10.5 is out of range (a whole number from 16 to 16384)"},
      {"light -1 on", "line 1: -1 is out of range"},
      {"light 1 dim", "line 1: there is no switch 'dim'"},
      {"still now", "line 1: 'now' is too much (still)"},
      {"exposure 17", "line 1: 17 is out of range (a number from -16 to 16)"},
      {"panel lamp", "line 1: there is no panel 'lamp'"},
      {"quit\n\x01\x02\xff", "line 2: no line begins with"}};
  for (const auto& [text, expected] : cases) {
    INFO(text);
    const std::string error = error_of(text);
    CHECK(error.find("flight.txt: " + std::string(expected)) == 0);
    CHECK(error.find('\n') == std::string::npos);
  }
}

TEST_CASE("Bytes of any kind are a script or are refused") {
  uint32_t state = 7;
  const std::string_view words[] = {"key", "w",  "save", "1",    "-",     ".png", " ",
                                    "\n",  "\t", "\xff", "0x10", "light", "on",   "#"};
  for (int i = 0; i < 5000; ++i) {
    std::string text;
    for (int k = 0; k < 12; ++k) {
      state = state * 1664525u + 1013904223u;
      text += words[(state >> 16) % std::size(words)];
    }
    try {
      script_from_text(text, "x");
    } catch (const Error& error) {
      CHECK(error.kind() == ErrorKind::bad_input);
    }
  }
  CHECK(script_from_text("", "x").empty());
}

TEST_CASE("Every command of scripts and every key says what it does, and no name stands twice") {
  std::vector<std::string_view> names;
  for (const ScriptCommand& command : script_commands()) {
    CHECK_FALSE(command.about.empty());
    names.push_back(command.name);
  }
  std::sort(names.begin(), names.end());
  CHECK(std::adjacent_find(names.begin(), names.end()) == names.end());
  std::vector<std::string_view> key_names;
  for (const Key& key : keys()) {
    key_names.push_back(key.name);
    CHECK(key_named(key.name)->action == key.action);
    CHECK(key.shown.empty() == key.about.empty());
  }
  std::sort(key_names.begin(), key_names.end());
  CHECK(std::adjacent_find(key_names.begin(), key_names.end()) == key_names.end());
  CHECK(key_named("W")->action == Action::forward);
  CHECK_FALSE(key_named("X"));
}

}  // namespace
}  // namespace trueshade::viewer
