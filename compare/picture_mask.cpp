#include "compare/picture_mask.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "compare/stored_value.h"

namespace trueshade::compare {
namespace {

std::string size_text(int width, int height) { return std::to_string(width) + 'x' + std::to_string(height); }

std::string place_text(size_t pixel, int width) {
  return std::to_string(pixel % size_t(width)) + ',' + std::to_string(pixel / size_t(width));
}

MaskError bad_mask(const std::string& where, const std::string& reason) {
  return {where, reason,
          "0 leaves a pixel out, and 1 or the largest code, white, looks at it: save the mask with these two alone"};
}

/// 0 or 1; nothing of what is neither.
std::optional<uint8_t> bit_of(const Channel& channel, size_t pixel) {
  const uint32_t word = channel.words[pixel];
  const double value = channel.kind == ChannelKind::floating ? channel.value(pixel) : double(word);
  if (value == 0.0) return uint8_t(0);
  const bool is_largest = channel.kind != ChannelKind::floating && word == channel.largest_code();
  return value == 1.0 || is_largest ? std::optional<uint8_t>(uint8_t(1)) : std::nullopt;
}

bool is_opaque(const Channel& channel) {
  const auto is_full = [&](uint32_t word) {
    return channel.kind == ChannelKind::floating ? word == 0x3f800000u : word == channel.largest_code();
  };
  return channel.name == "A" && std::all_of(channel.words.begin(), channel.words.end(), is_full);
}

std::vector<uint8_t> bits_of(const ChannelFile& part, const Channel& channel, const std::string& where) {
  std::vector<uint8_t> looked_at(channel.words.size());
  for (size_t i = 0; i < looked_at.size(); ++i) {
    const std::optional<uint8_t> bit = bit_of(channel, i);
    if (!bit)
      throw bad_mask(where, "channel " + channel.name + " of the mask is " + stored_text(channel, i, false) + " at " +
                                place_text(i, part.width));
    looked_at[i] = *bit;
  }
  return looked_at;
}

std::string percent_text(uint64_t part, uint64_t all) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g %%", 100.0 * double(part) / double(all));
  return text;
}

}  // namespace

bool IgnoredIds::has(uint32_t id) const {
  return std::any_of(ranges.begin(), ranges.end(), [id](const auto& r) { return r.first <= id && id <= r.second; });
}

std::string IgnoredIds::text() const {
  std::string list;
  for (const auto& [first, last] : ranges) {
    if (!list.empty()) list += ',';
    list += std::to_string(first);
    if (last > first) list.append("-").append(std::to_string(last));
  }
  return plane + '=' + list;
}

std::string MaskRules::text() const {
  std::string list = file;
  for (const IgnoredIds& ids : ignored) list += (list.empty() ? "" : ", ") + ids.text();
  return list;
}

PixelMask mask_of(const PictureFile& file, int width, int height) {
  if (file.parts.size() != 1)
    throw MaskError(file.path, "the mask has " + std::to_string(file.parts.size()) + " parts", "give a file of one");
  const ChannelFile& part = file.parts.front();
  if (part.width != width || part.height != height || part.is_window())
    throw MaskError(file.path,
                    part.is_window() ? "the mask is a window of a larger picture"
                                     : "the mask is " + size_text(part.width, part.height) + ", and what it masks is " +
                                           size_text(width, height),
                    "give one of the same size");
  PixelMask mask{width, height, {}};
  std::vector<uint8_t> looked_at;
  for (const Channel& channel : part.channels) {
    if (part.channels.size() > 1 && is_opaque(channel)) continue;
    const std::vector<uint8_t> bits = bits_of(part, channel, file.path);
    if (looked_at.empty()) looked_at = bits;
    const auto other = std::mismatch(bits.begin(), bits.end(), looked_at.begin()).first;
    if (other != bits.end())
      throw bad_mask(file.path, "the mask's channels contradict each other at " +
                                    place_text(size_t(other - bits.begin()), part.width));
  }
  for (const uint8_t bit : looked_at) mask.left_out.push_back(bit ^ 1);
  return mask;
}

bool leave_out_ids(const PictureFile& picture, const IgnoredIds& ignored, PixelMask& mask) {
  bool found = false;
  for (const ChannelFile& part : picture.parts)
    for (const Channel& channel : part.channels) {
      if (channel.name != ignored.plane || channel.words.size() != mask.left_out.size()) continue;
      found = true;
      for (size_t i = 0; i < channel.words.size(); ++i) {
        const double id = channel.is_code() ? double(channel.words[i]) : channel.value(i);
        if (!(id >= 0 && id <= 4294967295.0 && id == std::floor(id)))
          throw MaskError(picture.path,
                          ignored.plane + " at " + place_text(i, part.width) + " is " + stored_text(channel, i, false) +
                              ", and an identifier is a whole number",
                          "store the channel as uint");
        if (ignored.has(uint32_t(id))) mask.left_out[i] = 1;
      }
    }
  return found;
}

void check_left_out(const MaskRules& rules, uint64_t left_out, uint64_t all, const char* what) {
  const bool by_file = !rules.file.empty();
  const std::string where = by_file ? rules.file : "--ignore",
                    what_a_mask_is = by_file ? "0 leaves a pixel out, and 1 or white looks at it: " : "";
  if (all > 0 && left_out == all)
    throw MaskError(where, "all " + std::to_string(all) + ' ' + what + " are left out",
                    what_a_mask_is + "leave something to look at");
  if (rules.allow || double(left_out) <= kMostLeftOut * double(all)) return;
  throw MaskError(where,
                  std::to_string(left_out) + " of " + std::to_string(all) + ' ' + what + " are left out, " +
                      percent_text(left_out, all) + ", and at most 10 % may be",
                  what_a_mask_is + "leave out less, or " + rules.leave);
}

PixelMask mask_of_pair(const MaskRules& rules, const PictureFile* mask_file, const PictureFile& reference,
                       const PictureFile& test) {
  if (!rules.any()) return {};
  const ChannelFile& first = reference.parts.front();
  for (const ChannelFile& part : reference.parts)
    if (part.width != first.width || part.height != first.height)
      throw MaskError(reference.path, "its parts have several sizes, and a mask has one", "compare files of one part");
  PixelMask mask{first.width, first.height, {}};
  if (mask_file != nullptr)
    mask = mask_of(*mask_file, first.width, first.height);
  else
    mask.left_out.resize(size_t(first.width) * size_t(first.height));
  for (const IgnoredIds& ids : rules.ignored) {
    const bool in_reference = leave_out_ids(reference, ids, mask), in_test = leave_out_ids(test, ids, mask);
    if (!in_reference && !in_test)
      throw MaskError("--ignore", "neither picture has a channel " + ids.plane,
                      "write one (render --aov " + ids.plane + "), or give a --mask");
  }
  check_left_out(rules, mask.count(), mask.left_out.size(), "pixels");
  return mask;
}

}  // namespace trueshade::compare
