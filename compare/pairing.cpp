#include "compare/pairing.h"

#include <algorithm>

namespace trueshade::compare {
namespace {

std::string size_text(const ChannelFile& part) {
  return std::to_string(part.width) + 'x' + std::to_string(part.height);
}

std::string window_text(const ChannelFile& part) {
  if (!part.is_window()) return "the whole picture";
  return std::to_string(part.left) + ',' + std::to_string(part.top) + " of " + std::to_string(part.frame_width) + 'x' +
         std::to_string(part.frame_height);
}

std::string part_name(const ChannelFile& part) { return part.channels.empty() ? "" : part.channels.front().part; }

const ChannelFile* part_named(const PictureFile& picture, const std::string& name) {
  for (const ChannelFile& part : picture.parts)
    if (part_name(part) == name) return &part;
  return nullptr;
}

const Channel* channel_named(const ChannelFile& part, const std::string& name) {
  for (const Channel& channel : part.channels)
    if (channel.name == name) return &channel;
  return nullptr;
}

/// The channels of `from` that `other` lacks: `channels N.X, N.Y`.
std::string lacking(const ChannelFile& from, const ChannelFile& other) {
  constexpr size_t kMostShown = 8;
  std::vector<std::string> names;
  for (const Channel& channel : from.channels)
    if (channel_named(other, channel.name) == nullptr) names.push_back(channel.name);
  if (names.empty()) return {};
  if (names.size() == 1 && names[0] == "A") return "alpha (channel A)";
  std::string text = names.size() == 1 ? "channel " : "channels ";
  for (size_t i = 0; i < std::min(names.size(), kMostShown); ++i) text += (i > 0 ? ", " : "") + names[i];
  return names.size() <= kMostShown ? text : text + " and " + std::to_string(names.size() - kMostShown) + " more";
}

class PartPairing {
 public:
  PartPairing(std::string name, Pairing& out) : name_(std::move(name)), out_(out) {}

  void pair(const ChannelFile& reference, const ChannelFile& test) {
    const std::string of = name_.empty() ? "" : " of part " + name_;
    if (reference.width != test.width || reference.height != test.height) {
      out_.mismatches.push_back("the size" + of + " is " + size_text(reference) + " in the reference and " +
                                size_text(test) + " in the test");
      return;
    }
    if (window_text(reference) != window_text(test)) {
      out_.mismatches.push_back("the window" + of + " is " + window_text(reference) + " in the reference and " +
                                window_text(test) + " in the test");
      return;
    }
    PartPair part{name_, reference.width, reference.height, {}};
    if (reference.channels.size() == 1 && test.channels.size() == 1) {
      part.channels.push_back({shown(reference.channels[0]), &reference.channels[0], &test.channels[0]});
    } else {
      say(lacking(reference, test), of, "the test has no ");
      say(lacking(test, reference), of, "the reference has no ");
      for (const Channel& channel : reference.channels)
        if (const Channel* same = channel_named(test, channel.name))
          part.channels.push_back({shown(channel), &channel, same});
    }
    if (!part.channels.empty()) out_.parts.push_back(std::move(part));
  }

 private:
  void say(const std::string& channels, const std::string& of, const char* who) {
    if (channels.empty()) return;
    const bool is_alpha = channels.starts_with("alpha");
    out_.mismatches.push_back(who + channels + of + (is_alpha ? " (--channels RGB compares the others)" : ""));
  }
  std::string shown(const Channel& channel) const { return name_.empty() ? channel.name : name_ + '.' + channel.name; }

  std::string name_;
  Pairing& out_;
};

}  // namespace

Pairing paired(const PictureFile& reference, const PictureFile& test) {
  Pairing pairing;
  if (reference.parts.size() == 1 && test.parts.size() == 1) {
    PartPairing("", pairing).pair(reference.parts[0], test.parts[0]);
    return pairing;
  }
  for (const ChannelFile& part : reference.parts) {
    const std::string name = part_name(part);
    if (const ChannelFile* same = part_named(test, name))
      PartPairing(name, pairing).pair(part, *same);
    else
      pairing.mismatches.push_back("the test has no part '" + name + "'");
  }
  for (const ChannelFile& part : test.parts)
    if (part_named(reference, part_name(part)) == nullptr)
      pairing.mismatches.push_back("the reference has no part '" + part_name(part) + "'");
  return pairing;
}

}  // namespace trueshade::compare
