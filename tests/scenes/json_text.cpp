#include "expect_error.h"
#include "scenes/json/json_value.h"

namespace trueshade::json {
namespace {

std::string json_refusal(const std::string& text) {
  return error_of(ErrorKind::bad_input, [&] { parse(text, "f.json"); });
}

std::string nested(int depth) { return std::string(size_t(depth), '[') + std::string(size_t(depth), ']'); }

TEST_CASE("what is no JSON is refused with line and column") {
  CHECK_STARTS_WITH(json_refusal(""), "f.json: line 1, column 1: this is not JSON");
  CHECK_STARTS_WITH(json_refusal("{\n  \"a\": 1,\n}"), "f.json: line 3, column 1: this is not JSON");
  CHECK_STARTS_WITH(json_refusal("[1 2]"), "f.json: line 1, column 4: this is not JSON");
  CHECK_STARTS_WITH(json_refusal("[1,\n-1e999]"), "f.json: line 2, column 6: a number is too large (");
  for (const char* bad :
       {"{",     "nul",     "[1,]",     "{\"a\"}",     "01",     "1.",    "+1", "'a'",   "NaN", "Infinity", "1e999",
        "[1] 2", "// c\n1", "\"\xff\"", "\"\\ud800\"", "\"\n\"", "{a:1}", "[1", "\"abc", "-",   "\x01"})
    CHECK_STARTS_WITH(json_refusal(bad), "f.json: line ");
}

TEST_CASE("a byte order mark is refused") {
  CHECK_STARTS_WITH(json_refusal("\xEF\xBB\xBF{}"), "f.json: line 1, column 1: the text starts with a byte order mark");
}

TEST_CASE("a key given twice is refused at its pointer") {
  CHECK_STARTS_WITH(json_refusal(R"({"a": 1, "a": 2})"), "f.json: /a: this key is given twice");
  CHECK_STARTS_WITH(json_refusal(R"({"x": [0, {"b~/c": 1, "d": 2, "b~/c": 3}]})"),
                    "f.json: /x/1/b~0~1c: this key is given twice");
}

TEST_CASE("64 levels are read and 65 refused") {
  CHECK_NOTHROW(parse(nested(64), "f.json"));
  CHECK(json_refusal(nested(65)).find("nested deeper than 64") != std::string::npos);
  CHECK(json_refusal(std::string(200000, '[')).find("nested deeper than 64") != std::string::npos);
}

TEST_CASE("canonical text reads back as itself") {
  for (const char* text :
       {R"({"a":[1,2.5,-0.125,1e+30],"b":{"c":null,"d":true},"e":"x\"\\\u0001"})", "[]", "{}", "\"\""})
    CHECK(text_of(parse(text, "f.json")) == text);
}

TEST_CASE("an error is one line whatever the key") {
  const Value value = parse("{\"a\\nb\": 1}", "f.json");
  const Node root(value, "f.json");
  const std::string text = error_of(ErrorKind::bad_input, [&] { root.member("a\nb").boolean(); });
  CHECK_STARTS_WITH(text, "f.json: /a?b: found 1 (true or false)");
}

}  // namespace
}  // namespace trueshade::json
