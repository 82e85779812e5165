#include "cli/picture_output.h"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "cli/commands.h"
#include "cli/option_values.h"

namespace trueshade {
bool is_standard_output(const std::string& path) {
  return path == "-" || path == "-.png" || path == "-.exr" || path == "-.html";
}

std::string output_with_ending(const std::string& path) { return path == "-" ? "-.png" : path; }

void check_standard_output(const std::vector<std::string>& outputs, const std::string& prints) {
  const auto count = std::count_if(outputs.begin(), outputs.end(), is_standard_output);
  if (count > 1) throw usage("-o", "standard output takes one file", "name files for the others");
  if (count == 1 && !prints.empty())
    throw usage(prints, "standard output takes the file, and nothing else", "leave it out, or name a file for -o");
}

void check_file_output(const std::string& path) {
  std::error_code unknown;
  std::filesystem::path folder = std::filesystem::path(path).parent_path();
  if (folder.empty() || std::filesystem::exists(folder, unknown)) return check_writable(path);
  while (!folder.empty() && !std::filesystem::exists(folder, unknown)) folder = folder.parent_path();
  const bool may_be_made = std::filesystem::is_directory(folder.empty() ? "." : folder, unknown) &&
                           access(folder.empty() ? "." : folder.c_str(), W_OK | X_OK) == 0;
  if (!may_be_made) check_writable(path);  // says what is wrong
}

void make_folder_of(const std::string& path) {
  std::error_code failed;
  if (const auto folder = std::filesystem::path(path).parent_path(); !folder.empty())
    std::filesystem::create_directories(folder, failed);
}

void check_output(const std::string& path) {
  if (!is_standard_output(path)) return check_file_output(path);
  if (isatty(STDOUT_FILENO) != 0)
    throw usage("-o", "standard output is a terminal", "send it into a file or a program, or name a file");
}

void write_picture(const std::string& path, const Image& color, std::span<const NamedImage> aovs,
                   const Metadata& metadata, const ImageFileOptions& options) {
  if (!is_standard_output(path)) return write_image(path, color, aovs, metadata, options);
  for (const std::vector<uint8_t>& piece : encoded_image(path, color, aovs, metadata, options)) print_bytes(piece);
}

}  // namespace trueshade
