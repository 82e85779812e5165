#include "cli/pages/channel_layers.h"

#include <algorithm>
#include <bit>

#include "cli/pages/page.h"
#include "core/image_rows.h"

namespace trueshade {
namespace {

using compare::ChannelPair;

/// A channel's layer, and its place in it: N.X is X of N; R, G, B and A belong to no layer.
std::pair<std::string, std::string> split_name(const std::string& name) {
  const size_t dot = name.rfind('.');
  return dot == std::string::npos ? std::pair<std::string, std::string>("", name)
                                  : std::pair(name.substr(0, dot), name.substr(dot + 1));
}

bool is_letter_of(std::string_view letters, const std::string& name) {
  return name.size() == 1 && letters.find(name[0]) != std::string_view::npos;
}

/// The index of a channel in its layer, 0 to 3. The last part of the channel's name gives it: R, G, B, A or X, Y, Z, W.
size_t place_of(const ChannelPair& pair) {
  const std::string last = split_name(pair.name).second;
  const size_t rgba = std::string_view("RGBA").find(last), xyzw = std::string_view("XYZW").find(last);
  return std::min(last.size() == 1 ? std::min(rgba, xyzw) : std::string_view::npos, size_t(99));
}

bool same_storage(const ChannelGroup& group) {
  return std::all_of(group.channels.begin(), group.channels.end(), [&](const ChannelPair* pair) {
    const Channel &a = *pair->reference, &b = *pair->test, &first = *group.channels.front()->reference;
    return a.kind == b.kind && a.bits == b.bits && a.kind == first.kind && a.bits == first.bits;
  });
}

/// One side of a group. `as_values`: floats of what the numbers stand for.
PageLayer layer_of_side(const ChannelGroup& group, bool is_test, bool as_values, bool decode, const std::string& id) {
  PageLayer layer;
  layer.id = id;
  layer.width = group.width, layer.height = group.height;
  std::vector<const Channel*> channels;
  for (const ChannelPair* pair : group.channels) {
    const Channel& channel = is_test ? *pair->test : *pair->reference;
    channels.push_back(&channel);
    layer.is_float = as_values || channel.kind == ChannelKind::floating;
    layer.widths.push_back(layer.is_float ? 32 : channel.bits);
    layer.channel_names.push_back(group.channels.size() == 1 ? "" : split_name(pair->name).second);
  }
  layer.value = [](uint32_t code, int) { return double(std::bit_cast<float>(code)); };
  layer.read = [channels, width = size_t(group.width), as_values, decode](int x, int y, int count, uint32_t* codes) {
    for (size_t pixel = size_t(y) * width + size_t(x), end = pixel + size_t(count); pixel < end; ++pixel)
      for (const Channel* channel : channels) {
        const double value = as_values ? channel->value(pixel) : 0;
        const double shown = decode && compare::is_color(*channel) ? compare::linear_of_srgb(value) : value;
        *codes++ = as_values ? std::bit_cast<uint32_t>(float(shown)) : channel->words[pixel];
      }
  };
  return layer;
}

}  // namespace

std::string name_suffix(const ChannelGroup& group) {
  if (!group.name.empty()) return " " + group.name;
  const std::string& first = group.channels.front()->name;
  return is_letter_of("RGBA", split_name(first).second) ? "" : " " + first;
}

std::vector<ChannelGroup> channel_groups(const compare::Pairing& pairing) {
  std::vector<ChannelGroup> groups;
  for (const compare::PartPair& part : pairing.parts) {
    std::vector<ChannelGroup> of_part;
    for (const ChannelPair& pair : part.channels) {
      const auto [layer, last] = split_name(pair.name);
      const bool is_grouped = is_letter_of("RGBAXYZWUV", last);
      const std::string name = is_grouped ? layer : pair.name;
      const auto known = std::find_if(of_part.begin(), of_part.end(), [&](const ChannelGroup& g) {
        return is_grouped && g.name == name && is_letter_of("RGBAXYZWUV", split_name(g.channels[0]->name).second);
      });
      if (known != of_part.end() && known->channels.size() < 4)
        known->channels.push_back(&pair);
      else
        of_part.push_back({name, part.width, part.height, {&pair}});
    }
    groups.insert(groups.end(), of_part.begin(), of_part.end());
  }
  for (ChannelGroup& group : groups)
    std::stable_sort(group.channels.begin(), group.channels.end(),
                     [](const ChannelPair* a, const ChannelPair* b) { return place_of(*a) < place_of(*b); });
  std::stable_partition(groups.begin(), groups.end(), [](const ChannelGroup& g) {
    return g.channels.size() >= 3 && split_name(g.channels[0]->name).second == "R";
  });
  return groups;
}

GroupLayers layers_of(const ChannelGroup& group, const compare::Decoding& decoding, const std::string& ids) {
  const bool as_values = !same_storage(group) || group.channels.front()->reference->kind == ChannelKind::snorm;
  GroupLayers both{layer_of_side(group, false, as_values, decoding.reference, ids + "-reference"),
                   layer_of_side(group, true, as_values, decoding.test, ids + "-test")};
  const Channel& first = *group.channels.front()->reference;
  const bool is_color =
      place_of(*group.channels.front()) == 0 && split_name(group.channels.front()->name).second == "R";
  if (both.reference.is_float) {
    both.reference.look = both.test.look = Look::linear;
    if (!is_color) {
      both.reference = shown_by_extents(std::move(both.reference));
      both.test.look = Look::extent,
      both.test.details = both.reference.details;  // so that equal values look equal
    }
  } else if (first.kind == ChannelKind::integer) {
    both.reference.look = both.test.look = Look::ids;
  } else {
    both.reference.reduction = both.test.reduction = Reduction::average;
  }
  const std::string what = name_suffix(group);
  both.reference.name = "Reference" + what, both.test.name = "Test" + what;
  both.reference.about = as_values ? "What the reference's numbers stand for." : "The reference, as it is stored.";
  both.test.about = as_values ? "What the test's numbers stand for." : "The test, as it is stored.";
  both.test.base = both.reference.id;
  return both;
}

Image picture_of_layer(const PageLayer& layer) {
  // Every n-th pixel is enough of what is shown reduced anyway.
  const int step = (std::max(layer.width, layer.height) + kLargestFigure - 1) / kLargestFigure;
  Image picture((layer.width + step - 1) / step, (layer.height + step - 1) / step,
                layer.is_float ? Format::rgba32f : Format::rgba8);
  std::vector<uint32_t> row(size_t(layer.width) * layer.channels());
  for (int y = 0; y < picture.height; ++y) {
    layer.read(0, y * step, layer.width, row.data());
    for (int x = 0; x < picture.width; ++x)
      for (size_t k = 0; k < 3; ++k) {
        const size_t channel = layer.channels() < 3 ? 0 : k;
        const uint32_t code = row[size_t(x * step) * layer.channels() + channel];
        const uint64_t largest = (uint64_t(1) << layer.widths[channel]) - 1;
        picture.set_code(x, y, int(k),
                         layer.is_float ? code : uint32_t((code * uint64_t(255) + largest / 2) / largest));
        picture.set_code(x, y, 3, layer.is_float ? std::bit_cast<uint32_t>(1.0f) : 255);
      }
  }
  return picture;
}

}  // namespace trueshade
