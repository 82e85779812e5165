#pragma once
#include <optional>
#include <string>

#include "cli/options.h"
#include "cli/validation.h"
#include "compare/comparison.h"

namespace trueshade {

/// A test picture, judged by the scene and the pipeline that its reference carries.
struct JudgedPicture {
  std::optional<Validation> validation;
  std::string why_not;  ///< why there is none, in one line; empty where nobody asked, or there is no scene
};

/// Two pictures and how they differ. `comparison` points into the pictures, so this is not copied.
struct ComparedPictures {
  PictureFile reference, test;
  compare::Comparison comparison;
  PixelMask mask;
  std::string left_out_by;   ///< MaskRules::text()
  JudgedPicture judged;      ///< of pictures that fit together, are finite and are not the same
  bool is_accepted = false;  ///< the test has become the reference since

  ComparedPictures() = default;
  ComparedPictures(ComparedPictures&&) = default;
  ComparedPictures& operator=(ComparedPictures&&) = default;
};

/// Reads two pictures and compares them; judges the test where the options let it and the reference carries its scene.
/// Errors as read_any_picture() has them; Error(limit) where comparing would take more memory than the cap.
///   mask: of mask_file()
ComparedPictures compared_pictures(const std::string& reference, const std::string& test, const CompareOptions& options,
                                   const std::optional<PictureFile>& mask);

/// The picture of --mask, if it is given. Errors as read_any_picture() has them.
std::optional<PictureFile> mask_file(const CompareOptions& options);

/// How many bytes of memory FLIP takes beside the pictures, of a picture of so many pixels.
uint64_t flip_memory(uint64_t pixels);

/// Whether the test passes: by the judge if it was judged, else by the criteria.
bool passes(const ComparedPictures& pictures);

/// What two pictures are to each other, in one line: the first that people read.
std::string verdict_line(const ComparedPictures& pictures);

/// All of it, for people and as one JSON document.
std::string comparison_text(const ComparedPictures& pictures);
std::string comparison_json(const ComparedPictures& pictures);

/// Steps of a storage: a whole number, or of two storages a fraction.
std::string steps_text(double steps);

/// `mask.png: 12 of 256 pixels left out, 4.69 %`.
std::string mask_line(const ComparedPictures& pictures);

/// `16x16 at 32,48: 12 of 256 pixels differ by more than 0.1, mean error 0.01, largest 0.5`.
std::string window_line(const compare::WorstWindow& window, const compare::Comparison& comparison);

/// `PNG, 640x480, R G B unorm 8`.
std::string about_picture(const PictureFile& picture);

/// A page of HTML that needs no other file: both pictures to look into, and every figure with what it means. `command`:
/// as it was given.
std::string comparison_page(const ComparedPictures& pictures, const std::string& command);

/// Why there is nothing that write_differences() could write to a file of that name; empty if there is something.
std::string why_no_differences(const ComparedPictures& pictures, const std::string& path);

inline constexpr std::string_view kComparisonTitle = "Two pictures, compared";  ///< of such a page

/// Whether a file was written by write_differences() as a map, or holds a comparison_page().
bool is_difference_map(const std::string& path);
bool is_comparison_page(const std::string& path);

/// Writes a picture of the differences: .png the FLIP map, .exr the absolute difference of each channel that both have.
void write_differences(const ComparedPictures& pictures, const std::string& path);

}  // namespace trueshade
