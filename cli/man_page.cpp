#include "cli/man_page.h"

#include <algorithm>

#include "cli/help_text.h"
#include "cli/version.h"

namespace trueshade {
namespace {

/// With line breaks at spaces, so that no line is over 80 columns; a line that would begin like a macro does not.
std::string in_short_lines(const std::string& text) {
  constexpr size_t kLongest = 78;
  std::string out;
  size_t column = 0;
  for (size_t begin = 0; begin <= text.size();) {
    const size_t end = std::min(text.find_first_of(" \n", begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    if (column > 0 && column + 1 + word.size() > kLongest) {
      out.back() = '\n';
      column = 0;
    }
    const bool is_break = column == 0 && begin > 0 && text[begin - 1] == '\n';  // `.br` of ours
    if (column == 0 && !is_break && (word.starts_with('.') || word.starts_with('\''))) out += "\\&";
    out += word;
    column += word.size() + 1;
    if (end < text.size()) out += text[end];
    if (end < text.size() && text[end] == '\n') column = 0;
    begin = end + 1;
  }
  return out;
}

/// Text as roff reads it: hyphens that are copied with a command stay ASCII's, a backslash and a dot or quote at the
/// start of a line lose their meaning. Words between backquotes are bold.
std::string roff_line(const std::string& text) {
  std::string out;
  bool bold = false;
  for (const char c : text) {
    if (c == '`') {
      out += bold ? "\\fR" : "\\fB";
      bold = !bold;
    } else if (c == '\\') {
      out += "\\e";
    } else if (c == '-') {
      out += "\\-";
    } else if (c == '\'') {
      out += "\\(aq";
    } else if (c == '^') {
      out += "\\(ha";
    } else if (c == '~') {
      out += "\\(ti";
    } else if (c == '\n') {
      out += "\n.br\n";
    } else {
      out += c;
    }
  }
  return out;
}

std::string roff(const std::string& text) { return in_short_lines(roff_line(text)); }

std::string bold(const std::string& text) { return "\\fB" + roff_line(text) + "\\fR"; }
std::string italic(const std::string& text) { return "\\fI" + roff_line(text) + "\\fR"; }

std::string section(const std::string& name) { return ".SH " + name + '\n'; }

std::string tagged(const std::string& tag, const std::string& text) { return ".TP\n" + tag + '\n' + text + '\n'; }

std::string sentence(const std::string& text) { return roff(text.ends_with('.') ? text : text + '.'); }

std::string title(const std::string& name) {
  std::string upper = name;
  for (char& c : upper)
    if (c >= 'a' && c <= 'z') c = char(c - 32);
  return ".\\\" Made by `trueshade man` from the tables that --help is made of.\n.TH " + roff(upper) + " 1 \"" +
         kCommitDate + "\" \"trueshade " + kVersion + "\" \"User Commands\"\n.nh\n.ad l\n";
}

/// `-o, --output FILE`
std::string row_tag(const OptionRow& row) {
  std::string tag;
  if (row.is_argument()) return italic(row.names);
  for (const std::string& spelling : row.spellings()) tag += (tag.empty() ? "" : ", ") + bold(spelling);
  return row.is_switch() ? tag : tag + ' ' + italic(row.value_name);
}

std::string rows_of(const CommandTable& table, const std::string& group) {
  std::string text;
  for (const OptionRow& row : table.rows)
    if (row.group == group && !row.is_argument())
      text += tagged(row_tag(row), sentence(row.help + (row.is_required ? " (required)" : "")));
  return text;
}

std::string synopsis(const CommandTable& table) {
  std::string text = section("SYNOPSIS") + bold("trueshade " + table.name) + " [" + italic("OPTIONS") + ']';
  for (const OptionRow& row : table.rows)
    if (row.is_argument())
      text += row.is_required ? ' ' + italic(row.names) : " [" + italic(row.names) + (row.is_repeated ? " ...]" : "]");
  return text + '\n';
}

std::string exit_status() {
  std::string text = section("EXIT STATUS");
  for (const auto& [code, about] : exit_codes())
    text += tagged(bold(std::to_string(code)), sentence(std::string(about)));
  return text + ".PP\nAn error is one line on standard error, and output files appear whole or not at all.\n";
}

std::string environment_section() {
  std::string text = section("ENVIRONMENT");
  for (const auto& [name, about] : environment()) text += tagged(bold(std::string(name)), sentence(std::string(about)));
  return text;
}

std::string examples_of(const CommandTable& table) {
  std::string text;
  for (const CommandExample& example : table.examples)
    text += (text.empty() ? "" : ".PP\n") + roff(example.about) + "\n.PP\n.nf\n.RS\n" + roff_line(example.command) +
            "\n.RE\n.fi\n";
  return text;
}

std::string reference(const std::string& page) { return ".BR " + roff(page) + " (1)"; }

}  // namespace

std::string man_page_of_command(const CommandTable& table) {
  std::string text = title("trueshade-" + table.name) + section("NAME") +
                     roff("trueshade-" + table.name + " - " + table.about) + '\n' + synopsis(table);
  std::string arguments;
  for (const OptionRow& row : table.rows)
    if (row.is_argument()) arguments += tagged(row_tag(row), sentence(row.help));
  if (!arguments.empty()) text += section("ARGUMENTS") + arguments;
  text += section("OPTIONS");
  for (const std::string& group : table.groups()) text += ".SS " + roff(group) + '\n' + rows_of(table, group);
  text += ".SS Help\n" + tagged(bold("-h") + ", " + bold("--help"), "Print the options.");
  if (table.has_limits()) text += tagged(bold("--help-limits"), sentence(kHelpLimitsAbout));
  if (!table.details.empty()) text += section("NOTES") + roff(table.details) + '\n';
  text += exit_status() + environment_section();
  if (!table.examples.empty()) text += section("EXAMPLES") + examples_of(table);
  text += section("SEE ALSO") + reference("trueshade");
  for (const std::string& other : table.see_also) text += ",\n" + reference("trueshade-" + other);
  return text + '\n';
}

std::string man_page_of_program(const CommandTables& tables) {
  std::string text =
      title("trueshade") + section("NAME") +
      "trueshade \\- draw scenes of many lights on the CPU, to the same bits on every machine\n" + section("SYNOPSIS") +
      bold("trueshade") + ' ' + italic("COMMAND") + " [" + italic("OPTIONS") + "]\n.br\n" + bold("trueshade help") +
      ' ' + italic("COMMAND") + "\n.br\n" + bold("trueshade --version") + " [" + bold("--json") + "]\n" +
      section("DESCRIPTION") +
      roff(
          "A tiled SIMD rasterizer fills a G-buffer by OpenGL's rules, and a light pass lights it. No GPU, "
          "driver or display takes part, so the image can be the reference that a GPU's image is judged "
          "by. Arguments and options come in any order.") +
      '\n' + section("COMMANDS");
  for (const CommandTable& table : tables.all())
    text += tagged(reference("trueshade-" + table.name), sentence(table.about));
  text +=
      section("OPTIONS") + tagged(bold("-h") + ", " + bold("--help"), "Print the commands.") +
      tagged(bold("--help-limits"), sentence(kHelpLimitsAbout)) +
      tagged(bold("--version"), roff("Print the version, the SIMD targets and the libraries; with --json as JSON."));
  text += exit_status() + environment_section() + section("EXAMPLES") + examples_of(*tables.named("render"));
  text += section("SEE ALSO");
  std::string between;
  for (const CommandTable& table : tables.all()) {
    text += between + reference("trueshade-" + table.name);
    between = ",\n";
  }
  return text + '\n';
}

}  // namespace trueshade
