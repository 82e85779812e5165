#pragma once
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "scenes/pipeline.h"

namespace trueshade {

struct Size {
  int width, height;  ///< pixels
};

/// `trueshade render`. What is absent keeps the value of the layer below: preset, scene file, pipeline file.
struct RenderOptions {
  std::string scene;                  ///< a file or builtin:NAME
  std::vector<std::string> outputs;   ///< .png, .exr or .html
  std::optional<std::string> preset;  ///< the lowest layer; nothing: the first row of presets()
  std::optional<std::string> pipeline_file;
  std::optional<Size> size;
  std::optional<Format> target;
  std::optional<NumericProfile> profile;
  std::vector<std::string> aovs;  ///< planes for .exr outputs, each one of aov_names()
  std::string simd = "best";      ///< stays alive for execution.simd, see execution_of()
  Execution execution;
  bool hash = false, stats = false, json = false;
};

/// Execution of the options; borrows options.simd.
Execution execution_of(const RenderOptions& options);

/// `trueshade info`
struct InfoOptions {
  std::string file;  ///< a scene or an image
};

/// `trueshade list`
struct ListOptions {
  bool json = false;
};

/// `trueshade glsl`
struct GlslFilesOptions {
  std::string preset;  ///< name of a row
  std::string folder;  ///< made if it is not there
};

/// `--help` and `--version`: what to print.
struct PrintText {
  std::string text;
};

using Command = std::variant<RenderOptions, InfoOptions, ListOptions, GlslFilesOptions, PrintText>;

/// Reads a command line, and checks all of it that needs no file. Error(usage) naming the option; Error(limit) for a
/// size over 65,536 pixels a side.
Command command_from_arguments(int count, const char* const* arguments);

}  // namespace trueshade
