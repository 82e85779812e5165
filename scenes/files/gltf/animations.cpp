#include "scenes/files/gltf/animations.h"

#include <algorithm>
#include <map>
#include <set>

namespace trueshade::gltf {
namespace {

std::vector<double> times_of(Accessors& accessors, uint32_t accessor) {
  std::vector<double> times = accessors.doubles(accessor, 0);
  const Accessor& a = accessors.at(accessor);
  const bool has_data = a.view != kNone || a.sparse.has_value();  // without, all times are 0: as if there were one
  for (size_t i = 0; has_data && i < times.size(); ++i)
    if (times[i] < 0.0 || (i > 0 && !(times[i] > times[i - 1])))
      accessors.document().fail(pointer_to("accessors", accessor),
                                "time " + std::to_string(i) + " is negative or not above the one before it",
                                "ascending times from 0 on");
  return times;
}

/// Values of a sampler's output, four components each; those that the accessor does not have are 0.
std::vector<glm::dvec4> values_of(Accessors& accessors, uint32_t accessor) {
  const Accessor& a = accessors.at(accessor);
  std::vector<glm::dvec4> values;
  for (uint32_t k = 0; k < components_of(a.shape); ++k) {
    const std::vector<double> component = accessors.doubles(accessor, k);
    values.resize(component.size(), glm::dvec4(0.0));
    for (size_t i = 0; i < component.size(); ++i) values[i][int(k)] = component[i];
  }
  return values;
}

void make_unit(Track& track, const Accessors& accessors, uint32_t accessor) {
  for (size_t i = 0; i < track.values.size(); ++i) {
    if (!is_nearly_unit(track.values[i]))
      accessors.document().fail(pointer_to("accessors", accessor),
                                "the rotation of step " + std::to_string(i) + " is not of unit length",
                                "quaternions of length 1");
    track.values[i] = unit(track.values[i]);
  }
}

/// Times without data are all 0. Of such steps the last is kept, which holds from 0 on: times of a track ascend.
template <typename AnyTrack>
void keep_one_of_equal_times(AnyTrack& track, size_t values_a_step) {
  if (track.times.size() < 2 || track.times.back() > track.times.front()) return;
  const auto keep_last = [](auto& list, size_t count) {
    if (!list.empty()) list.erase(list.begin(), list.end() - ptrdiff_t(count));
  };
  keep_last(track.times, 1);
  for (auto* values : {&track.values, &track.arriving, &track.leaving}) keep_last(*values, values_a_step);
}

/// A copy of a track that a channel of the same sampler has given.
Track copied_track(Accessors& accessors, const Track& track, uint32_t accessor) {
  const uint64_t values = track.values.size() + track.arriving.size() + track.leaving.size();
  accessors.take(track.times.size() * sizeof(double) + values * sizeof(glm::dvec4), pointer_to("accessors", accessor));
  return track;
}

}  // namespace

std::vector<SceneAnimation> animations_of(const Document& document) {
  std::vector<SceneAnimation> out;
  for (const AnimationSource& from : document.animations) {
    SceneAnimation& animation = out.emplace_back(SceneAnimation{from.name, 0.0});
    for (const AnimationSampler& sampler : from.samplers)
      animation.seconds = std::max(animation.seconds, document.accessors[sampler.input].largest.value_or(0.0));
  }
  return out;
}

std::optional<AnimationSource> played_animation(const Document& document, const std::optional<std::string>& named,
                                                uint64_t& passed_over) {
  const std::vector<AnimationSource>& all = document.animations;
  if (named && *named != kAllAnimations) return all[animation_named(*named, animations_of(document), document.file)];
  if (all.empty()) return std::nullopt;
  if (!named) return all.front();
  AnimationSource together;
  std::set<std::pair<uint32_t, Path>> moved;
  for (const AnimationSource& animation : all) {
    for (Channel channel : animation.channels) {
      if (channel.node != kNone && channel.path != Path::unknown && !moved.emplace(channel.node, channel.path).second) {
        ++passed_over;
        continue;
      }
      channel.sampler += uint32_t(together.samplers.size());
      together.channels.push_back(channel);
    }
    together.samplers.insert(together.samplers.end(), animation.samplers.begin(), animation.samplers.end());
  }
  return together;
}

Track track_of(Accessors& accessors, const AnimationSource& animation, const Channel& channel) {
  const AnimationSampler& sampler = animation.samplers[channel.sampler];
  Track track;
  track.times = times_of(accessors, sampler.input);
  std::vector<glm::dvec4> values = values_of(accessors, sampler.output);
  track.between = sampler.between;
  if (sampler.between == Between::cubic) {
    for (size_t i = 0; i < track.times.size(); ++i) {
      track.arriving.push_back(values[3 * i]);
      track.values.push_back(values[3 * i + 1]);
      track.leaving.push_back(values[3 * i + 2]);
    }
  } else {
    track.values = std::move(values);
  }
  if (channel.path == Path::rotation) {
    if (track.between == Between::linear) track.between = Between::slerp;
    make_unit(track, accessors, sampler.output);
  }
  keep_one_of_equal_times(track, 1);
  return track;
}

WeightTrack weight_track_of(Accessors& accessors, const AnimationSource& animation, const Channel& channel) {
  const AnimationSampler& sampler = animation.samplers[channel.sampler];
  WeightTrack track;
  track.times = times_of(accessors, sampler.input);
  track.between = sampler.between;
  const std::vector<double> values = accessors.doubles(sampler.output, 0);
  const size_t parts = sampler.between == Between::cubic ? 3 : 1;
  track.count = uint32_t(values.size() / (track.times.size() * parts));
  if (parts == 1) track.values = values;
  for (size_t i = 0; parts == 3 && i < values.size(); ++i) {
    const size_t part = i / track.count % 3;
    (part == 0 ? track.arriving : part == 1 ? track.values : track.leaving).push_back(values[i]);
  }
  keep_one_of_equal_times(track, track.count);
  return track;
}

std::vector<NodeMotion> node_motions(Accessors& accessors, const AnimationSource& animation,
                                     const Hierarchy& hierarchy) {
  std::map<uint32_t, ObjectMotion> motions;                  // by place in the hierarchy
  std::map<std::pair<uint32_t, bool>, const Track*> tracks;  // in `motions`, by sampler and whether it turns
  for (const Channel& channel : animation.channels) {
    if (channel.node == kNone || channel.path == Path::weights || channel.path == Path::unknown) continue;
    const uint32_t place = hierarchy.placed[channel.node];
    if (place == kNone) continue;
    const auto [found, is_new] = motions.try_emplace(place);
    if (is_new) found->second.rest = accessors.document().nodes[channel.node].placement;
    ObjectMotion& motion = found->second;
    std::optional<Track>& track = channel.path == Path::translation ? motion.position
                                  : channel.path == Path::rotation  ? motion.rotation
                                                                    : motion.scale;
    const Track*& read = tracks[{channel.sampler, channel.path == Path::rotation}];
    track = read ? copied_track(accessors, *read, animation.samplers[channel.sampler].output)
                 : track_of(accessors, animation, channel);
    if (!read) read = &*track;  // no other channel moves the same, so it stays as it is
  }
  std::vector<NodeMotion> out;
  for (auto& [place, motion] : motions) out.push_back({place, std::move(motion)});
  return out;
}

}  // namespace trueshade::gltf
