// Every kind of PNG: made here from codes by the specification, read by us, and by libpng through OpenImageIO.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <zlib.h>

#include <array>
#include <random>

#include "core/error.h"
#include "core/image_files/channel_file.h"
#include "core/image_files/image_io.h"
#include "tests/catch.hpp"
#include "tests/cli/paeth.h"
#include "tests/scratch_folder.h"

namespace trueshade {
namespace {

using Bytes = std::vector<uint8_t>;

struct PngKind {
  uint8_t color_type, bits;
  bool interlaced, transparency;
  int width, height;
};

size_t channels_of(uint8_t color_type) { return color_type == 6 ? 4 : color_type == 2 ? 3 : color_type == 4 ? 2 : 1; }

void put_word(uint32_t word, Bytes& out) {
  for (int shift = 24; shift >= 0; shift -= 8) out.push_back(uint8_t(word >> shift));
}

void put_chunk(const std::string& type, const Bytes& data, Bytes& out) {
  put_word(uint32_t(data.size()), out);
  const size_t start = out.size();
  out.insert(out.end(), type.begin(), type.end());
  out.insert(out.end(), data.begin(), data.end());
  put_word(uint32_t(crc32(0, out.data() + start, uInt(out.size() - start))), out);
}

/// A PNG and the codes of its texels, channel by channel.
struct Sample {
  Bytes file;
  std::vector<uint16_t> codes;
  std::array<std::array<uint8_t, 4>, 256> palette{};
  std::array<uint16_t, 3> key{};
};

/// One pass: every dx-th column and dy-th row; each row has another filter.
void put_pass(const PngKind& kind, const Sample& sample, int x0, int y0, int dx, int dy, Bytes& out) {
  if (x0 >= kind.width) return;
  const size_t channels = channels_of(kind.color_type), unit = std::max<size_t>(1, channels * kind.bits / 8);
  Bytes above;
  uint8_t filter = 0;
  for (int y = y0; y < kind.height; y += dy) {
    Bytes row;
    int used = 8;
    for (int x = x0; x < kind.width; x += dx)
      for (size_t c = 0; c < channels; ++c) {
        const uint16_t code = sample.codes[(size_t(y) * size_t(kind.width) + size_t(x)) * channels + c];
        if (kind.bits == 16) row.push_back(uint8_t(code >> 8));
        if (kind.bits >= 8) {
          row.push_back(uint8_t(code));
          continue;
        }
        if (used == 8) row.push_back(0), used = 0;
        used += kind.bits;
        row.back() = uint8_t(row.back() | code << (8 - used));
      }
    above.resize(row.size(), 0);
    out.push_back(filter);
    for (size_t i = 0; i < row.size(); ++i) {
      const uint8_t left = i < unit ? 0 : row[i - unit], up = above[i], corner = i < unit ? 0 : above[i - unit];
      const uint8_t guess[] = {0, left, up, uint8_t((left + up) / 2), uint8_t(paeth(left, up, corner))};
      out.push_back(uint8_t(row[i] - guess[filter]));
    }
    above = row;
    filter = uint8_t((filter + 1) % 5);
  }
}

Sample sample_of(const PngKind& kind, std::mt19937& random) {
  Sample sample;
  const unsigned largest = (1u << kind.bits) - 1;
  const size_t channels = channels_of(kind.color_type), texels = size_t(kind.width) * size_t(kind.height);
  for (size_t i = 0; i < texels * channels; ++i) sample.codes.push_back(uint16_t(random() & largest));
  Bytes header, palette, alphas, rows;
  put_word(uint32_t(kind.width), header);
  put_word(uint32_t(kind.height), header);
  header.insert(header.end(), {kind.bits, kind.color_type, 0, 0, uint8_t(kind.interlaced)});
  sample.file = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  put_chunk("IHDR", header, sample.file);
  for (unsigned i = 0; i <= largest && kind.color_type == 3; ++i) {
    for (size_t c = 0; c < 3; ++c) palette.push_back(sample.palette[i][c] = uint8_t(random()));
    sample.palette[i][3] = 255;
    if (kind.transparency && i < 3) alphas.push_back(sample.palette[i][3] = uint8_t(random()));
  }
  if (kind.color_type == 3) put_chunk("PLTE", palette, sample.file);
  for (size_t c = 0; c < channels && kind.color_type != 3 && kind.transparency; ++c) {
    sample.key[c] = sample.codes[c];  // of the first texel
    alphas.push_back(uint8_t(sample.key[c] >> 8));
    alphas.push_back(uint8_t(sample.key[c]));
  }
  if (kind.transparency) put_chunk("tRNS", alphas, sample.file);
  if (!kind.interlaced) put_pass(kind, sample, 0, 0, 1, 1, rows);
  constexpr int kPasses[7][4] = {{0, 0, 8, 8}, {4, 0, 8, 8}, {0, 4, 4, 8}, {2, 0, 4, 4},
                                 {0, 2, 2, 4}, {1, 0, 2, 2}, {0, 1, 1, 2}};
  for (const auto& p : kPasses)
    if (kind.interlaced) put_pass(kind, sample, p[0], p[1], p[2], p[3], rows);
  uLongf size = compressBound(uLong(rows.size()));
  Bytes packed(size);
  REQUIRE(compress2(packed.data(), &size, rows.data(), uLong(rows.size()), 6) == Z_OK);
  packed.resize(size);
  const auto half = packed.begin() + std::ptrdiff_t(packed.size() / 2);  // the data may stand in several chunks
  put_chunk("IDAT", {packed.begin(), half}, sample.file);
  put_chunk("IDAT", {half, packed.end()}, sample.file);
  put_chunk("IEND", {}, sample.file);
  return sample;
}

/// What a texel is by the specification: codes of 8 or 16 bits.
std::array<unsigned, 4> texel_of(const PngKind& kind, const Sample& sample, size_t index) {
  const size_t channels = channels_of(kind.color_type);
  const uint16_t* codes = sample.codes.data() + index * channels;
  if (kind.color_type == 3) {
    const auto& entry = sample.palette[codes[0]];
    return {entry[0], entry[1], entry[2], entry[3]};
  }
  const unsigned largest = (1u << kind.bits) - 1, shown = kind.bits == 16 ? 65535 : 255;
  const auto widened = [&](unsigned code) { return unsigned((uint64_t(code) * shown + largest / 2) / largest); };
  const bool color = channels >= 3, alpha = channels == 2 || channels == 4;
  bool is_key = kind.transparency;
  for (size_t c = 0; c < channels; ++c) is_key = is_key && codes[c] == sample.key[c];
  const unsigned opacity = alpha ? widened(codes[channels - 1]) : is_key ? 0 : shown;
  return {widened(codes[0]), widened(codes[color ? 1 : 0]), widened(codes[color ? 2 : 0]), opacity};
}

unsigned code_at(const Image& image, size_t index, size_t c) {
  const uint8_t* texels = image.texels.data();
  if (image.format == Format::rgba8) return texels[4 * index + c];
  return unsigned(texels[8 * index + 2 * c]) | unsigned(texels[8 * index + 2 * c + 1]) << 8;
}

/// The same file by libpng, codes of 16 bits.
std::vector<uint16_t> read_by_libpng(const Bytes& file, const PngKind& kind, size_t& channels) {
  OIIO::Filesystem::IOMemReader memory(const_cast<uint8_t*>(file.data()), file.size());
  const auto input = OIIO::ImageInput::create("png");
  OIIO::ImageSpec spec, config;
  config.attribute("oiio:UnassociatedAlpha", 1);
  REQUIRE(input->set_ioproxy(&memory));
  REQUIRE(input->open("picture.png", spec, config));
  channels = size_t(spec.nchannels);
  std::vector<uint16_t> codes(size_t(kind.width) * size_t(kind.height) * channels);
  REQUIRE(input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::UINT16, codes.data()));
  return codes;
}

/// Read as channels, there are those that the file stores: grey is Y, and an index stands for a colour.
void check_channels(const PngKind& kind, const Sample& sample) {
  const ScratchFolder folder;
  const std::string path = folder.write("picture.png", std::string(sample.file.begin(), sample.file.end()));
  const ChannelFile file = read_channel_file(path, kMostExpansion);
  const bool alpha = kind.transparency || kind.color_type >= 4;
  const std::string names =
      (kind.color_type == 0 || kind.color_type == 4 ? "Y" : "RGB") + std::string(alpha ? "A" : "");
  REQUIRE(file.channels.size() == names.size());
  size_t wrong = 0;
  for (size_t c = 0; c < names.size(); ++c) {
    CHECK(file.channels[c].name == names.substr(c, 1));
    CHECK(file.channels[c].bits == (kind.bits == 16 ? 16 : 8));
    REQUIRE(file.channels[c].words.size() == size_t(kind.width) * size_t(kind.height));
    for (size_t i = 0; i < file.channels[c].words.size(); ++i)
      wrong += file.channels[c].words[i] != texel_of(kind, sample, i)[names[c] == 'A' ? 3 : c];
  }
  CHECK(wrong == 0);
}

void check_kind(const PngKind& kind, std::mt19937& random) {
  CAPTURE(int(kind.color_type), int(kind.bits), kind.interlaced, kind.transparency, kind.width, kind.height);
  const Sample sample = sample_of(kind, random);
  const Image image = decode_image(sample.file, "picture", uint64_t(1) << 30);
  REQUIRE((image.width == kind.width && image.height == kind.height));
  REQUIRE(image.format == (kind.bits == 16 ? Format::rgba16 : Format::rgba8));
  size_t channels = 0, wrong = 0, unlike_libpng = 0;
  const std::vector<uint16_t> theirs = read_by_libpng(sample.file, kind, channels);
  for (size_t i = 0; i < size_t(kind.width) * size_t(kind.height); ++i) {
    const std::array<unsigned, 4> expected = texel_of(kind, sample, i);
    for (size_t c = 0; c < 4; ++c) wrong += code_at(image, i, c) != expected[c];
    const unsigned wide = kind.bits == 16 ? 1 : 257;
    for (size_t c = 0; c < std::min<size_t>(channels, 3); ++c)
      unlike_libpng += code_at(image, i, channels < 3 ? 0 : c) * wide != theirs[channels * i + (channels < 3 ? 0 : c)];
    if (channels % 2 == 0) unlike_libpng += code_at(image, i, 3) * wide != theirs[channels * i + channels - 1];
  }
  CHECK(wrong == 0);
  CHECK(unlike_libpng == 0);
  check_channels(kind, sample);
}

TEST_CASE("PNG of every colour type, depth, size and interlacing are what the specification and libpng say") {
  std::mt19937 random(7);
  constexpr std::pair<uint8_t, uint8_t> kKinds[] = {{0, 1}, {0, 2}, {0, 4}, {0, 8}, {0, 16}, {2, 8}, {2, 16}, {3, 1},
                                                    {3, 2}, {3, 4}, {3, 8}, {4, 8}, {4, 16}, {6, 8}, {6, 16}};
  for (const auto& [color_type, bits] : kKinds)
    for (const bool interlaced : {false, true})
      for (const bool transparency : {false, true}) {
        if (transparency && (color_type == 4 || color_type == 6)) continue;
        for (const auto& [width, height] : {std::pair(1, 1), std::pair(3, 2), std::pair(5, 9), std::pair(33, 17)})
          check_kind({color_type, bits, interlaced, transparency, width, height}, random);
      }
}

TEST_CASE("colour types and depths that PNG does not have are refused, by decoding and by info's header") {
  std::mt19937 random(8);
  const Sample good = sample_of({2, 8, false, false, 4, 4}, random);
  int refused = 0;
  for (unsigned type = 0; type < 8; ++type)
    for (unsigned bits = 0; bits <= 32; ++bits) {
      const bool known = ((type == 0 || type == 3) && (bits == 1 || bits == 2 || bits == 4)) ||
                         ((type == 0 || type == 2 || type == 3 || type == 4 || type == 6) && bits == 8) ||
                         ((type == 0 || type == 2 || type == 4 || type == 6) && bits == 16);
      Bytes file = good.file;
      file[24] = uint8_t(bits), file[25] = uint8_t(type);
      try {
        decode_image(file, "picture", 1 << 20);
      } catch (const Error& error) {
        const bool header = std::string(error.what()).find("that PNG does not know") != std::string::npos;
        CAPTURE(type, bits, error.what());
        CHECK(header == !known);
        refused += header;
      }
    }
  CHECK(refused == 8 * 33 - 15);
}

}  // namespace
}  // namespace trueshade
