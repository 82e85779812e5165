#include "bands/drawn_band.h"

#include <algorithm>
#include <cstring>
#include <type_traits>

#include "core/error.h"

namespace trueshade {
namespace {

/// Calls visit(field of a, field of b) for each count and time that adds up over parts of a picture.
template <class A, class B, class Visit>
void for_each_sum(A& a, B& b, const Visit& visit) {
  visit(a.pixels, b.pixels);
  visit(a.covered_pixels, b.covered_pixels);
  visit(a.lit_pixel_lights, b.lit_pixel_lights);
  visit(a.pixel_lights, b.pixel_lights);
  visit(a.transparent_fragments, b.transparent_fragments);
  visit(a.gl.light_pixels, b.gl.light_pixels);
  visit(a.gl.material_computations, b.gl.material_computations);
  visit(a.gl.gbuffer_fragments_read, b.gl.gbuffer_fragments_read);
  visit(a.gl.target_fragments_read, b.gl.target_fragments_read);
  visit(a.gl.fragments_written, b.gl.fragments_written);
  visit(a.clusters_drawn, b.clusters_drawn);
  visit(a.triangles_tested, b.triangles_tested);
  visit(a.fragments, b.fragments);
  visit(a.tile_pixel_lights, b.tile_pixel_lights);
  visit(a.evaluated_pixel_lights, b.evaluated_pixel_lights);
  visit(a.lights_tested, b.lights_tested);
  visit(a.core_ms.visibility, b.core_ms.visibility);
  visit(a.core_ms.surfaces, b.core_ms.surfaces);
  visit(a.core_ms.light, b.core_ms.light);
  visit(a.core_ms.store, b.core_ms.store);
  visit(a.total_ms, b.total_ms);
  visit(a.before_tiles_ms, b.before_tiles_ms);
}

/// What all parts of a picture have alike.
template <class A, class B, class Visit>
void for_each_constant(A& a, B& b, const Visit& visit) {
  visit(a.triangles, b.triangles);
  visit(a.lights, b.lights);
  visit(a.gl.draws, b.gl.draws);
  visit(a.gl.light_triangles, b.gl.light_triangles);
  visit(a.gl.planes, b.gl.planes);
  visit(a.tile, b.tile);
  visit(a.threads, b.threads);
}

void copy_texels(const Image& from, int x, Image& to) {
  const size_t at = size_t(x) * size_t(info(to.format).bytes_per_texel());
  for (int y = 0; y < from.height; ++y) std::memcpy(to.texel(0, y) + at, from.texel(0, y), from.row_bytes());
}

/// Numbers and runs of bytes, one behind the other.
class ByteWriter {
 public:
  template <class Number>
  void number(Number value) {
    static_assert(std::is_arithmetic_v<Number>);
    const auto* bytes = reinterpret_cast<const uint8_t*>(&value);
    bytes_.insert(bytes_.end(), bytes, bytes + sizeof value);
  }
  void run(std::span<const uint8_t> bytes) {
    number(uint64_t(bytes.size()));
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  }
  std::vector<uint8_t> take() { return std::move(bytes_); }

 private:
  std::vector<uint8_t> bytes_;
};

class ByteReader {
 public:
  explicit ByteReader(std::span<const uint8_t> bytes) : rest_(bytes) {}

  template <class Number>
  void number(Number& value) {
    std::memcpy(&value, next(sizeof value).data(), sizeof value);
  }
  std::span<const uint8_t> run() {
    uint64_t size = 0;
    number(size);
    return next(size);
  }
  bool at_end() const { return rest_.empty(); }
  [[noreturn]] static void fail() {
    throw Error(ErrorKind::bad_input, "band", "another process has sent what is no band of this picture",
                "run the same version everywhere");
  }

