#include "scenes/scene_parts.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <span>

#include "core/error.h"
#include "core/likeliest_name.h"

namespace trueshade {
namespace {

/// The names of one part; empty ones are none.
using PartNames = std::array<std::string_view, 2>;

/// `0 'Front', 1 'Camera.001' of node 'Side', 2`.
std::string listed(std::span<const PartNames> parts) {
  constexpr size_t kMostListed = 20;
  const auto quoted = [](std::string_view name) { return " '" + std::string(name) + '\''; };
  std::string list;
  for (size_t i = 0; i < std::min(parts.size(), kMostListed); ++i) {
    const auto [own, node] = parts[i];
    list += (i > 0 ? ", " : "") + std::to_string(i);
    if (!own.empty()) list += quoted(own);
    if (!node.empty() && node != own) list += (own.empty() ? "" : " of node") + quoted(node);
  }
  return parts.size() > kMostListed ? list + " and " + std::to_string(parts.size() - kMostListed) + " more" : list;
}

/// `kind`: camera or animation, which is the option's name too.
size_t part_named(const std::string& kind, const std::string& text, std::span<const PartNames> parts,
                  const std::string& file, const std::string& more) {
  const std::string option = "--" + kind;
  size_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error == std::errc() && end == text.data() + text.size() && number < parts.size()) return number;
  std::vector<size_t> found;
  std::vector<std::string_view> names;
  for (size_t i = 0; i < parts.size(); ++i) {
    names.insert(names.end(), parts[i].begin(), parts[i].end());
    if (!text.empty() && std::find(parts[i].begin(), parts[i].end(), text) != parts[i].end()) found.push_back(i);
  }
  if (found.size() == 1) return found.front();
  const std::string list = parts.empty() ? "leave it out" : "it has, by number: " + listed(parts) + more;
  if (found.empty())
    throw Error(ErrorKind::usage, option, file + " has no " + kind + " '" + text + "'",
                did_you_mean(text, names) + list);
  throw Error(ErrorKind::usage, option,
              file + " has " + std::to_string(found.size()) + ' ' + kind + "s of the name '" + text + "'", list);
}

}  // namespace

size_t camera_named(const std::string& text, const std::vector<SceneCamera>& cameras, const std::string& file) {
  std::vector<PartNames> parts;
  for (const SceneCamera& camera : cameras) parts.push_back({camera.name, camera.node});
  if (parts.empty()) parts.emplace_back();
  return part_named("camera", text, parts, file, "");
}

size_t animation_named(const std::string& text, const std::vector<SceneAnimation>& animations,
                       const std::string& file) {
  std::vector<PartNames> parts;
  for (const SceneAnimation& animation : animations) parts.push_back({animation.name, {}});
  return part_named("animation", text, parts, file, std::string(", or ") + kAllAnimations);
}

}  // namespace trueshade
