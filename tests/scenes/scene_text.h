#pragma once
#include <string>

#include "scenes/scene.h"
#include "tests/scratch_folder.h"

namespace trueshade {

/// The scene of a text that stands in a folder alone, as s.json.
inline Scene scene_of_text(const std::string& text) {
  const ScratchFolder scratch;
  return load_scene(scratch.write("s.json", text));
}

/// What an error says, from s.json on: without the scratch folder.
inline std::string from_file_name(const std::string& message) {
  const size_t name = message.find("s.json");
  return name == std::string::npos ? message : message.substr(name);
}

}  // namespace trueshade
