#include "bands/drawn_band.h"

#include <algorithm>
#include <cstring>

#include "core/byte_stream.h"
#include "core/error.h"

namespace trueshade {
namespace {

/// What a count or a time of a picture is: the sum over its parts, or what they have alike (the last part's is kept).
enum class Whole : uint8_t { sum, alike };

/// Calls visit(Whole, member...) for each count and time that is kept of a picture, with that member of each `stats`.
template <class Visit, class... Stats>
void for_each_count(const Visit& visit, Stats&... stats) {
  visit(Whole::sum, stats.pixels...);
  visit(Whole::sum, stats.covered_pixels...);
  visit(Whole::sum, stats.lit_pixel_lights...);
  visit(Whole::sum, stats.pixel_lights...);
  visit(Whole::sum, stats.transparent_fragments...);
  visit(Whole::sum, stats.gl.light_pixels...);
  visit(Whole::sum, stats.gl.material_computations...);
  visit(Whole::sum, stats.gl.gbuffer_fragments_read...);
  visit(Whole::sum, stats.gl.target_fragments_read...);
  visit(Whole::sum, stats.gl.fragments_written...);
  visit(Whole::sum, stats.clusters_drawn...);
  visit(Whole::sum, stats.triangles_tested...);
  visit(Whole::sum, stats.fragments...);
  visit(Whole::sum, stats.tile_pixel_lights...);
  visit(Whole::sum, stats.evaluated_pixel_lights...);
  visit(Whole::sum, stats.lights_tested...);
  visit(Whole::sum, stats.core_ms.visibility...);
  visit(Whole::sum, stats.core_ms.surfaces...);
  visit(Whole::sum, stats.core_ms.light...);
  visit(Whole::sum, stats.core_ms.store...);
  visit(Whole::sum, stats.total_ms...);
  visit(Whole::sum, stats.before_tiles_ms...);
  visit(Whole::alike, stats.triangles...);
  visit(Whole::alike, stats.lights...);
  visit(Whole::alike, stats.gl.draws...);
  visit(Whole::alike, stats.gl.light_triangles...);
  visit(Whole::alike, stats.gl.planes...);
  visit(Whole::alike, stats.tile...);
  visit(Whole::alike, stats.threads...);
}

void copy_texels(const Image& from, int x, Image& to) {
  const size_t at = size_t(x) * size_t(info(to.format).bytes_per_texel());
  for (int y = 0; y < from.height; ++y) std::memcpy(to.texel(0, y) + at, from.texel(0, y), from.row_bytes());
}

std::span<const uint8_t> read_texels(Format format, const PictureRegion& band, ByteReader& in) {
  const std::span<const uint8_t> texels = in.run();
  if (texels.size() != size_t(band.width) * size_t(band.height) * size_t(info(format).bytes_per_texel()))
    throw BadBytes();
  return texels;
}

void write_rows(const EncodedRows& rows, ByteWriter& out) {
  out.number(rows.checksum);
  out.number(rows.bytes);
  out.number(uint64_t(rows.pieces.size()));
  for (const std::vector<uint8_t>& piece : rows.pieces) out.run(piece);
}

EncodedRows read_rows(ByteReader& in) {
  EncodedRows rows;
  rows.checksum = in.number<uint32_t>();
  rows.bytes = in.number<uint64_t>();
  rows.pieces.resize(in.count(sizeof(uint64_t)));
  for (std::vector<uint8_t>& piece : rows.pieces) {
    const std::span<const uint8_t> bytes = in.run();
    piece.assign(bytes.begin(), bytes.end());
  }
  return rows;
}

}  // namespace

void add_counts(const FrameStats& part, FrameStats& sum) {
  for_each_count([](Whole whole, auto& to, const auto& more) { to = whole == Whole::sum ? to + more : more; }, sum,
                 part);
}

std::vector<uint64_t> counts_of(const FrameStats& stats) {
  std::vector<uint64_t> words;
  for_each_count([&words](Whole, const auto& value) { std::memcpy(&words.emplace_back(), &value, sizeof value); },
                 stats);
  return words;
}

bool set_counts(std::span<const uint64_t> words, FrameStats& stats) {
  size_t at = 0;
  const auto get = [&](Whole, auto& value) {
    if (at < words.size()) std::memcpy(&value, &words[at], sizeof value);
    ++at;
  };
  for_each_count(get, stats);
  return at == words.size();
}

DrawnBand draw_band(const LargePicture& picture, int index) {
  const PictureRegion band = picture.band(index);
  const int most = kMostDrawnSide / (picture.pipeline.post.active() ? picture.pipeline.post.samples : 1);
  DrawnBand out;
  out.rows = band.height;
  const std::vector<Format> formats = picture.planes();
  Image color;
  std::vector<NamedImage> planes;
  for (int x = 0; x < band.width; x += most) {
    Execution execution = picture.execution;
    execution.region = {band.x + x, band.y, std::min(most, band.width - x), band.height};
    Frame part = render_frame(picture.scene, picture.pipeline, execution, picture.aovs, {}, &picture.constants);
    add_counts(part.stats, out.counts);
    if (execution.region.width == band.width) {
      color = std::move(part.color), planes = std::move(part.aovs);
      break;
    }
    if (x == 0) {
      color = Image(band.width, band.height, picture.color());
      for (size_t i = 0; i < formats.size(); ++i)
        planes.push_back({picture.aovs[i], Image(band.width, band.height, formats[i])});
    }
    copy_texels(part.color, x, color);
    for (size_t i = 0; i < planes.size(); ++i) copy_texels(part.aovs[i].image, x, planes[i].image);
  }
  for (const std::string& file : picture.files) {
    const StreamedPicture streamed = picture.streamed(file);
    const std::span<const NamedImage> of_file(planes.data(), streamed.planes.size());
    out.of_files.push_back(encoded_rows(file, streamed, picture.first_row(index), color, of_file));
  }
  out.color = out.bytes.emplace_back(std::move(color.texels));
  for (NamedImage& plane : planes) out.planes.push_back(out.bytes.emplace_back(std::move(plane.image.texels)));
  return out;
}

namespace {

/// More than bytes_of_band() needs by what is beside pixels and files.
size_t bytes_of_pixels_and_files(const DrawnBand& band) {
  constexpr size_t kRest = 1 << 16;
  size_t bytes = kRest;
  for (const std::vector<uint8_t>& pixels : band.bytes) bytes += pixels.size();
  for (const EncodedRows& rows : band.of_files) bytes += size_t(rows.bytes);
  return bytes;
}

}  // namespace

std::vector<uint8_t> bytes_of_band(const DrawnBand& band, SentPlanes planes) {
  ByteWriter out;
  out.reserve(bytes_of_pixels_and_files(band));
  out.number(uint8_t(planes));
  out.run(band.color);
  if (planes == SentPlanes::yes)
    for (const std::span<const uint8_t> plane : band.planes) out.run(plane);
  for (const EncodedRows& rows : band.of_files) write_rows(rows, out);
  for (const uint64_t word : counts_of(band.counts)) out.number(word);
  return out.take();
}

std::span<const uint8_t> part_of_band_without_times(std::span<const uint8_t> bytes) {
  const size_t counts = counts_of(FrameStats()).size() * sizeof(uint64_t);
  return bytes.first(bytes.size() - std::min(bytes.size(), counts));
}

DrawnBand band_of_bytes(const LargePicture& picture, int index, std::vector<uint8_t> bytes) try {
  const PictureRegion region = picture.band(index);
  DrawnBand band;
  ByteReader in(band.bytes.emplace_back(std::move(bytes)));
  band.rows = region.height;
  const SentPlanes planes = in.enumerator(SentPlanes::yes);
  band.color = read_texels(picture.color(), region, in);
  if (planes == SentPlanes::yes)
    for (const Format format : picture.planes()) band.planes.push_back(read_texels(format, region, in));
  for (size_t i = 0; i < picture.files.size(); ++i) band.of_files.push_back(read_rows(in));
  std::vector<uint64_t> counts = counts_of(band.counts);
  for (uint64_t& word : counts) word = in.number<uint64_t>();
  set_counts(counts, band.counts);
  in.end();
  return band;
} catch (const BadBytes&) {
  throw Error(ErrorKind::bad_input, "band", "another process has sent what is no band of this picture",
              "run the same version everywhere");
}

}  // namespace trueshade
