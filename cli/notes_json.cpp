#include "cli/json_text.h"
#include "cli/notes.h"

namespace trueshade {

std::string ignored_json(const Notes& notes) {
  JsonArray ignored;
  for (const IgnoredField& field : notes.ignored)
    ignored.add_raw(JsonObject()
                        .put("of", field.of)
                        .put("field", field.field)
                        .put("count", field.count)
                        .put("reason", field.reason)
                        .text());
  return ignored.text();
}

std::string lines_json(const Notes& notes) {
  JsonArray lines;
  for (const std::string& line : notes.lines) lines.add_raw(json_string(line));
  return lines.text();
}

}  // namespace trueshade
