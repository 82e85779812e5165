// shading/ and core/image_files/: what is drawn, written and read again.
#include "core/image_files/image_io.h"
#include "scenes/pipeline/presets.h"
#include "shading/frame.h"
#include "tests/fp_modes/rows.h"

namespace trueshade {
namespace {

Pipeline small() {
  Pipeline p;
  p.width = 48;
  p.height = 40;
  return p;
}

void put(Bytes& out, const Frame& frame) {
  out.put(frame.color);
  for (const NamedImage& plane : frame.aovs) out.put(plane.image);
  out.put(frame.stats.lit_pixel_lights);
}

void call_frames(Bytes& out) {
  const std::string planes[] = {"Z", "normal", "light.count", "light.intensity", "light.edges", "light.1"};
  Pipeline p = small();
  put(out, render_frame(scene_of_all(), p, {}, planes));
  p.target = Format::rgba16f;
  p.post.samples = 2;
  p.post.bloom.strength = 0.3f;
  p.post.tone_map = PostChain::ToneMap::reinhard;
  p.post.encode = PostChain::Encode::srgb;
  p.post.edge_filter = true;
  p.post.marker_radius = 0.1f;
  put(out, render_frame(scene_of_all(), p));
  p = small();
  p.view = ImageView::light_count;
  put(out, render_frame(scene_of_all(), p));
  out.put_error([] {
    const std::string unknown[] = {"light.-1"};
    render_frame(scene_of_all(), small(), {}, unknown);
  });
  out.put_error([] {
    Pipeline none = small();
    none.width = 0;
    render_frame(scene_of_all(), none);
  });
}

void call_prepared(Bytes& out) {
  PreparedScene prepared(scene_of_all());
  prepared.update();
  out.put(prepared.scene().instances);
  const ClusteredScene& clusters = prepared.clusters();
  out.put(sizeof(&clusters));
  Pipeline p = small();
  p.strategy = Strategy::deferred_volumes;
  put(out, render_frame(prepared, p));
}

void call_aovs(Bytes& out) {
  for (const std::string_view name : aov_names()) {
    out.put(name);
    out.put(is_aov_name(name));
  }
}

void call_tiles(Bytes& out) { out.put(tile_for(800, 600, 2)); }

/// Numbers that no file holds exactly, and denormals.
const Frame& drawn() {
  static const Frame frame = [] {
    Pipeline p = small();
    p.target = Format::rgba32f;
    const std::string planes[] = {"normal"};
    Frame made = render_frame(scene_of_all(), p, {}, planes);
    made.color.set_code(1, 1, 0, 71362);  // 1e-40
    return made;
  }();
  return frame;
}

Image of_format(Format format) {
  Pipeline p = small();
  p.target = format;
  return render_frame(scene_of_all(), p).color;
}

void call_writing(Bytes& out) {
  for (const Format format : {Format::rgba8, Format::rgb10_a2, Format::rgba16f, Format::r11g11b10f}) {
    const Image image = of_format(format);
    out.put(encode_png(image, {{"key", "0.1"}}));
    for (const std::vector<uint8_t>& piece : encoded_image("x.exr", image, {}, {})) out.put(piece);
    const std::string path = scratch_path("picture.exr");
    write_image(path, image, {}, {});
    for (const NamedImage& plane : read_planes(path)) out.put(plane.image);
  }
  out.put_error([] { write_image("picture.bmp", drawn().color, {}, {}); });
}

void call_reading(Bytes& out) {
  const std::string exr = scratch_path("read.exr"), png = scratch_path("read.png");
  write_image(exr, drawn().color, drawn().aovs, {{"trueshade:imageHash", "0"}});
  for (const NamedImage& plane : read_planes(exr)) {
    out.put(plane.name);
    out.put(plane.image);
  }
  const std::vector<uint8_t> bytes = encode_png(drawn().color, {});
  out.put(decode_image(bytes, "picture", 1u << 30));
  check_writable(png);
  write_file(png, bytes);
  for (const std::string& path : {exr, png}) {
    const ImageFileInfo header = read_image_info(path);
    out.put(header.width);
    for (const std::string& channel : header.channels) out.put(channel);
    for (const auto& [key, value] : header.metadata) out.put(key + value);
  }
  out.put_error([] { read_planes(scratch_path("absent.exr")); });
  out.put_error([] { decode_image({}, "nothing", 1); });
}

constexpr Row kFrameRows[] = {
    {"core/image_files/image_io.h", "write_image encoded_image encode_png", call_writing},
    {"core/image_files/image_io.h", "read_planes decode_image read_image_info check_writable write_file", call_reading},
    {"shading/frame.h", "render_frame", call_frames},
    {"shading/frame.h", "PreparedScene scene clusters update", call_prepared},
    {"shading/frame.h", "aov_names is_aov_name", call_aovs},
    {"scenes/pipeline/pipeline.h", "tile_for", call_tiles},
};

}  // namespace

std::span<const Row> rows_of_frames() { return kFrameRows; }

}  // namespace trueshade
