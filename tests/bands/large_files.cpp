// Pictures that are drawn and written in bands against the same pictures drawn whole, read back by OpenImageIO and by
// our own reader of PNG.
#include <OpenImageIO/imageio.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstring>

#include "bands/picture_writer.h"
#include "core/error.h"
#include "core/memory_cap.h"
#include "shading/picture_region.h"
#include "tests/bands/city_picture.h"
#include "tests/catch.hpp"
#include "tests/scratch_folder.h"

using namespace trueshade;
using testing::city_picture;

namespace {

PictureWriter::Finished written(const LargePicture& picture) {
  PictureWriter writer(picture, "test", Resume::no);
  for (int i = 0; i < picture.bands(); ++i) writer.take(draw_band(picture, i));
  return writer.finish();
}

Frame whole(const LargePicture& picture) {
  return render_frame(picture.scene, picture.pipeline, picture.execution, picture.aovs);
}

constexpr OIIO::TypeDesc::BASETYPE type_of(float) { return OIIO::TypeDesc::FLOAT; }
constexpr OIIO::TypeDesc::BASETYPE type_of(uint32_t) { return OIIO::TypeDesc::UINT32; }

/// A channel of an EXR, by OpenImageIO, pixel after pixel.
template <typename Value>
std::vector<Value> channel(const std::string& path, const std::string& name, int& tile) {
  const auto file = OIIO::ImageInput::open(path);
  REQUIRE(file);
  const OIIO::ImageSpec spec = file->spec();
  tile = spec.tile_width == spec.tile_height ? spec.tile_width : -1;
  const int index = spec.channelindex(name);
  INFO(name);
  REQUIRE(index >= 0);
  std::vector<Value> values(size_t(spec.width) * size_t(spec.height));
  REQUIRE(file->read_image(0, 0, index, index + 1, type_of(Value{}), values.data()));
  return values;
}

/// What our own reader finds in the file.
std::string hash_in(const std::string& path) {
  for (const auto& [key, value] : read_image_info(path).metadata)
    if (key == "trueshade:imageHash") return value;
  return {};
}

std::string attribute(const std::string& path, const std::string& name) {
  const auto file = OIIO::ImageInput::open(path);
  REQUIRE(file);
  return file->spec().get_string_attribute(name);
}

}  // namespace

TEST_CASE("A picture in bands is the picture: hash, counts, PNG and tiled EXR with planes", "[bands]") {
  const Scene scene = builtin_scene("city");
  const PreparedScene prepared(scene);
  const ScratchFolder folder;
  LargePicture picture = city_picture(prepared, 203, 331);
  picture.aovs = {"depth", "normal", "id.object"};
  picture.files = {folder.path("city.png"), folder.path("city.exr")};
  const Frame frame = whole(picture);
  for (const int rows : {64, 128, 384}) {
    INFO("bands of " << rows);
    picture.rows = rows;
    const PictureWriter::Finished finished = written(picture);
    CHECK(finished.hash == image_hash(frame.color));
    for (size_t i = 0; i < frame.aovs.size(); ++i) CHECK(finished.plane_hashes[i] == image_hash(frame.aovs[i].image));
    CHECK(finished.counts.pixels == 203u * 331u);
    CHECK(finished.counts.covered_pixels == frame.stats.covered_pixels);
    CHECK(finished.counts.lit_pixel_lights == frame.stats.lit_pixel_lights);
    CHECK(finished.counts.triangles == frame.stats.triangles);
    CHECK(folder.entries() == std::vector<std::string>{"city.exr", "city.png"});

    const std::vector<NamedImage> png = read_planes(picture.files[0]);
    CHECK(image_hash(png.at(0).image) == finished.hash);
    CHECK(hash_in(picture.files[0]) == "sha256:" + finished.hash);  // OpenImageIO stops where the pixels begin
    CHECK(attribute(picture.files[1], "trueshade:imageHash") == "sha256:" + finished.hash);
    int tile = 0;
    const auto red = channel<float>(picture.files[1], "R", tile), z = channel<float>(picture.files[1], "depth.Z", tile);
    const auto object = channel<uint32_t>(picture.files[1], "id.object", tile);
    CHECK(tile == 64);
    size_t wrong = 0;
    for (int y = 0, i = 0; y < 331; ++y)
      for (int x = 0; x < 203; ++x, ++i) {
        wrong += red[size_t(i)] != float(frame.color.value(x, y, 0)) ? 1 : 0;
        wrong += z[size_t(i)] != float(frame.aovs[0].image.value(x, y, 0)) ? 1 : 0;
        wrong += object[size_t(i)] != frame.aovs[2].image.code(x, y, 0) ? 1 : 0;
      }
    CHECK(wrong == 0);
  }
}

