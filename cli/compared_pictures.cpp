#include "cli/compared_pictures.h"

#include <algorithm>

#include "cli/judged_comparison.h"
#include "cli/notes.h"
#include "core/error.h"
#include "core/memory_cap.h"

namespace trueshade {

uint64_t flip_memory(uint64_t pixels) {
  constexpr uint64_t kPlanes = 3 + 3, kMaps = 2, kOfBands = uint64_t(64) << 20;  // light of both; the map and it sorted
  return pixels * 4 * (kPlanes + kMaps) + kOfBands;
}

namespace {

/// Keeps the channels that were asked for. Error(bad_input) where the picture lacks one.
void keep_channels(const std::vector<std::string>& names, PictureFile& picture) {
  std::string there;
  std::vector<std::string> missing = names;
  for (ChannelFile& part : picture.parts) {
    for (const Channel& channel : part.channels) there += (there.empty() ? "" : " ") + channel.name;
    std::erase_if(part.channels, [&](const Channel& channel) {
      std::erase(missing, channel.name);
      return std::find(names.begin(), names.end(), channel.name) == names.end();
    });
  }
  if (!missing.empty())
    throw Error(ErrorKind::bad_input, picture.path, "it has no channel " + missing.front(),
                "--channels takes those that it has: " + there);
  std::erase_if(picture.parts, [](const ChannelFile& part) { return part.channels.empty(); });
}

/// The first row becomes the last.
void turn_rows(PictureFile& picture) {
  for (ChannelFile& part : picture.parts) {
    if (part.is_window()) part.top = part.frame_height - part.top - part.height;
    for (Channel& channel : part.channels)
      for (int y = 0; y < part.height / 2; ++y) {
        const auto row = channel.words.begin() + int64_t(y) * part.width,
                   other = channel.words.begin() + int64_t(part.height - 1 - y) * part.width;
        std::swap_ranges(row, row + part.width, other);
      }
  }
}

/// Error(usage) for a bound that no difference of codes is beyond.
void check_bounds(const ComparedPictures& pictures, std::span<const compare::Criterion> criteria) {
  int most_bits = 0;
  for (const PictureFile* picture : {&pictures.reference, &pictures.test})
    for (const ChannelFile& part : picture->parts)
      for (const Channel& channel : part.channels) {
        if (!channel.is_code()) return;
        most_bits = std::max(most_bits, channel.bits);
      }
  for (const compare::Criterion& row : criteria) {
    if (row.measure == compare::Measure::largest_ulp && row.bound >= double((uint64_t(1) << most_bits) - 1))
      throw Error(ErrorKind::usage, "--max-ulp",
                  "the pictures hold codes of " + std::to_string(most_bits) + " bits, so it lets every difference pass",
                  "give a smaller number of codes");
    const bool is_largest = row.measure == compare::Measure::largest_difference;
    if ((is_largest ? row.bound : row.delta) < 1.0) continue;
    throw Error(ErrorKind::usage, is_largest ? "--max-difference" : "--delta",
                "the pictures hold codes, which stand for 0 to 1, so it lets every difference pass",
                "give a fraction, like 2/255");
  }
}

}  // namespace

std::optional<PictureFile> mask_file(const CompareOptions& options) {
  if (options.mask.file.empty()) return std::nullopt;
  return read_any_picture(options.mask.file, options.limits.expansion);
}

ComparedPictures compared_pictures(const std::string& reference, const std::string& test, const CompareOptions& options,
                                   const std::optional<PictureFile>& mask) {
  ComparedPictures pictures;
  pictures.reference = read_any_picture(reference, options.limits.expansion);
  pictures.test = read_any_picture(test, options.limits.expansion);
  if (options.bottom_up) turn_rows(pictures.test);
  compare::CompareRules rules = options.rules;
  if (options.mask.any()) {
    rules.mask = compare::mask_of_pair(options.mask, mask ? &*mask : nullptr, pictures.reference, pictures.test);
    pictures.mask = rules.mask, pictures.left_out_by = options.mask.text();
  }
  if (!options.channels.empty())
    keep_channels(options.channels, pictures.reference), keep_channels(options.channels, pictures.test);
  const ChannelFile& part = pictures.reference.parts.front();
  const auto& criteria = options.rules.criteria;
  if (options.rules.wants_flip ||
      std::any_of(criteria.begin(), criteria.end(), [](const auto& row) { return compare::is_flip(row.measure); }))
    require_memory(flip_memory(uint64_t(part.width) * uint64_t(part.height)), reference, "FLIP");
  check_bounds(pictures, rules.criteria);
  pictures.comparison = compare::compared(pictures.reference, pictures.test, rules);
  if (const auto& flip = pictures.comparison.flip; flip && !flip->exposures)
    for (const std::string& name : options.of_flip)
      if (name == "--tone-mapper" || name == "--exposures")
        pictures.comparison.notes.push_back(name + " does nothing: these colours are a screen's, unless --hdr is said");
  for (const compare::IgnoredIds& ids : options.mask.ignored) {
    PixelMask alone{part.width, part.height, std::vector<uint8_t>(size_t(part.width) * size_t(part.height))};
    compare::leave_out_ids(pictures.reference, ids, alone), compare::leave_out_ids(pictures.test, ids, alone);
    if (alone.count() == 0)
      pictures.comparison.notes.push_back("--ignore " + ids.text() + " leaves nothing out: neither picture has it");
  }
  for (const PictureFile* picture : {&pictures.reference, &pictures.test})
    if (is_lenient(picture->metadata))
      pictures.comparison.notes.push_back(picture->path +
                                          " is no reference: it was drawn with --lenient of a file with faults");
  const compare::Comparison& c = pictures.comparison;
  if (options.judges() && c.outcome == compare::Outcome::different && c.differences.not_finite_pixels == 0)
    pictures.judged = judged_by_scene(pictures, options);
  return pictures;
}

}  // namespace trueshade
