#include "cli/completion_values.h"

#include "scenes/builtin/builtin.h"

namespace trueshade {

Offer offer_of(const OptionRow& row) {
  if (!row.known_values.empty()) return row.is_list ? Offer::list_of_names : Offer::names;
  if (row.value_name == "SCENE") return Offer::scenes;
  if (row.value_name == "FOLDER") return Offer::folders;
  return row.value_name == "FILE" || row.value_name == "IMAGE" ? Offer::files : Offer::nothing;
}

std::vector<std::string> scene_names() {
  std::vector<std::string> names;
  for (const BuiltinInfo& scene : builtin_scenes()) names.push_back("builtin:" + std::string(scene.name));
  return names;
}

std::string with_spaces(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

std::string single_quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + '\'';
}

}  // namespace trueshade
