// Academy Software Foundation, "The OpenEXR File Layout".
#include "core/image_files/exr_header.h"

#include <array>
#include <bit>
#include <string_view>

#include "core/error.h"

namespace trueshade {
namespace {

constexpr size_t kShortName = 31, kMostName = 255;
constexpr uint32_t kMagic = 0x01312f76, kVersion = 2;
constexpr size_t kFlagByte = 5;  // of the file; the lower byte of the version's flags
constexpr uint8_t kTiled = 2, kLongNames = 4;
constexpr uint8_t kZip = 3;  // the number of that compression

/// The bytes of a header: attributes of a name, a type and a value each. Numbers are little-endian.
class Header {
 public:
  explicit Header(const std::string& where) : where_(where) {
    number(kMagic);
    number(kVersion);
  }

  template <typename Number>
  void number(Number value) {
    for (const uint8_t byte : std::bit_cast<std::array<uint8_t, sizeof value>>(value)) bytes_.push_back(byte);
  }
  void text(std::string_view value) { bytes_.insert(bytes_.end(), value.begin(), value.end()); }
  void name(std::string_view value) {
    if (value.empty() || value.size() > kMostName)
      throw Error(ErrorKind::usage, where_, "an EXR cannot hold the name '" + std::string(value) + "'",
                  "use 1 to 255 bytes");
    long_names_ = long_names_ || value.size() > kShortName;
    text(value);
    number(uint8_t(0));
  }
  void attribute(std::string_view key, std::string_view type, size_t bytes) {
    name(key);
    name(type);
    number(int32_t(bytes));
  }
  void string(std::string_view key, std::string_view value) {
    attribute(key, "string", value.size());
    text(value);
  }
  void box(std::string_view key, const ExrPicture& picture) {
    attribute(key, "box2i", 16);
    for (const int32_t corner : {0, 0, picture.width - 1, picture.height - 1}) number(corner);
  }
  void tiles(int side) {
    attribute("tiles", "tiledesc", 9);
    number(uint32_t(side));
    number(uint32_t(side));
    number(uint8_t(0));  // one level
    bytes_[kFlagByte] |= kTiled;
  }

  /// All of it, from the file's first byte to the zero that ends the attributes.
  std::vector<uint8_t> finish() {
    number(uint8_t(0));
    if (long_names_) bytes_[kFlagByte] |= kLongNames;
    return std::move(bytes_);
  }

 private:
  std::string where_;
  std::vector<uint8_t> bytes_;
  bool long_names_ = false;
};

void add_channels(const ExrPicture& picture, Header& header) {
  size_t bytes = 1;
  for (const auto& [name, type] : picture.channels) bytes += name.size() + 17;
  header.attribute("channels", "chlist", bytes);
  for (const auto& [name, type] : picture.channels) {
    header.name(name);
    header.number(int32_t(type));
    header.number(uint32_t(0));  // not perceptually linear, and three bytes that are reserved
    header.number(int32_t(1));   // every pixel of a row has a sample, and every row
    header.number(int32_t(1));
  }
  header.number(uint8_t(0));
}

bool holds_display_codes(Format color, const ImageFileOptions& options) {
  const FormatInfo layout = info(color);
  return options.values == PictureValues::display_codes ||
         (layout.number_class == NumberClass::unorm && !layout.srgb);  // of sRGB targets, values are linear
}

}  // namespace

std::vector<uint8_t> exr_header_bytes(const std::string& where, const ExrPicture& picture, const Metadata& metadata,
                                      const ImageFileOptions& options) {
  Header header(where);
  add_channels(picture, header);
  header.attribute("compression", "compression", 1);
  header.number(kZip);
  header.box("dataWindow", picture);
  header.box("displayWindow", picture);
  header.attribute("lineOrder", "lineOrder", 1);
  header.number(uint8_t(0));  // from the top down
  header.attribute("pixelAspectRatio", "float", 4);
  header.number(1.0f);
  header.attribute("screenWindowCenter", "v2f", 8);
  header.number(0.0f);
  header.number(0.0f);
  header.attribute("screenWindowWidth", "float", 4);
  header.number(1.0f);
  if (picture.tile != 0) header.tiles(picture.tile);
  header.string("Software", "trueshade");
  header.string("oiio:ColorSpace", holds_display_codes(picture.color, options) ? "sRGB" : "Linear");
  for (const auto& [key, value] : metadata) header.string(key, value);
  return header.finish();
}

}  // namespace trueshade
