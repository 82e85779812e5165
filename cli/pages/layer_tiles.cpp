// Layers as the page holds them: tiles, so that it unpacks what is looked at; each channel predicted and split into its
// bytes, as that compresses; one zlib stream in base64 a line, empty where all is as in the base layer.
#include <algorithm>
#include <cstdlib>
#include <string_view>

#include "cli/pages/layer.h"
#include "cli/pages/viewer.h"
#include "core/image_files/zlib_stream.h"
#include "core/threads/parallel_for.h"

namespace trueshade {
namespace {

using Codes = std::vector<uint32_t>;

constexpr int kLargestWhole = 2048, kReducedTo = 1024;  // pixels of the larger side

/// A picture of a layer: its pixels, or squares of `scale` pixels reduced to one.
class Reader {
 public:
  Reader(const PageLayer& layer, int scale) : layer_(layer), scale_(scale) {}

  int width() const { return (layer_.width + scale_ - 1) / scale_; }
  int height() const { return (layer_.height + scale_ - 1) / scale_; }

  void read(int x, int y, int count, uint32_t* codes) const {
    if (scale_ == 1) return layer_.read(x, y, count, codes);
    for (int i = 0; i < count; ++i) reduce(x + i, y, codes + size_t(i) * layer_.channels());
  }

 private:
  void reduce(int x, int y, uint32_t* code) const {
    const int x0 = x * scale_, y0 = y * scale_;
    const int columns = std::min(scale_, layer_.width - x0), rows = std::min(scale_, layer_.height - y0);
    if (layer_.reduction == Reduction::sample) return layer_.read(x0 + columns / 2, y0 + rows / 2, 1, code);
    const size_t channels = layer_.channels();
    Codes row(size_t(columns) * channels);
    std::vector<uint64_t> sums(channels);
    std::fill_n(code, channels, 0);
    for (int r = 0; r < rows; ++r) {
      layer_.read(x0, y0 + r, columns, row.data());
      for (size_t i = 0; i < row.size(); ++i) {
        uint32_t& best = code[i % channels];
        sums[i % channels] += row[i];
        if (layer_.look == Look::classes ? rank(row[i]) > rank(best) : row[i] > best) best = row[i];
      }
    }
    if (layer_.reduction != Reduction::average) return;
    const uint64_t pixels = uint64_t(columns) * uint64_t(rows);
    for (size_t k = 0; k < channels; ++k) code[k] = uint32_t((sums[k] + pixels / 2) / pixels);
  }
  int rank(uint32_t code) const { return layer_.classes[code].rank; }

