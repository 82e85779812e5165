// Captures come from anywhere: what is read is what was written, and what is not right is refused before it costs
// anything.
#include <OpenImageIO/imageio.h>

#include <optional>

#include "core/error.h"
#include "core/image_files/image_io.h"
#include "tests/catch.hpp"
#include "tests/file_contents.h"
#include "tests/scratch_folder.h"

namespace trueshade {
namespace {

Image pattern(int width, int height, Format format) {
  Image image(width, height, format);
  for (size_t i = 0; i < image.texels.size(); ++i) image.texels[i] = uint8_t(i * 7 % 59);  // no NaN in any format
  return image;
}

/// The kind of error that reading ends in; nothing where it ends well.
std::optional<ErrorKind> reading_refusal(const std::string& path) {
  try {
    read_planes(path);
    return std::nullopt;
  } catch (const Error& error) {
    INFO(error.what());
    CHECK(std::string(error.what()).find('\n') == std::string::npos);
    return error.kind();
  }
}

/// An EXR of these channels as another program may write it.
void write_exr(const std::string& path, OIIO::ImageSpec spec, const std::vector<std::string>& names) {
  spec.nchannels = int(names.size());
  spec.channelnames = names;
  const auto file = OIIO::ImageOutput::create("openexr");
  REQUIRE(file->open(path, spec));
  const std::vector<float> zeros(size_t(spec.width) * size_t(spec.height) * names.size());
  if (spec.tile_width != 0)
    REQUIRE(file->write_tiles(0, spec.width, 0, spec.height, 0, 1, OIIO::TypeDesc::FLOAT, zeros.data()));
  else
    REQUIRE(file->write_scanlines(spec.y, spec.y + spec.height, 0, OIIO::TypeDesc::FLOAT, zeros.data()));
  REQUIRE(file->close());
}

}  // namespace

TEST_CASE("planes written to an EXR are read back under their names, bit for bit") {
  const ScratchFolder folder;
  const Image color = pattern(37, 131, Format::rgba16f);
  const std::vector<NamedImage> planes = {
      {"depth", pattern(37, 131, Format::d32f)},        {"position", pattern(37, 131, Format::rgb32f)},
      {"normal", pattern(37, 131, Format::rgb16f)},     {"albedo", pattern(37, 131, Format::rgba32f)},
      {"specular", pattern(37, 131, Format::rgba32f)},  {"emission", pattern(37, 131, Format::rgba16f)},
      {"uv", pattern(37, 131, Format::rg32f)},          {"id.object", pattern(37, 131, Format::r32ui)},
      {"id.material", pattern(37, 131, Format::r32ui)}, {"light.count", pattern(37, 131, Format::r32ui)}};
  write_image(folder.path("p.exr"), color, planes, {});
  const std::vector<NamedImage> read = read_planes(folder.path("p.exr"));
  REQUIRE(read.size() == planes.size() + 1);
  CHECK(read[0].name == "color");
  CHECK(read[0].image.texels == color.texels);
  for (size_t i = 0; i < planes.size(); ++i) {
    INFO(planes[i].name);
    CHECK(read[i + 1].name == planes[i].name);
    CHECK(read[i + 1].image.format == planes[i].image.format);
    CHECK(read[i + 1].image.texels == planes[i].image.texels);
  }
}

TEST_CASE("a PNG of RGBA is read back code by code, whatever its rows' filters are") {
  const ScratchFolder folder;
  Image color = pattern(61, 67, Format::rgba8);
  for (int y = 0; y < 67; ++y)  // ramps and noise, so that the writer chooses other filters
    for (int x = 0; x < 61 && y % 3 != 0; ++x) color.texel(x, y)[1] = uint8_t(x * y + y);
  write_image(folder.path("c.png"), color, {}, {});
  const std::vector<NamedImage> read = read_planes(folder.path("c.png"));
  REQUIRE(read.size() == 1);
  CHECK(read[0].name == "color");
  CHECK(read[0].image.texels == color.texels);
}

TEST_CASE("a torn file is refused wherever it is torn") {
  const ScratchFolder folder;
  write_image(folder.path("c.exr"), pattern(40, 90, Format::rgba32f), {}, {});
  write_image(folder.path("c.png"), pattern(40, 90, Format::rgba8), {}, {});
  for (const char* name : {"c.exr", "c.png"}) {
    const std::string whole = contents(folder.path(name));
    REQUIRE(whole.size() > 200);
    for (size_t length = 0; length < whole.size(); length += 1 + whole.size() / 97) {
      INFO(name << " cut to " << length << " of " << whole.size());
      folder.write("torn", whole.substr(0, length));
      CHECK(reading_refusal(folder.path("torn")) == ErrorKind::bad_input);
    }
  }
}

TEST_CASE("a PNG with a changed byte is refused: its checksums tell") {
  const ScratchFolder folder;
  write_image(folder.path("c.png"), pattern(40, 90, Format::rgba8), {}, {});
  const std::string whole = contents(folder.path("c.png"));
  for (size_t at = 8; at < whole.size(); at += 13) {
    std::string changed = whole;
    changed[at] = char(changed[at] ^ 0x10);
    folder.write("changed.png", changed);
    INFO("byte " << at);
    const auto kind = reading_refusal(folder.path("changed.png"));
    CHECK((kind == ErrorKind::bad_input || kind == ErrorKind::limit));
  }
}

TEST_CASE("files that are not a whole picture of our planes are refused") {
  const ScratchFolder folder;
  const OIIO::ImageSpec plain(8, 8, 1, OIIO::TypeDesc::FLOAT);
  const auto written = [&folder](const char* name, const OIIO::ImageSpec& spec, const std::vector<std::string>& names) {
    write_exr(folder.path(name), spec, names);
    return folder.path(name);
  };
  CHECK(reading_refusal(written("ok.exr", plain, {"P.X", "P.Y", "P.Z", "other"})) == std::nullopt);
  CHECK(reading_refusal(written("missing.exr", plain, {"P.X", "P.Y"})) == ErrorKind::bad_input);
  CHECK(reading_refusal(written("strangers.exr", plain, {"beauty", "crypto"})) == ErrorKind::bad_input);
  OIIO::ImageSpec tiled = plain;
  tiled.tile_width = tiled.tile_height = 16;
  CHECK(reading_refusal(written("tiled.exr", tiled, {"R", "G", "B", "A"})) == ErrorKind::bad_input);
  OIIO::ImageSpec cropped = plain;
  cropped.full_width = 16;
  CHECK(reading_refusal(written("cropped.exr", cropped, {"R", "G", "B", "A"})) == ErrorKind::bad_input);
  CHECK(reading_refusal(written("wide.exr", OIIO::ImageSpec(1048577, 1, 1, OIIO::TypeDesc::FLOAT), {"depth.Z"})) ==
        ErrorKind::limit);
  folder.write("text.exr", "not an image at all");
  CHECK(reading_refusal(folder.path("text.exr")) == ErrorKind::bad_input);
  folder.write("magic.exr", std::string("\x76\x2f\x31\x01") + std::string(400, 'x'));
  CHECK(reading_refusal(folder.path("magic.exr")) == ErrorKind::bad_input);
  CHECK(reading_refusal(folder.path("absent.exr")) == ErrorKind::io);
  CHECK(reading_refusal(folder.path("")) == ErrorKind::bad_input);  // a folder, as of a scene
}

}  // namespace trueshade