TEST_CASE("Files of bands are the same bytes whatever the height of bands and the threads", "[bands]") {
  const Scene scene = builtin_scene("cornell");
  const PreparedScene prepared(scene);
  const ScratchFolder folder;
  std::vector<std::string> contents[2];
  for (const int rows : {64, 192}) {
    LargePicture picture = city_picture(prepared, 150, 200);
    picture.pipeline.target = Format::rgb10_a2;
    picture.rows = rows;
    picture.execution.threads = picture.file_options.threads = rows == 64 ? 1 : 2;
    picture.files = {folder.path("a.png"), folder.path("a.exr")};
    written(picture);
    for (const std::string& file : picture.files) {
      std::ostringstream text;
      text << std::ifstream(file, std::ios::binary).rdbuf();
      contents[rows == 64 ? 0 : 1].push_back(text.str());
    }
  }
  CHECK((contents[0] == contents[1]));
}

TEST_CASE("Bands of a region, of heat maps and of mapped tones are those of the picture", "[bands]") {
  const Scene scene = builtin_scene("circle");
  const PreparedScene prepared(scene);
  LargePicture picture = city_picture(prepared, 170, 210);
  picture.execution.region = {13, 9, 120, 190};
  const auto check = [&] {
    picture.constants = has_constants(picture.pipeline)
                            ? picture_constants(prepared, picture.pipeline, picture.execution)
                            : PictureConstants{};
    CHECK(written(picture).hash == image_hash(whole(picture).color));
  };
  check();
  picture.pipeline.view = ImageView::light_count;
  check();
  picture.pipeline.view = ImageView::lit;
  picture.pipeline.post.tone_map = PostChain::ToneMap::reinhard;
  picture.pipeline.post.bloom.strength = 0.2f;
  picture.pipeline.post.edge_filter = true;
  check();
}

TEST_CASE("What is large depends on the size alone", "[bands]") {
  Pipeline p;
  const auto large = [&p](int width, int height) {
    p.width = width, p.height = height;
    return is_large(p, {});
  };
  CHECK_FALSE(large(16384, 4096));
  CHECK(large(16385, 1));
  CHECK(large(1, 16385));
  CHECK(large(8192, 8193));
  p.width = p.height = kMostPictureSide;
  CHECK_FALSE(is_large(p, {5, 5, 16384, 4096}));
}

TEST_CASE("A band stays within the memory that there is", "[bands]") {
  const Scene scene = builtin_scene("sphere");
  const PreparedScene prepared(scene);
  LargePicture picture = city_picture(prepared, 65536, 65536);
  picture.files = {"a.exr"};
  const uint64_t before = memory_cap();
  set_memory_cap(uint64_t(4) << 30);
  const int rows = band_rows(picture);
  CHECK(rows % kStripRows == 0);
  CHECK(rows > kStripRows);
  int least = rows;
  const auto rows_within = [&picture](int megabytes) {
    set_memory_cap(resident_memory() + (uint64_t(megabytes) << 20));
    return band_rows(picture);
  };
  for (int megabytes = 2000; least > kStripRows; megabytes -= 10) {
    const int found = rows_within(megabytes);
    CHECK(found <= least);
    least = found;
  }
  CHECK(least == kStripRows);
  CHECK_THROWS_AS(rows_within(20), Error);
  set_memory_cap(before);
}

TEST_CASE("A large EXR does not go into a stream, and a large PNG does", "[bands]") {
  const Scene scene = builtin_scene("sphere");
  const PreparedScene prepared(scene);
  LargePicture picture = city_picture(prepared, 90, 100);
  picture.files = {"/dev/null"};
  CHECK_THROWS_AS(PictureWriter(picture, "test", Resume::no), Error);
  const ScratchFolder folder;
  const std::string pipe = folder.path("pipe.exr");
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  const int reader = open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
  picture.files = {pipe};
  CHECK_THROWS_AS(PictureWriter(picture, "test", Resume::no), Error);
  close(reader);
}
