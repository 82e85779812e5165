#pragma once
#include <string>
#include <vector>

#include "core/image_files/image_io.h"
#include "scenes/pipeline/ignored_fields.h"

namespace trueshade {

/// What a picture does not show although its maker may expect it. Notes change no exit code and no pixel.
struct Notes {
  std::vector<IgnoredField> ignored;
  std::vector<std::string> lines;  ///< every note as one line of full sentences
};

/// Notes that scene and pipeline call for before anything is drawn.
Notes notes_of(const Scene& scene, const Pipeline& pipeline);

/// Writes lines to standard error, each as `trueshade: note: ...`.
void say_notes(const std::vector<std::string>& lines);

/// The ignored fields as an array of {of, field, count, reason}, and the lines as an array of strings.
std::string ignored_json(const Notes& notes);
std::string lines_json(const Notes& notes);

/// Whether metadata say so.
bool is_lenient(const Metadata& metadata);

}  // namespace trueshade
