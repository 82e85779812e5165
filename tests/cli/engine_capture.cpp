#include "tests/cli/engine_capture.h"

#include <OpenImageIO/imageio.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>

#include "core/half.h"
#include "tests/catch.hpp"

namespace trueshade {
namespace {

void append(std::string& bytes, uint64_t word, size_t count, bool big_endian = false) {
  for (size_t k = 0; k < count; ++k) bytes += char(word >> (8 * (big_endian ? count - 1 - k : k)) & 0xff);
}

void save(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary).write(bytes.data(), std::streamsize(bytes.size()));
}

/// A value in a type such as f4 or u1, which has to hold it; u1 and u2 hold it as codes of [0, 1] where it is none.
uint64_t word_of(double value, char kind, size_t bytes) {
  if (kind == 'f' && bytes == 8) return std::bit_cast<uint64_t>(value);
  if (kind == 'f' && bytes == 4) return std::bit_cast<uint32_t>(float(value));
  if (kind == 'f') return half_from_float(float(value), HalfRound::nearest);
  return uint64_t(std::llround(value));
}

}  // namespace

EnginePlane engine_plane(const Image& image) {
  EnginePlane plane{image.width, image.height, info(image.format).channels, {}};
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < plane.channels; ++c) plane.values.push_back(image.value(x, y, c));
  return plane;
}

EnginePlane repacked(const EnginePlane& from, int channels,
                     const std::function<void(const double* from, double* to)>& pack) {
  EnginePlane plane{from.width, from.height, channels, {}};
  const size_t pixels = size_t(from.width) * size_t(from.height);
  plane.values.resize(pixels * size_t(channels));
  for (size_t i = 0; i < pixels; ++i)
    pack(&from.values[i * size_t(from.channels)], &plane.values[i * size_t(channels)]);
  return plane;
}

EnginePlane bottom_up(EnginePlane plane) {
  const EnginePlane from = plane;
  for (int y = 0; y < plane.height; ++y)
    for (int x = 0; x < plane.width; ++x)
      for (int c = 0; c < plane.channels; ++c) plane.at(x, y, c) = from.at(x, plane.height - 1 - y, c);
  return plane;
}

void write_npy(const std::string& path, const EnginePlane& plane, const std::string& type, bool fortran_order) {
  std::string header = "{'descr': '" + type + "', 'fortran_order': " + (fortran_order ? "True" : "False") +
                       ", 'shape': (" + std::to_string(plane.height) + ", " + std::to_string(plane.width) +
                       (plane.channels > 1 ? ", " + std::to_string(plane.channels) : "") + "), }";
  header.resize((header.size() + 11 + 63) / 64 * 64 - 11, ' ');
  header += '\n';
  std::string bytes("\x93NUMPY\x01\x00", 8);
  append(bytes, header.size(), 2);
  bytes += header;
  const auto count = size_t(type[2] - '0');
  const auto put = [&](int x, int y, int c) {
    append(bytes, word_of(plane.at(x, y, c), type[1], count), count, type[0] == '>');
  };
  if (fortran_order) {
    for (int c = 0; c < plane.channels; ++c)
      for (int x = 0; x < plane.width; ++x)
        for (int y = 0; y < plane.height; ++y) put(x, y, c);
  } else {
    for (int y = 0; y < plane.height; ++y)
      for (int x = 0; x < plane.width; ++x)
        for (int c = 0; c < plane.channels; ++c) put(x, y, c);
  }
  save(path, bytes);
}

