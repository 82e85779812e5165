#pragma once
#include <span>
#include <string>

#include "core/image_files/image_io.h"

namespace trueshade {

/// The outputs `-` (a PNG), `-.png`, `-.exr` and `-.html` are standard output; a file of such a name is `./-.png`.
bool is_standard_output(const std::string& path);
/// `-` as `-.png`; any other name as it is.
std::string output_with_ending(const std::string& path);

/// Of outputs, of which standard output takes one at most. `prints`: the option that prints an answer there, or empty.
/// Error(usage).
void check_standard_output(const std::vector<std::string>& outputs, const std::string& prints);

/// check_writable() of a file, whose folder need not be there yet. Error(usage) where standard output is a terminal.
void check_output(const std::string& path);
/// The same of a name that is a file's. Error(io).
void check_file_output(const std::string& path);
/// Makes the folder of a file that is to be written; what cannot be made, writing the file will say.
void make_folder_of(const std::string& path);

/// write_image(), also to standard output. Error(io).
void write_picture(const std::string& path, const Image& color, std::span<const NamedImage> aovs,
                   const Metadata& metadata, const ImageFileOptions& options);

}  // namespace trueshade
