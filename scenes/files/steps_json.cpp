#include "scenes/files/steps_json.h"

#include "scenes/scene.h"
#include "scenes/trig.h"

namespace trueshade {

ValueReader numbers(std::string_view key, int components, double least, double most) {
  return [=](const json::Node& object) -> std::optional<glm::dvec4> {
    const auto node = object.find(key);
    if (!node) return std::nullopt;
    if (components == 1) return glm::dvec4(double(node->real(least, most)), 0.0, 0.0, 0.0);
    return glm::dvec4(glm::dvec3(node->vec3(least, most)), 0.0);
  };
}

ValueReader degrees(std::string_view key, double least, double most) {
  return [=](const json::Node& object) -> std::optional<glm::dvec4> {
    const auto node = object.find(key);
    if (!node) return std::nullopt;
    return glm::dvec4(node->number(least, most) * (kPi / 180.0), 0.0, 0.0, 0.0);
  };
}

StepReader::StepReader(const json::Node& node, const json::ObjectKeys& step_keys)
    : node_(node), steps_(node.find("steps")) {
  for (const std::string_view key : {"interpolation", "repeat"})
    if (const auto found = node.find(key); found && !steps_) found->fail("there are no steps", "add 'steps'");
  if (!steps_) return;
  const auto repeat = node.find("repeat");
  frame_.repeats = repeat && repeat->boolean();
  const size_t count = steps_->array(frame_.repeats ? 2 : 1, SIZE_MAX).size();
  for (size_t i = 0; i < count; ++i) {
    const json::Node step = steps_->element(i), time = step.member("time");
    step.check_keys(step_keys);
    frame_.times.push_back(time.number(-kLatestTime, kLatestTime));
    if (i > 0 && !(frame_.times[i] > frame_.times[i - 1]))
      time.fail("the step is not after the one before", "ascending times");
  }
  constexpr std::string_view kBetween[] = {"linear", "step"};
  if (const auto between = node.find("interpolation")) frame_.between = Between(between->choice(kBetween));
  frame_.start = frame_.times.front();
  frame_.end = frame_.times.back();
}

Said StepReader::said(std::string_view key, const ValueReader& read) const {
  Said said{read(node_), {}};
  if (!steps_) return said;
  Track track = frame_;
  track.times.clear();
  for (size_t i = 0; i < frame_.times.size(); ++i) {
    const json::Node step = steps_->element(i);
    const std::optional<glm::dvec4> value = read(step);
    if (!value) continue;
    if (said.value) step.fail("'" + std::string(key) + "' is given outside the steps too", "one of them");
    track.times.push_back(frame_.times[i]);
    track.values.push_back(*value);
  }
  if (!track.times.empty()) said.track = std::move(track);
  return said;
}

Said StepReader::said_direction(std::string_view key, const ValueReader& read) const {
  Said said = this->said(key, read);
  if (!said.track) return said;
  for (size_t i = 1; i < said.track->values.size(); ++i) {
    const glm::dvec3 a(said.track->values[i - 1]), b(said.track->values[i]);
    if (said.track->between == Between::linear && !(dot(a, b) > -0.999999))
      steps_->fail("'" + std::string(key) + "' turns round between two steps", "a step between them");
  }
  return said;
}

}  // namespace trueshade