  const PageLayer& layer_;
  const int scale_;
};

/// Takes from each code the neighbour that PNG's filter Paeth predicts it by (PNG, section 9.4), modulo 2^32. From the
/// last pixel to the first, as the neighbours are those before.
void predict(Codes& codes, size_t width, size_t channels) {
  const size_t row = width * channels;
  for (size_t i = codes.size(); i-- > 0;) {
    const bool has_left = i % row >= channels, has_up = i >= row;
    const int64_t left = has_left ? codes[i - channels] : 0, up = has_up ? codes[i - row] : 0;
    const int64_t corner = has_left && has_up ? codes[i - row - channels] : 0, guess = left + up - corner;
    const int64_t by_left = std::abs(guess - left), by_up = std::abs(guess - up), by_corner = std::abs(guess - corner);
    codes[i] -= uint32_t(by_left <= by_up && by_left <= by_corner ? left : by_up <= by_corner ? up : corner);
  }
}

/// The lowest bytes of all pixels' first channel, the bytes above them, the second channel's, ...
std::vector<uint8_t> split(const Codes& codes, size_t channels, int bits) {
  std::vector<uint8_t> bytes;
  bytes.reserve(codes.size() * size_t(bits / 8));
  for (size_t channel = 0; channel < channels; ++channel)
    for (int shift = 0; shift < bits; shift += 8)
      for (size_t i = channel; i < codes.size(); i += channels) bytes.push_back(uint8_t(codes[i] >> shift));
  return bytes;
}

std::string line_of_tile(const PageLayer& layer, const PageLayer* base, int scale, int x, int y) {
  const Reader reader(layer, scale);
  const int width = std::min(kTileSide, reader.width() - x), height = std::min(kTileSide, reader.height() - y);
  const size_t row = size_t(width) * layer.channels();
  const auto codes_of = [&](const Reader& from) {
    Codes codes(row * size_t(height));
    for (int r = 0; r < height; ++r) from.read(x, y + r, width, codes.data() + size_t(r) * row);
    return codes;
  };
  Codes codes = codes_of(reader);
  if (base == nullptr) {
    predict(codes, size_t(width), layer.channels());
  } else {
    const Codes others = codes_of(Reader(*base, scale));
    for (size_t i = 0; i < codes.size(); ++i) codes[i] -= others[i];
  }
  if (std::all_of(codes.begin(), codes.end(), [](uint32_t code) { return code == 0; })) return {};
  return base64(zlib_stream(split(codes, layer.channels(), layer.bits())));
}

/// An element that holds a level, a line a tile, rows of tiles from the top.
std::string element_of(const std::string& id, const PageLayer& layer, const PageLayer* base, int scale, int threads) {
  const Reader reader(layer, scale);
  const int columns = (reader.width() + kTileSide - 1) / kTileSide,
            rows = (reader.height() + kTileSide - 1) / kTileSide;
  std::vector<std::string> lines(size_t(columns) * size_t(rows));
  parallel_for(columns * rows, threads, [&](int i) {
    lines[size_t(i)] = line_of_tile(layer, base, scale, i % columns * kTileSide, i / columns * kTileSide);
  });
  std::string element = "<script type=\"text/plain\" id=\"" + id + "\">";
  for (size_t i = 0; i < lines.size(); ++i) {
    element += (i == 0 ? "" : "\n") + lines[i];
    std::string().swap(lines[i]);
  }
  return element + "</script>\n";
}

const char* name_of(Look look) {
  constexpr const char* kNames[] = {"codes", "linear",  "extent",     "direction", "counts",
                                    "ids",   "classes", "difference", "hidden"};
  return kNames[size_t(look)];
}

std::string json_of_classes(const std::vector<LayerClass>& classes) {
  JsonArray all;
  for (const LayerClass& c : classes) {
    JsonArray color;
    for (const uint8_t code : c.color) color.add_raw(std::to_string(code));
    all.add_raw(JsonObject()
                    .put("name", c.name)
                    .put("meaning", c.meaning)
                    .put_raw("color", color.text())
                    .put("count", c.count)
                    .put("rank", c.rank)
                    .text());
  }
  return all.text();
}

}  // namespace

int reduction_of(int width, int height) {
  const int most = std::max(width, height);
  return most <= kLargestWhole ? 1 : (most + kReducedTo - 1) / kReducedTo;
}

WrittenLayer written(const PageLayer& layer, const PageLayer* base, int threads) {
  std::string elements;
  JsonArray levels, names, widths, largest;
  const auto add = [&](int scale) {
    const std::string id = "pixels-" + layer.id + '-' + std::to_string(scale);
    const Reader reader(layer, scale);
    levels.add_raw(JsonObject()
                       .put("scale", scale)
                       .put("width", reader.width())
                       .put("height", reader.height())
                       .put("data", id)
                       .text());
    elements += element_of(id, layer, base, scale, threads);
  };
  if (layer.look != Look::difference) add(1);
  if (const int scale = reduction_of(layer.width, layer.height); scale > 1) add(scale);
  for (const std::string& name : layer.channel_names) names.add_raw(json_string(name));
  for (const int bits : layer.widths) {
    widths.add_raw(std::to_string(bits));
    largest.add_raw(std::to_string((uint64_t(1) << bits) - 1));
  }
  JsonObject json = layer.details;
  json.put("id", layer.id).put("name", layer.name).put("about", layer.about).put("look", name_of(layer.look));
  json.put("shown", layer.look != Look::hidden).put("read", layer.is_read && layer.look != Look::hidden);
  json.put("numbers", layer.is_float ? "float" : "code").put("channels", uint64_t(layer.channels()));
  json.put("bits", layer.bits()).put_raw("channel_names", names.text()).put_raw("widths", widths.text());
  json.put_raw("largest", largest.text()).put_raw("levels", levels.text());
  if (base != nullptr) json.put("base", base->id);
  if (!layer.classes.empty()) json.put_raw("classes", json_of_classes(layer.classes));
  return {json.text(), std::move(elements)};
}

std::string base64(std::span<const uint8_t> bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](size_t k) { return i + k < bytes.size() ? uint32_t(bytes[i + k]) : 0u; };
    const uint32_t bits = byte(0) << 16 | byte(1) << 8 | byte(2);
    text += kDigits[bits >> 18];
    text += kDigits[(bits >> 12) & 63];
    text += i + 1 < bytes.size() ? kDigits[(bits >> 6) & 63] : '=';
    text += i + 2 < bytes.size() ? kDigits[bits & 63] : '=';
  }
  return text;
}

}  // namespace trueshade
