#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>

#include "cli/compared_pictures.h"
#include "cli/picture_output.h"
#include "compare/error_colors.h"
#include "core/error.h"
#include "core/file_ending.h"
#include "core/image_files/image_io.h"

namespace trueshade {
namespace {

constexpr const char* kDifferenceKey = "trueshade:difference";  // of a picture's metadata

/// |reference - test| of a channel, as floats; 0 where pixels are left out.
void put_differences(const compare::PairReader& reader, const PixelMask& mask, size_t channel, Image& image) {
  const int channels = info(image.format).channels;
  const size_t pixels = size_t(image.width) * size_t(image.height);
  for (size_t i = 0; i < pixels; ++i) {
    const float difference = mask.has(i) ? 0.0f : float(reader.at(i).difference);
    std::memcpy(image.texels.data() + 4 * (i * size_t(channels) + channel), &difference, 4);
  }
}

/// R, G, B and A of the first part, and each other channel as a plane of its own.
void write_difference_exr(const ComparedPictures& pictures, const std::string& path) {
  const compare::Comparison& c = pictures.comparison;
  const compare::PartPair& part = c.pairing.parts.front();
  Image color(part.width, part.height, Format::rgba32f);
  std::vector<NamedImage> planes;
  for (const compare::PartPair& p : c.pairing.parts)
    for (const compare::ChannelPair& pair : p.channels) {
      if (p.width != part.width || p.height != part.height) continue;  // an EXR of one part has one size
      const bool is_color = compare::is_color(*pair.reference) && compare::is_color(*pair.test);
      const compare::PairReader reader(pair, c.decoding.reference && is_color, c.decoding.test && is_color);
      const size_t place = std::string_view("RGBA").find(pair.name);
      if (pair.name.size() == 1 && place != std::string_view::npos) {
        put_differences(reader, pictures.mask, place, color);
        continue;
      }
      planes.push_back({pair.name, Image(p.width, p.height, Format::d32f)});
      put_differences(reader, pictures.mask, 0, planes.back().image);
    }
  write_image(path, color, planes, {{kDifferenceKey, "absolute, test against reference"}});
}

}  // namespace

std::string why_no_differences(const ComparedPictures& pictures, const std::string& path) {
  const compare::Comparison& c = pictures.comparison;
  if (has_ending(path, ".png")) return c.flip ? "" : c.no_flip;
  return c.pairing.parts.empty() ? "no channels of the pictures fit together" : "";
}

bool is_comparison_page(const std::string& path) {
  constexpr size_t kHead = 1024;
  std::ifstream file(path, std::ios::binary);
  std::string head(kHead, '\0');
  file.read(head.data(), std::streamsize(head.size()));
  return head.find("<title>" + std::string(kComparisonTitle)) != std::string::npos;
}

bool is_difference_map(const std::string& path) {
  try {
    for (const auto& [key, value] : read_image_info(path).metadata)
      if (key == kDifferenceKey) return true;
  } catch (const Error&) {
  }
  return false;
}

void write_differences(const ComparedPictures& pictures, const std::string& path) {
  make_folder_of(path);
  if (!has_ending(path, ".png")) return write_difference_exr(pictures, path);
  const ChannelFile& part = pictures.reference.parts.front();
  write_image(path, compare::error_picture(pictures.comparison.flip->map, part.width, part.height), {},
              {{kDifferenceKey, "FLIP"}}, {PictureValues::display_codes});
}

}  // namespace trueshade
