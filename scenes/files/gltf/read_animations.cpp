#include <algorithm>
#include <set>

#include "scenes/files/gltf/reading.h"

namespace trueshade::gltf {
namespace {

AnimationSampler read_sampler(const json::Node& node, const Counts& counts, const Document& document) {
  constexpr std::string_view kNames[] = {"LINEAR", "STEP", "CUBICSPLINE"};
  constexpr Between kKinds[] = {Between::linear, Between::step, Between::cubic};
  AnimationSampler sampler;
  const json::Node input = node.member("input"), output = node.member("output");
  sampler.input = index(input, counts.accessors, "accessor");
  sampler.output = index(output, counts.accessors, "accessor");
  if (const auto interpolation = node.find("interpolation")) sampler.between = kKinds[interpolation->choice(kNames)];
  const Accessor& times = document.accessors[sampler.input];
  if (times.shape != Shape::scalar || times.type != Component::float32)
    input.fail("the accessor is not of times", "SCALAR of component type 5126");
  if (sampler.between == Between::cubic && times.count < 2)
    input.fail("a cubic spline has fewer than two steps", "two or more");
  return sampler;
}

Channel read_channel(const json::Node& node, const Counts& counts, size_t samplers) {
  constexpr std::string_view kPaths[] = {"translation", "rotation", "scale", "weights"};
  Channel channel;
  channel.sampler = index(node.member("sampler"), uint32_t(samplers), "sampler");
  const json::Node target = node.member("target");
  channel.path = Path(known_or_other(target.member("path"), kPaths));
  channel.node = index_or_none(target, "node", counts.nodes, "node");
  extensions_of(target);
  return channel;
}

/// Whether an accessor's type goes with what it moves.
bool is_allowed(const Accessor& a, Path path) {
  using enum Component;
  const bool small = a.normalized && (a.type == int8 || a.type == uint8 || a.type == int16 || a.type == uint16);
  if (path == Path::rotation) return a.shape == Shape::vec4 && (a.type == float32 || small);
  if (path == Path::weights) return a.shape == Shape::scalar && (a.type == float32 || small);
  return a.shape == Shape::vec3 && a.type == float32;
}

void check_channel(const json::Node& node, const Channel& channel, const AnimationSource& animation,
                   const Document& document) {
  const AnimationSampler& sampler = animation.samplers[channel.sampler];
  const Accessor &times = document.accessors[sampler.input], &values = document.accessors[sampler.output];
  if (!is_allowed(values, channel.path))
    node.fail("the type of the sampler's output does not go with the path", "a type of glTF 2.0, 3.11");
  const NodeSource& moved = document.nodes[channel.node];
  uint64_t each = 1;
  if (channel.path == Path::weights) {
    each = moved.mesh == kNone ? 0 : document.meshes[moved.mesh].primitives.front().targets.size();
    if (each == 0) node.fail("the node has no mesh with targets to weigh", "a mesh with targets");
  } else if (moved.matrix) {
    node.fail("the node has a matrix", "translation, rotation and scale instead");
  }
  if (sampler.between == Between::cubic) each *= 3;
  if (values.count != times.count * each)
    node.fail(
        "the sampler has " + std::to_string(values.count) + " values for " + std::to_string(times.count) + " times",
        std::to_string(each) + " a time");
}

AnimationSource read_animation(const json::Node& node, const Counts& counts, const Document& document) {
  AnimationSource animation;
  animation.name = string_or_empty(node, "name");
  node.member("samplers"), node.member("channels");
  for_each(node, "samplers", [&](const json::Node& element, size_t) {
    animation.samplers.push_back(read_sampler(element, counts, document));
  });
  std::set<std::pair<uint32_t, Path>> moved;
  for_each(node, "channels", [&](const json::Node& element, size_t) {
    const Channel channel = read_channel(element, counts, animation.samplers.size());
    animation.channels.push_back(channel);
    if (channel.node == kNone || channel.path == Path::unknown) return;
    check_channel(element, channel, animation, document);
    if (!moved.emplace(channel.node, channel.path).second)
      element.fail("another channel moves the same", "one channel a node and path");
  });
  return animation;
}

}  // namespace

void read_animations(const json::Node& root, const Counts& counts, Document& document) {
  for_each(root, "animations", [&](const json::Node& node, size_t) {
    document.animations.push_back(read_animation(node, counts, document));
  });
}

}  // namespace trueshade::gltf
