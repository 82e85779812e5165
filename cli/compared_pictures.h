#pragma once
#include <string>
#include <vector>

#include "cli/options.h"
#include "compare/comparison.h"

namespace trueshade {

/// Two pictures and how they differ. `comparison` points into the pictures, so this is not copied.
struct ComparedPictures {
  PictureFile reference, test;
  compare::Comparison comparison;

  ComparedPictures() = default;
  ComparedPictures(ComparedPictures&&) = default;
  ComparedPictures& operator=(ComparedPictures&&) = default;
};

/// Reads two pictures and compares them. Errors as read_picture_file() has them; Error(limit) where comparing would take
/// more memory than the cap.
ComparedPictures compared_pictures(const std::string& reference, const std::string& test,
                                   const CompareOptions& options);

/// How many bytes of memory FLIP takes beside the pictures, of a picture of so many pixels.
uint64_t flip_memory(uint64_t pixels);

/// What two pictures are to each other, in one line: the first that people read.
std::string verdict_line(const compare::Comparison& comparison);

/// All of it, for people and as one JSON document.
std::string comparison_text(const ComparedPictures& pictures);
std::string comparison_json(const ComparedPictures& pictures);

/// `PNG, 640x480, R G B unorm 8`.
std::string about_picture(const PictureFile& picture);

/// Writes a picture of the differences: .png the FLIP map, .exr the absolute difference of each channel that both have.
/// Error(bad_input) where there is none.
void write_differences(const ComparedPictures& pictures, const std::string& path);

}  // namespace trueshade