void write_dds(const std::string& path, const EnginePlane& plane, int dxgi_format) {
  struct Layout {
    int number, channels;
    char kind;
    size_t bytes;
    double scale;
    bool bgra = false;
  };
  constexpr Layout kLayouts[] = {
      {2, 4, 'f', 4, 1},    {10, 4, 'f', 2, 1},     {11, 4, 'u', 2, 65535},    {16, 2, 'f', 4, 1}, {28, 4, 'u', 1, 255},
      {34, 2, 'f', 2, 1},   {35, 2, 'u', 2, 65535}, {40, 1, 'f', 4, 1},        {41, 1, 'f', 4, 1}, {42, 1, 'u', 4, 1},
      {49, 2, 'u', 1, 255}, {51, 2, 's', 1, 127},   {87, 4, 'u', 1, 255, true}};
  const Layout* layout = nullptr;
  for (const Layout& l : kLayouts)
    if (l.number == dxgi_format) layout = &l;
  REQUIRE(layout != nullptr);
  std::string bytes = "DDS ";
  const uint32_t head[] = {124, 0x1007, uint32_t(plane.height), uint32_t(plane.width), 0, 0, 1};
  for (const uint32_t word : head) append(bytes, word, 4);
  for (int i = 0; i < 11; ++i) append(bytes, 0, 4);
  for (const uint32_t word : {32u, 4u, 0x30315844u, 0u, 0u, 0u, 0u, 0u, 0x1000u, 0u, 0u, 0u, 0u})
    append(bytes, word, 4);
  for (const uint32_t word : {uint32_t(dxgi_format), 3u, 0u, 1u, 0u}) append(bytes, word, 4);
  REQUIRE(bytes.size() == 148);
  for (int y = 0; y < plane.height; ++y)
    for (int x = 0; x < plane.width; ++x)
      for (int c = 0; c < layout->channels; ++c) {
        const int from = layout->bgra && c < 3 ? 2 - c : c;
        const double value = from < plane.channels ? plane.at(x, y, from) : 1.0;
        append(bytes, word_of(layout->scale * value, layout->kind, layout->bytes), layout->bytes);
      }
  save(path, bytes);
}

namespace {

std::vector<float> floats_of(const EnginePlane& plane) { return {plane.values.begin(), plane.values.end()}; }

OIIO::ImageSpec spec_of(const EnginePart& part, int tile) {
  const OIIO::TypeDesc type(part.type);
  OIIO::ImageSpec spec(part.plane->width, part.plane->height, part.plane->channels, type);
  spec.channelnames = part.channels;
  if (!part.name.empty()) spec.attribute("oiio:subimagename", part.name);
  spec.tile_width = spec.tile_height = tile;
  if (tile > 0) spec.tile_depth = 1;
  return spec;
}

/// Whole numbers go as such: OpenImageIO would scale a float to the range of an integer.
void write_part(OIIO::ImageOutput& file, const EnginePlane& plane, const std::string& type) {
  if (type.starts_with("uint")) {
    const double scale = type == "uint8" ? 255 : type == "uint16" ? 65535 : 1;
    std::vector<uint32_t> words;
    std::vector<uint16_t> shorts;
    std::vector<uint8_t> bytes;
    for (const double value : plane.values) {
      words.push_back(uint32_t(std::llround(value * scale)));
      shorts.push_back(uint16_t(words.back()));
      bytes.push_back(uint8_t(words.back()));
    }
    const void* data = type == "uint8"    ? static_cast<const void*>(bytes.data())
                       : type == "uint16" ? static_cast<const void*>(shorts.data())
                                          : words.data();
    REQUIRE(file.write_image(OIIO::TypeDesc(type), data));
  } else {
    REQUIRE(file.write_image(OIIO::TypeDesc::FLOAT, floats_of(plane).data()));
  }
}

}  // namespace

void write_exr_parts(const std::string& path, const std::vector<EnginePart>& parts, int tile) {
  const auto file = OIIO::ImageOutput::create("openexr");
  std::vector<OIIO::ImageSpec> specs;
  for (const EnginePart& part : parts) specs.push_back(spec_of(part, tile));
  const bool alone = specs.size() == 1;
  REQUIRE((alone ? file->open(path, specs[0]) : file->open(path, int(specs.size()), specs.data())));
  for (size_t i = 0; i < parts.size(); ++i) {
    if (i > 0) REQUIRE(file->open(path, specs[i], OIIO::ImageOutput::AppendSubimage));
    write_part(*file, *parts[i].plane, parts[i].type);
  }
  REQUIRE(file->close());
}

void write_tiff(const std::string& path, const EnginePlane& plane, const std::string& type,
                const std::string& compression, int tile) {
  const auto file = OIIO::ImageOutput::create("tiff");
  OIIO::ImageSpec spec = spec_of({"", {}, type, &plane}, tile);
  spec.default_channel_names();
  spec.attribute("compression", compression);
  REQUIRE(file->open(path, spec));
  write_part(*file, plane, type);
  REQUIRE(file->close());
}

}  // namespace trueshade