 private:
  std::span<const uint8_t> next(uint64_t size) {
    if (size > rest_.size()) fail();
    const std::span<const uint8_t> taken = rest_.first(size_t(size));
    rest_ = rest_.subspan(size_t(size));
    return taken;
  }
  std::span<const uint8_t> rest_;
};

void write_texels(const Image& image, ByteWriter& out) { out.run(image.texels); }

Image read_texels(Format format, const PictureRegion& band, ByteReader& in) {
  Image image(band.width, band.height, format);
  const std::span<const uint8_t> texels = in.run();
  if (texels.size() != image.texels.size()) ByteReader::fail();
  std::copy(texels.begin(), texels.end(), image.texels.begin());
  return image;
}

}  // namespace

void add_counts(const FrameStats& part, FrameStats& sum) {
  for_each_sum(sum, part, [](auto& to, const auto& more) { to += more; });
  for_each_constant(sum, part, [](auto& to, const auto& same) { to = same; });
}

std::vector<uint64_t> counts_of(const FrameStats& stats) {
  std::vector<uint64_t> words;
  const auto put = [&words](const auto& value, const auto&) {
    uint64_t word = 0;
    std::memcpy(&word, &value, sizeof value);
    words.push_back(word);
  };
  for_each_sum(stats, stats, put);
  for_each_constant(stats, stats, put);
  return words;
}

bool set_counts(std::span<const uint64_t> words, FrameStats& stats) {
  size_t at = 0;
  const auto get = [&](auto& value, const auto&) {
    if (at < words.size()) std::memcpy(&value, &words[at], sizeof value);
    ++at;
  };
  for_each_sum(stats, stats, get);
  for_each_constant(stats, stats, get);
  return at == words.size();
}

DrawnBand draw_band(const LargePicture& picture, int index) {
  const PictureRegion band = picture.band(index);
  const int most = kMostDrawnSide / (picture.pipeline.post.active() ? picture.pipeline.post.samples : 1);
  DrawnBand out;
  const std::vector<Format> formats = picture.planes();
  std::vector<NamedImage> planes;
  for (int x = 0; x < band.width; x += most) {
    Execution execution = picture.execution;
    execution.region = {band.x + x, band.y, std::min(most, band.width - x), band.height};
    Frame part = render_frame(picture.scene, picture.pipeline, execution, picture.aovs, {}, &picture.constants);
    add_counts(part.stats, out.counts);
    if (execution.region.width == band.width) {
      out.color = std::move(part.color), planes = std::move(part.aovs);
      break;
    }
    if (x == 0) {
      out.color = Image(band.width, band.height, picture.color());
      for (size_t i = 0; i < formats.size(); ++i)
        planes.push_back({picture.aovs[i], Image(band.width, band.height, formats[i])});
    }
    copy_texels(part.color, x, out.color);
    for (size_t i = 0; i < planes.size(); ++i) copy_texels(part.aovs[i].image, x, planes[i].image);
  }
  for (const std::string& file : picture.files) {
    const StreamedPicture streamed = picture.streamed(file);
    const std::span<const NamedImage> of_file(planes.data(), streamed.planes.size());
    out.of_files.push_back(encoded_rows(file, streamed, picture.first_row(index), out.color, of_file));
  }
  for (NamedImage& plane : planes) out.planes.push_back(std::move(plane.image));
  return out;
}

std::vector<uint8_t> bytes_of_band(const DrawnBand& band, SentPlanes planes) {
  ByteWriter out;
  write_texels(band.color, out);
  if (planes == SentPlanes::yes)
    for (const Image& plane : band.planes) write_texels(plane, out);
  for (const EncodedRows& rows : band.of_files) {
    out.number(rows.checksum);
    out.number(rows.bytes);
    out.number(uint64_t(rows.pieces.size()));
    for (const std::vector<uint8_t>& piece : rows.pieces) out.run(piece);
  }
  out.number(uint8_t(planes == SentPlanes::yes));
  for (const uint64_t word : counts_of(band.counts)) out.number(word);
  return out.take();
}

std::span<const uint8_t> part_of_band_without_times(std::span<const uint8_t> bytes) {
  const size_t counts = counts_of(FrameStats()).size() * sizeof(uint64_t);
  return bytes.first(bytes.size() - std::min(bytes.size(), counts));
}

DrawnBand band_of_bytes(const LargePicture& picture, int index, std::span<const uint8_t> bytes) {
  const std::span<const uint8_t> pixels = part_of_band_without_times(bytes);
  if (pixels.empty()) ByteReader::fail();
  ByteReader in(pixels.first(pixels.size() - 1)), counts(bytes.subspan(pixels.size()));
  const PictureRegion region = picture.band(index);
  DrawnBand band;
  band.color = read_texels(picture.color(), region, in);
  if (pixels.back() != 0)
    for (const Format format : picture.planes()) band.planes.push_back(read_texels(format, region, in));
  for (size_t i = 0; i < picture.files.size(); ++i) {
    EncodedRows& rows = band.of_files.emplace_back();
    uint64_t pieces = 0;
    in.number(rows.checksum);
    in.number(rows.bytes);
    in.number(pieces);
    for (uint64_t k = 0; k < pieces; ++k) {
      const std::span<const uint8_t> piece = in.run();
      rows.pieces.emplace_back(piece.begin(), piece.end());
    }
  }
  if (!in.at_end()) ByteReader::fail();
  std::vector<uint64_t> words;
  while (!counts.at_end()) counts.number(words.emplace_back());
  set_counts(words, band.counts);
  return band;
}

}  // namespace trueshade
