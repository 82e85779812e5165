#include "gl/emit/shader_interface.h"

#include <algorithm>
#include <cctype>
#include <sstream>

#include "gl/emit/light_text.h"

namespace trueshade::oracle {

namespace {

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

/// How often a name occurs as a whole word outside comments.
int occurrences(std::string_view text, std::string_view name) {
  int count = 0;
  for (size_t at = text.find(name); at != std::string_view::npos; at = text.find(name, at + 1)) {
    const size_t end = at + name.size(), line = text.rfind('\n', at) + 1;  // npos + 1 is 0
    const bool alone = (at == 0 || !is_word(text[at - 1])) && (end == text.size() || !is_word(text[end]));
    if (alone && text.substr(line, at - line).find("//") == std::string_view::npos) ++count;
  }
  return count;
}

}  // namespace

Declaration declaration_of(std::string_view line) {
  Declaration out;
  const size_t semicolon = line.find(';');
  if (semicolon == std::string_view::npos || line.starts_with(' ')) return out;
  out.comment = line.substr(semicolon + 1);
  std::string words(line.substr(0, semicolon));
  if (words.find('(') != std::string::npos && !words.starts_with("layout(")) return out;
  int location = -1;
  if (words.starts_with("layout(")) {
    const size_t close = words.find(')');
    location = std::stoi(words.substr(words.find('=') + 1));
    words.erase(0, close + 1);
  }
  std::istringstream stream(words);
  std::vector<std::string> parts;
  for (std::string part; stream >> part;) parts.push_back(part);
  const auto kind = std::find_if(parts.begin(), parts.end(),
                                 [](const std::string& p) { return p == "in" || p == "out" || p == "uniform"; });
  if (kind == parts.end() || parts.end() - kind != 3) return out;
  out.kind = *kind;
  if (kind != parts.begin()) out.qualifier = parts.front();
  std::string name = parts.back();
  if (const size_t bracket = name.find('['); bracket != std::string::npos) {
    out.variable.elements = std::stoi(name.substr(bracket + 1));
    name.erase(bracket);
  }
  out.variable.name = name;
  out.variable.type = *(kind + 1);
  out.variable.location = location;
  return out;
}

ShaderInterface interface_of(std::string_view shader) {
  const std::string_view text = own_text(shader);
  ShaderInterface out;
  std::istringstream lines{std::string(text)};
  for (std::string line; std::getline(lines, line);) {
    const Declaration d = declaration_of(line);
    if (d.kind.empty() || occurrences(text, d.variable.name) < 2) continue;
    (d.kind == "in" ? out.inputs : d.kind == "out" ? out.outputs : out.uniforms).push_back(d.variable);
  }
  return out;
}

int components_of(std::string_view type) {
  if (type.starts_with("mat")) return (type[3] - '0') * (type[3] - '0');
  return type.find("vec") == std::string_view::npos ? 1 : type.back() - '0';
}

bool is_integer(std::string_view type) { return type[0] == 'u' || type[0] == 'i' || type[0] == 'b'; }

}  // namespace trueshade::oracle
