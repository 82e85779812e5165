#pragma once
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/image_files/picture_file.h"
#include "core/pixel_mask.h"

namespace trueshade::compare {

/// Error(bad_input) of a mask or a list, not of the pictures.
class MaskError : public Error {
 public:
  MaskError(std::string_view where, std::string_view reason, std::string_view remedy)
      : Error(ErrorKind::bad_input, where, reason, remedy) {}
};

/// Pixels that are left out because a plane of identifiers holds certain numbers there.
struct IgnoredIds {
  std::string plane;                                  ///< id.object or id.material
  std::vector<std::pair<uint32_t, uint32_t>> ranges;  ///< first and last number, as the plane holds them

  bool has(uint32_t id) const;
  std::string text() const;  ///< `id.object=3,7-9`
};

/// What leaves pixels out.
struct MaskRules {
  std::string file;  ///< of the mask, as errors call it; empty: there is none
  std::vector<IgnoredIds> ignored;
  const char* leave = "add --allow-mask";  ///< how to get it, for errors
  bool allow = false;                      ///< more than kMostLeftOut may be left out

  bool any() const { return !file.empty() || !ignored.empty(); }
  std::string text() const;  ///< what leaves pixels out, for people: `mask.png, id.object=3`
};

/// Of the pixels of a picture, or of those with a surface: more are left out only by leave of MaskRules::allow, as a
/// mask that hides what it was not meant to makes a comparison pass.
inline constexpr double kMostLeftOut = 0.1;

/// The mask that a picture of one part is: pixels of 0 are left out, and those of 1 or of the largest code are looked
/// at. All its channels must say the same, but for an alpha that is the largest everywhere.
/// MaskError: another size; greys, NaN and other numbers; channels that contradict each other.
PixelMask mask_of(const PictureFile& file, int width, int height);

/// Leaves out where a channel of that name, of any part, holds one of the numbers. Returns whether there is one.
/// MaskError where it holds what is no identifier.
bool leave_out_ids(const PictureFile& picture, const IgnoredIds& ignored, PixelMask& mask);

/// MaskError: everything is left out, or more than kMostLeftOut of `all` without leave.
///   left_out: of `all`, which are `what`: `pixels`, `pixels with a surface`
void check_left_out(const MaskRules& rules, uint64_t left_out, uint64_t all, const char* what);

/// What the rules leave out of two pictures: what the mask does, and where either picture has an ignored identifier.
///   mask: the file, if there is one
PixelMask mask_of_pair(const MaskRules& rules, const PictureFile* mask, const PictureFile& reference,
                       const PictureFile& test);

}  // namespace trueshade::compare
