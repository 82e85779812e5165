#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "cli/json_text.h"
#include "core/image.h"

namespace trueshade {

using Rgb = std::array<uint8_t, 3>;

/// How the values of a layer become colours in the page (script/looks.js has each).
enum class Look : uint8_t { codes, linear, extent, direction, counts, ids, classes, difference, hidden };

/// How several pixels become one where a large picture is shown reduced.
enum class Reduction : uint8_t {
  sample,   ///< the one in the middle
  average,  ///< of codes
  largest,  ///< so that no pixel that differs is lost
};

/// What a pixel of a class map may be.
struct LayerClass {
  std::string name, meaning;
  Rgb color{};
  uint64_t count = 0;
  int rank = 0;  ///< of several pixels the one of the highest rank is shown
};

/// One plane of a page: pixels that can be looked at and read. What `read` borrows must outlive it.
struct PageLayer {
  std::string id;           ///< within the page
  std::string name, about;  ///< for people: a word or two, and a sentence
  Look look = Look::codes;
  bool is_float = false;                   ///< codes are the bits of floats of these widths
  bool is_read = true;                     ///< stands in the line of the pixel that is pointed at
  std::vector<std::string> channel_names;  ///< as many as there are channels
  std::vector<int> widths;                 ///< bits of each channel
  int width = 0, height = 0;
  Reduction reduction = Reduction::sample;
  std::string base;                 ///< of a layer of equal codes that comes before: this one is stored as what differs
  std::vector<LayerClass> classes;  ///< of Look::classes; the code is the index
  JsonObject details;               ///< what the look needs besides
  std::function<void(int x, int y, int count, uint32_t* codes)> read;  ///< of `count` pixels of a row
  std::function<double(uint32_t code, int channel)> value;             ///< of floats; needs FpScope

  size_t channels() const { return channel_names.size(); }
  int bits() const;  ///< of every channel as it is stored in the page: 8, 16 or 32
};

/// An image's texels. Its format tells how they are shown: floats as linear light, fixed point as codes.
PageLayer layer_of_image(const std::string& id, const std::string& name, const std::string& about, const Image& image);
PageLayer layer_of_image(const std::string&, const std::string&, const std::string&, const Image&&) = delete;

/// Numbers of one channel, 0 for nothing: objects.
PageLayer layer_of_ids(const std::string& id, const std::string& name, const std::string& about, const Image& image);

/// Counts as a heat map.
PageLayer layer_of_counts(const std::string& id, const std::string& name, const std::string& about, const Image& image);

/// Values as colours between the least and the most of each channel. Where all are 0 nothing was drawn.
PageLayer layer_of_extents(const std::string& id, const std::string& name, const std::string& about,
                           const Image& image);

/// The same of any layer.
PageLayer shown_by_extents(PageLayer layer);

/// Unit vectors, (N + 1) / 2 as colours.
PageLayer layer_of_directions(const std::string& id, const std::string& name, const std::string& about,
                              const Image& image);

/// The first channels of a layer: planes of three numbers are stored with a fourth that says nothing.
PageLayer first_channels(PageLayer layer, int channels);

/// How far two layers are apart; the page computes it, and holds it itself only where it is reduced.
PageLayer layer_of_difference(const std::string& name, const std::string& about, const PageLayer& from,
                              const PageLayer& to, const std::string& id = "difference");

/// Pixels that are reduced to one where the larger side is over the most that is shown whole; 1 where it is not.
int reduction_of(int width, int height);

/// The layer as a member of the page's manifest, and its pixels as elements `<script type=text/plain>`, whose names
/// begin with the layer's. `base`: the layer that it is stored against, or null.
struct WrittenLayer {
  std::string json, elements;
};
WrittenLayer written(const PageLayer& layer, const PageLayer* base, int threads);

/// RFC 4648, section 4.
std::string base64(std::span<const uint8_t> bytes);

}  // namespace trueshade
