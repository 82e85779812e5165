#include "cli/pages/layer.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <string_view>

#include "core/fp_env.h"
#include "core/image_rows.h"
#include "shading/output/heat_map.h"

namespace trueshade {
namespace {

std::string json_of_rgb(const Rgb& rgb) {
  return JsonArray()
      .add_raw(std::to_string(rgb[0]))
      .add_raw(std::to_string(rgb[1]))
      .add_raw(std::to_string(rgb[2]))
      .text();
}

/// Channels go by the letters that the plane's own names have.
std::vector<std::string> letters_of(const std::string& id, int channels) {
  std::string_view letters = "RGBA";
  if (id == "position" || id == "normal") letters = "XYZW";
  if (id == "uv") letters = "UV";
  if (channels == 1) return {""};
  std::vector<std::string> names;
  for (int k = 0; k < channels; ++k) names.emplace_back(1, letters[size_t(k) % letters.size()]);
  return names;
}

PageLayer plain_layer(const std::string& id, const std::string& name, const std::string& about, const Image& image) {
  const FormatInfo layout = info(image.format);
  PageLayer layer;
  layer.id = id, layer.name = name, layer.about = about;
  layer.width = image.width, layer.height = image.height;
  layer.is_float = layout.number_class == NumberClass::floating;
  layer.channel_names = letters_of(id, layout.channels);
  layer.widths.assign(layout.bits.begin(), layout.bits.begin() + layout.channels);
  layer.read = [&image, channels = layout.channels](int x, int y, int count, uint32_t* codes) {
    for (int i = 0; i < count; ++i)
      for (int k = 0; k < channels; ++k) *codes++ = image.code(x + i, y, k);
  };
  layer.value = [layout](uint32_t code, int channel) { return value_of_code(layout, channel, code); };
  return layer;
}

/// Least and most finite value of each channel, but for pixels that are all 0, which is where nothing was drawn.
std::string extents_of(const PageLayer& layer) {
  const FpScope exact_arithmetic;
  const size_t channels = layer.channels();
  std::vector<std::array<double, 2>> extents(channels, {HUGE_VAL, -HUGE_VAL});
  std::vector<uint32_t> row(size_t(layer.width) * channels);
  for (int y = 0; y < layer.height; ++y) {
    layer.read(0, y, layer.width, row.data());
    for (size_t at = 0; at < row.size(); at += channels) {
      if (std::all_of(&row[at], &row[at] + std::min<size_t>(channels, 3), [](uint32_t code) { return code == 0; }))
        continue;
      for (size_t k = 0; k < channels; ++k) {
        const double value = layer.is_float ? layer.value(row[at + k], int(k)) : row[at + k];
        if (std::isfinite(value)) extents[k] = {std::min(extents[k][0], value), std::max(extents[k][1], value)};
      }
    }
  }
  JsonArray all;
  for (const auto& [low, high] : extents)
    all.add_raw(low > high ? "[0, 0]" : JsonArray().add_raw(json_number(low)).add_raw(json_number(high)).text());
  return all.text();
}

/// How far two codes of a channel are apart: in codes; of floats the bits of a float, infinite where one alone is NaN.
uint32_t apart(const PageLayer& layer, int channel, uint32_t a, uint32_t b) {
  if (a == b) return 0;
  if (!layer.is_float) return a > b ? a - b : b - a;
  const double from = layer.value(a, channel), to = layer.value(b, channel);
  if (from == to || (std::isnan(from) && std::isnan(to))) return 0;
  const double distance = std::fabs(from - to);
  return std::bit_cast<uint32_t>(std::isnan(distance) ? float(HUGE_VAL) : float(distance));
}

}  // namespace

int PageLayer::bits() const {
  const int most = *std::max_element(widths.begin(), widths.end());
  return most <= 8 ? 8 : most <= 16 ? 16 : 32;
}

PageLayer layer_of_image(const std::string& id, const std::string& name, const std::string& about, const Image& image) {
  PageLayer layer = plain_layer(id, name, about, image);
  layer.look = layer.is_float ? Look::linear : Look::codes;
  if (!layer.is_float) layer.reduction = Reduction::average;
  return layer;
}

PageLayer layer_of_ids(const std::string& id, const std::string& name, const std::string& about, const Image& image) {
  PageLayer layer = plain_layer(id, name, about, image);
  layer.look = Look::ids;
  return layer;
}

PageLayer layer_of_counts(const std::string& id, const std::string& name, const std::string& about,
                          const Image& image) {
  PageLayer layer = plain_layer(id, name, about, image);
  layer.look = Look::counts;
  JsonArray heat;
  for (int step = 0; step <= 256; ++step) heat.add_raw(json_of_rgb(heat_color(step)));
  layer.details.put_raw("heat", heat.text()).put("most", uint64_t(heat_scale(image)));
  return layer;
}

PageLayer shown_by_extents(PageLayer layer) {
  layer.look = Look::extent, layer.reduction = Reduction::sample;
  layer.details.put_raw("extent", extents_of(layer));
  return layer;
}

PageLayer layer_of_extents(const std::string& id, const std::string& name, const std::string& about,
                           const Image& image) {
  return shown_by_extents(plain_layer(id, name, about, image));
}

PageLayer layer_of_directions(const std::string& id, const std::string& name, const std::string& about,
                              const Image& image) {
  PageLayer layer = plain_layer(id, name, about, image);
  layer.look = Look::direction;
  return layer;
}

PageLayer first_channels(PageLayer layer, int channels) {
  const size_t all = layer.channels(), kept = std::min(all, size_t(channels));
  layer.channel_names.resize(kept), layer.widths.resize(kept);
  layer.read = [all, kept, read = layer.read](int x, int y, int count, uint32_t* codes) {
    std::vector<uint32_t> texels(all * size_t(count));
    read(x, y, count, texels.data());
    for (size_t i = 0; i < size_t(count); ++i) std::copy_n(&texels[i * all], kept, codes + i * kept);
  };
  return layer;
}

PageLayer layer_of_difference(const std::string& name, const std::string& about, const PageLayer& from,
                              const PageLayer& to, const std::string& id) {
  PageLayer layer = from;
  layer.id = id, layer.name = name, layer.about = about;
  layer.look = Look::difference, layer.reduction = Reduction::largest, layer.is_read = false;
  layer.base.clear();
  if (layer.is_float) layer.widths.assign(layer.channels(), 32);
  layer.details = JsonObject();
  layer.details.put_raw("of", JsonArray().add_raw(json_string(from.id)).add_raw(json_string(to.id)).text());
  layer.read = [from, to](int x, int y, int count, uint32_t* codes) {
    const FpScope exact_arithmetic;
    std::vector<uint32_t> others(size_t(count) * to.channels());
    from.read(x, y, count, codes);
    to.read(x, y, count, others.data());
    for (size_t i = 0; i < others.size(); ++i) codes[i] = apart(from, int(i % from.channels()), codes[i], others[i]);
  };
  return layer;
}

}  // namespace trueshade
