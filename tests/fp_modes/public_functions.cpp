#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include "tests/catch.hpp"
#include "tests/fp_modes/fp_mode.h"
#include "tests/fp_modes/rows.h"

namespace trueshade {
namespace {

std::vector<Row> all_rows() {
  std::vector<Row> rows;
  for (const std::span<const Row> some : {rows_of_values(), rows_of_scenes(), rows_of_frames()})
    rows.insert(rows.end(), some.begin(), some.end());
  return rows;
}

std::string result_of(const Row& row) {
  Bytes bytes;
  row.call(bytes);
  return bytes.all();
}

std::string text_of_file(const std::string& name) {
  std::ifstream file(TRUESHADE_SOURCE_DIR "/" + name);
  REQUIRE(file);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::vector<std::string> installed_headers() {
  const std::string text = text_of_file("cmake/install.cmake");
  const size_t first = text.find("foreach(header"), end = text.find(')', first);
  REQUIRE(end != std::string::npos);
  std::istringstream words(text.substr(first + 14, end - first - 14));
  std::vector<std::string> headers;
  for (std::string word; words >> word;) headers.push_back(word);
  return headers;
}

/// Every name of a header that an opening parenthesis follows. Exceptions are words of C++, casts to our enumerations,
/// private members (those that end in _, offset and block), and two inline sums of measured times: geometry and sum.
std::set<std::string> functions_of(const std::string& header) {
  static const std::set<std::string> kOther{
      "for",      "if",       "return",   "switch",    "requires",       "operator", "void",     "int",
      "size_t",   "uint16_t", "uint32_t", "uint64_t",  "NumericProfile", "ImageView", "offset",  "block",
      "geometry", "sum"};
  std::string text = text_of_file(header);
  text = std::regex_replace(text, std::regex("//[^\n]*"), "");
  text = std::regex_replace(text, std::regex("\"[^\"\n]*\""), "");
  std::set<std::string> names;
  static const std::regex kName("(^|[^A-Za-z0-9_.:>~])([A-Za-z_][A-Za-z0-9_]*)\\s*\\(");
  for (std::sregex_iterator it(text.begin(), text.end(), kName), end; it != end; ++it)
    if (const std::string name = (*it)[2]; kOther.count(name) == 0 && name.back() != '_') names.insert(name);
  return names;
}

TEST_CASE("every function of an installed header has a row, and every row a function") {
  std::set<std::string> rows, functions;
  for (const Row& row : all_rows()) {
    std::istringstream names{std::string(row.functions)};
    for (std::string name; names >> name;) rows.insert(std::string(row.header) + ": " + name);
  }
  for (const std::string& header : installed_headers())
    for (const std::string& name : functions_of(header)) functions.insert(header + ": " + name);
  CHECK(functions.size() > 80);
  for (const std::string& function : functions) {
    INFO(function << " has no row in tests/fp_modes");
    CHECK(rows.count(function) == 1);
  }
  for (const std::string& row : rows) {
    INFO(row << " is in no installed header");
    CHECK(functions.count(row) == 1);
  }
}

TEST_CASE("a mode is set and read back") {
  for (const FpMode& mode : all_fp_modes()) {
    set_fp_mode(mode);
    const FpMode read = current_fp_mode();
    set_fp_mode({});
    INFO(text_of(mode));
    CHECK(read == mode);
  }
}

TEST_CASE("a public function gives the same result under every floating-point mode, and leaves the mode as it was") {
  for (const Row& row : all_rows()) {
    const std::string expected = result_of(row);
    CHECK(result_of(row) == expected);
    CHECK(expected.find("nothing was thrown") == std::string::npos);
    for (const FpMode& mode : all_fp_modes()) {
      INFO(row.header << ": " << row.functions << " under " << text_of(mode));
      CAPTURE(row.header);
      set_fp_mode(mode);
      const std::string result = result_of(row);
      const FpMode after = current_fp_mode();
      set_fp_mode({});
      CHECK((result == expected));
      CHECK((after == mode));
    }
  }
}

}  // namespace
}  // namespace trueshade
