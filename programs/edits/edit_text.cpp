#include "programs/edits/edit_text.h"

#include <bit>
#include <cstdio>

namespace trueshade::programs {

namespace {

std::string in_four_digits(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", x);
  return text;
}

}  // namespace

std::string_view source_line(std::string_view text, uint32_t line) {
  if (line == 0 || text.find('\0') != std::string_view::npos) return {};  // words of SPIR-V
  for (uint32_t i = 1; i < line; ++i) {
    const size_t end = text.find('\n');
    if (end == std::string_view::npos) return {};
    text.remove_prefix(end + 1);
  }
  text = text.substr(0, text.find_first_of("\r\n"));
  const size_t first = text.find_first_not_of(" \t"), last = text.find_last_not_of(" \t");
  return first == std::string_view::npos ? std::string_view() : text.substr(first, last - first + 1);
}

std::string words_of(const Program& program, const ProgramEdit& edit) {
  const std::string number = in_four_digits(edit.number);
  if (edit.is_parameter)
    return "the parameter `" + edit.text + "` was " + number + " times the value that is given here";
  if (!edit.fitted) return edit.text;
  if (edit.change == ProgramChange::scaled) return "has " + number + " times the value that it should have";
  const ProgramNode& node = program.nodes[edit.nodes[0]];
  const uint32_t bits = program.nodes[node.operand[edit.operand]].bits;
  return "has " + number + " where it should have " + in_four_digits(double(std::bit_cast<float>(bits)));
}

}  // namespace trueshade::programs
