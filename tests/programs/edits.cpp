// Edits of light programs as GLSL has them: which line they make of a line, and that any line can be read.
#include <algorithm>
#include <string>
#include <vector>

#include "programs/edits/edit_text.h"
#include "programs/edits/line_pieces.h"
#include "programs/edits/line_variants.h"
#include "programs/front/light_program.h"
#include "scenes/builtin/pcg32.h"
#include "tests/catch.hpp"

namespace trueshade::programs {
namespace {

/// A light whose last line but one is `line`.
std::string light_with(const std::string& line) {
  return "layout(std140) uniform Parameters { float gain; };\n"
         "vec3 light(Surface s, Light l, View v) {\n"
         "  vec3 d = l.position - s.position, n = normalize(s.normal), to = normalize(d), f = 0.5 * s.albedo.rgb;\n"
         "  float d2 = dot(d, d), nl = max(dot(n, to), 0.0), sum = 0.5;\n"
         "  " +
         line + "\n  return gain * (f + vec3(sum)) * l.color / (d2 + 1.0);\n}\n";
}
constexpr uint32_t kLine = 5;

/// The lines that the edits of a line make of it, but for edits whose number is to be found.
std::vector<std::string> lines_made_of(const std::string& line) {
  const std::string text = light_with(line);
  const Program program = program_from_glsl("of_test.glsl", text);
  std::vector<std::string> made;
  for (const ProgramEdit& edit : program_edits(program)) {
    if (edit.line != kLine || edit.fitted || edit.change == ProgramChange::other_operand) continue;
    if (const auto now = edited_line(program, text, edit)) made.push_back(*now);
  }
  return made;
}

TEST_CASE("An edit is told as the line that makes the edited program") {
  struct Row {
    const char *line, *made;
  };
  constexpr Row kRows[] = {
      {"sum += clamp(1.0 - d2 * d2, 0.0, 1.0);", "sum += clamp(1.0 - d2, 0.0, 1.0);"},
      {"sum += clamp(1.0 - d2, 0.0, 1.0);", "sum += max(1.0 - d2, 0.0);"},
      {"sum = nl * (d2 + l.range);  // a comment", "sum = nl * d2;  // a comment"},
      {"sum = nl * (d2 + l.range);", "sum = nl * (d2 - l.range);"},
      {"sum = nl / (d2 + l.range);", "sum = (d2 + l.range) / nl;"},
      {"sum = nl < 0.5 ? d2 : l.range;", "sum = d2;"},
      {"sum = max(nl, 0.5) * d2;", "sum = abs(nl) * d2;"},
      {"f = mix(vec3(0.04), s.albedo.rgb, nl);", "f = s.albedo.rgb;"},
      {"sum = dot(normalize(d + n), n);", "sum = dot(d + n, n);"},
      {"sum = length(d + n) * nl;", "sum = dot(d + n, d + n) * nl;"},
      {"sum = -nl;", "sum = nl;"},
      {"sum = (nl + d2) * nl;", "sum = sqrt(nl + d2) * nl;"},
      {"sum = pow(nl, 5.0) * d2;", "sum = nl * d2;"},
      {"sum -= nl * d2;", "sum += nl * d2;"},
  };
  for (const auto& [line, made] : kRows) {
    const std::vector<std::string> lines = lines_made_of(line);
    std::string all;
    for (const std::string& one : lines) all += "\n  " + one;
    INFO(line << all);
    CHECK(std::find(lines.begin(), lines.end(), made) != lines.end());
  }
}

TEST_CASE("A number is told in the line, and where the line makes no such program nothing is") {
  const std::string text = light_with("sum = 0.25 * nl;");
  const Program program = program_from_glsl("of_test.glsl", text);
  int told = 0, parameters = 0;
  for (ProgramEdit edit : program_edits(program)) {
    if (edit.change == ProgramChange::constant_operand && edit.line == kLine) {
      edit.number = 0.75, ++told;
      CHECK(edited_line(program, text, edit) == "sum = 0.75 * nl;");
      CHECK(words_of(program, edit) == "has 0.75 where it should have 0.25");
    }
    if (!edit.is_parameter) continue;
    ++parameters;
    CHECK(words_of(program, edit) == "the parameter `gain` was 1 times the value that is given here");
    CHECK_FALSE(edited_line(program, text, edit));
  }
  CHECK(told == 1);
  CHECK(parameters == 1);
  // Of another text than the program's nothing is said, nor of a macro's line.
  const auto edits = program_edits(program);
  CHECK_FALSE(edited_line(program, light_with("sum = fract(d2);"), edits.front()));
  CHECK_FALSE(edited_line(program, "no GLSL", edits.front()));
}

TEST_CASE("A line of a text is found by its number, without blanks") {
  CHECK(source_line("a\n\t b c \r\n\nd", 1) == "a");
  CHECK(source_line("a\n\t b c \r\n\nd", 2) == "b c");
  CHECK(source_line("a\n\t b c \r\n\nd", 3).empty());
  CHECK(source_line("a\n\t b c \r\n\nd", 4) == "d");
  CHECK(source_line("a\n\t b c \r\n\nd", 5).empty());
  CHECK(source_line("a", 0).empty());
  CHECK(source_line({"\x03\x02\x23\x07\0\n", 6}, 1).empty());  // SPIR-V
}

TEST_CASE("Pieces of any line lie in it, each within the one that it is a part of") {
  constexpr const char* kWords[] = {"a",     "max", "(",  ")",  "[",  "]",  ".", ",", ";",  "=",      "+=",    "-",
                                    "*",     "/",   "?",  ":",  "<",  "!",  "{", "}", "1",  "2.5e-3", ".5",    "return",
                                    "float", "//",  "/*", "*/", "\\", "\"", "#", "%", "\t", " ",      "0x1Fu", "&&"};
  Pcg32 random(11);
  for (int round = 0; round < 20'000; ++round) {
    std::string line;
    for (uint32_t i = random.below(30); i-- > 0;) line += kWords[random.below(uint32_t(std::size(kWords)))];
    const std::vector<Piece> pieces = pieces_of(line);
    bool is_sound = true;
    for (size_t i = 0; i < pieces.size(); ++i) {
      const Piece& piece = pieces[i];
      is_sound = is_sound && piece.begin < piece.end && piece.end <= line.size();
      for (const size_t child : piece.children)
        is_sound = is_sound && child < i && pieces[child].parent == i && pieces[child].begin >= piece.begin &&
                   pieces[child].end <= piece.end;
    }
    INFO(line);
    REQUIRE(is_sound);
  }
  CHECK(pieces_of("#define x a + b").empty());
  const std::string deep(50'000, '(');
  CHECK(pieces_of(deep).empty());
}

TEST_CASE("Names that a line assigns are found, also several of a declaration") {
  CHECK(assigned_names("const float nl = max(a, b), nv = c; x.y += 2.0; if (a == b) d = e;") ==
        std::vector<std::string>{"nl", "nv", "x.y", "d"});
}

TEST_CASE("A line of a million signs or brackets is read to where it is too deep") {
  for (const char* sign : {"-", "!", "~", "(", "f(", "a[", "- +"}) {
    std::string line;
    while (line.size() < 1'000'000) line += sign;
    CHECK(pieces_of(line + "x;").size() < 1'000'000);
  }
  std::string sum = "sum = 0.5";
  while (sum.size() < 2000) sum += " + 0.25";
  CHECK(lines_made_of(sum + ";").empty());  // too long to be written otherwise
}

}  // namespace
}  // namespace trueshade::programs
