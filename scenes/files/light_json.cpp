#include "scenes/files/light_json.h"

#include <algorithm>
#include <iterator>

#include "scenes/builtin/light_generators.h"
#include "scenes/files/content/scene_files.h"
#include "scenes/files/light_buffers.h"
#include "scenes/files/steps_json.h"
#include "scenes/light_fields.h"
#include "scenes/trig.h"

namespace trueshade {
namespace {

constexpr std::string_view kRingKeys[] = {"type",  "count", "center",    "radius", "height",      "colors",
                                          "noise", "seed",  "intensity", "range",  "attenuation", "turn_s"};
constexpr std::string_view kBoxKeys[] = {"type", "count",     "from",  "to",          "colors", "noise",
                                         "seed", "intensity", "range", "attenuation", "drift",  "drift_s"};
constexpr std::string_view kBuffersKeys[] = {"type", "position", "color", "falloff", "intensity", "range"};

/// The keys of lights of one type, and of their steps. The type's name is the value of the key `type`.
struct LightKeys {
  LightType type;
  std::string step_name;  ///< point_step
  std::vector<std::string_view> keys{"type"}, step_keys{"time"};
  explicit LightKeys(LightType t) : type(t), step_name(std::string(name_of(t)) + "_step") {
    for (const LightField& field : kLightFields)
      if (contains(field.types, t)) keys.push_back(field.key), step_keys.push_back(field.key);
    keys.insert(keys.end(), {"steps", "interpolation", "repeat"});
  }
  json::ObjectKeys of_light() const { return {name_of(type), keys}; }
  json::ObjectKeys of_step() const { return {step_name, step_keys}; }
};

/// In the order of LightType.
const std::vector<LightKeys>& light_keys() {
  static const std::vector<LightKeys> all = [] {
    std::vector<LightKeys> types;
    for (size_t i = 0; i < std::size(kLightTypes); ++i) types.emplace_back(LightType(i));
    return types;
  }();
  return all;
}

/// What stands for many lights, by the value of the key `type`.
constexpr json::ObjectKeys kRing{"ring", kRingKeys}, kBox{"box", kBoxKeys}, kBuffers{"buffers", kBuffersKeys};

std::optional<glm::dvec4> read_direction(const json::Node& object) {
  const auto node = object.find("direction");
  if (!node) return std::nullopt;
  const LightField& field = row_of(LightProperty::direction);
  const glm::dvec3 d = unit(glm::dvec3(node->vec3(float(field.least), float(field.most))));
  if (!(dot(d, d) > 0.5)) node->fail("the direction has no length", "a vector that is not 0");
  return glm::dvec4(d, 0.0);
}

ValueReader reader_of(const LightField& field) {
  if (field.kind == LightValueKind::degrees) return degrees(field.key, field.least, field.most);
  return numbers(field.key, field.kind == LightValueKind::number ? 1 : 3, field.least, field.most);
}

/// Reads the values of one light into it, and what moves of it into the timeline.
class LightReader {
 public:
  LightReader(const json::Node& node, const LightKeys& keys, Scene& scene)
      : node_(node),
        steps_(node, keys.of_step()),
        index_(uint32_t(scene.lights.size())),
        light_(scene.lights.emplace_back()),
        motions_(scene.timeline.lights) {
    light_.type = keys.type;
  }

  void read() {
    for (const LightField& field : kLightFields)
      if (contains(field.types, light_.type)) read(field);
    if (double(light_.cone_rad) + double(light_.penumbra_rad) > kPi + 1e-6)
      node_.fail("cone_deg and penumbra_deg together are over 180", "a sum of at most 180");
  }

 private:
  void read(const LightField& field) {
    if (field.property == LightProperty::color) return read_brightness();
    if (field.property == LightProperty::intensity) return;  // with the colour
    take(field, field.kind == LightValueKind::unit_vector ? steps_.said_direction(field.key, read_direction)
                                                          : steps_.said(field.key, reader_of(field)));
  }

  void take(const LightField& field, Said said) {
    if (field.required && !said.at_all()) node_.member(field.key);  // fails
    if (said.value) set_property(light_, field.property, *said.value);
    if (said.track) motions_.push_back({index_, field.property, std::move(*said.track)});
  }

  /// Colour and intensity move together or not at all, as one multiplies the other.
  void read_brightness() {
    const LightField &of_color = row_of(LightProperty::color), &of_intensity = row_of(LightProperty::intensity);
    Said color = steps_.said(of_color.key, reader_of(of_color));
    Said intensity = steps_.said(of_intensity.key, reader_of(of_intensity));
    const bool moves = color.track || intensity.track;
    const auto standing = [moves](Said& said) {
      if (moves && !said.track) said = {{}, Track{{0.0}, {said.value.value_or(glm::dvec4(1.0))}}};
    };
    standing(color);
    standing(intensity);
    take(of_color, std::move(color));
    take(of_intensity, std::move(intensity));
  }

  const json::Node& node_;
  StepReader steps_;
  uint32_t index_;
  Light& light_;
  std::vector<LightMotion>& motions_;
};

// --- Generators ----------------------------------------------------------------------------------------------------

double real_or(const json::Node& node, std::string_view key, double absent, double least, double most) {
  const auto found = node.find(key);
  return found ? double(found->real(least, most)) : absent;
}

glm::vec3 three_or(const json::Node& node, std::string_view key, const glm::vec3& absent, double least, double most) {
  const auto found = node.find(key);
  return found ? found->vec3(least, most) : absent;
}

std::vector<glm::vec3> read_colors(const json::Node& node) {
  std::vector<glm::vec3> colors;
  if (const auto list = node.find("colors"))
    for (size_t i = 0; i < list->array(1, 64).size(); ++i) colors.push_back(list->element(i).vec3(0.0, json::kLargest));
  return colors.empty() ? std::vector<glm::vec3>{glm::vec3(1.0f)} : colors;
}

/// What all generators have: count, intensity, noise, seed, range, attenuation.
template <typename Generator>
void read_shared(const json::Node& node, Generator& out, size_t lights, const SceneLimits& limits) {
  out.count = uint32_t(node.member("count").integer(1, UINT32_MAX));
  if (lights + out.count > limits.lights)
    node.fail("the lights are over the limit", within_limit(limits.lights, "", "--max-lights"), ErrorKind::limit);
  out.intensity = real_or(node, "intensity", 1.0, 0.0, json::kLargest);
  out.noise = real_or(node, "noise", 0.0, 0.0, 1.0);
  if (const auto seed = node.find("seed")) out.seed = uint64_t(seed->integer(0, 9007199254740991));
  if (const auto range = node.find("range")) out.range = range->real(json::kSmallest, json::kLargest);
  out.attenuation = three_or(node, "attenuation", out.attenuation, 0.0, json::kLargest);
}

void read_ring(const json::Node& node, Scene& scene, const SceneLimits& limits) {
  LightRing ring;
  read_shared(node, ring, scene.lights.size(), limits);
  ring.centre = glm::dvec3(three_or(node, "center", glm::vec3(0.0f), -json::kLargest, json::kLargest));
  ring.centre.y += real_or(node, "height", 0.0, -json::kLargest, json::kLargest);
  ring.radius = double(node.member("radius").real(json::kSmallest, json::kLargest));
  const std::vector<glm::vec3> colors = read_colors(node);
  ring.colors = colors;
  ring.turn_s = real_or(node, "turn_s", 0.0, 0.001, 1e6);
  add_ring(scene, ring);
}

void read_box(const json::Node& node, Scene& scene, const SceneLimits& limits) {
  LightBox box;
  read_shared(node, box, scene.lights.size(), limits);
  box.from = glm::dvec3(node.member("from").vec3(-json::kLargest, json::kLargest));
  box.to = glm::dvec3(node.member("to").vec3(-json::kLargest, json::kLargest));
  const std::vector<glm::vec3> colors = read_colors(node);
  box.colors = colors;
  box.drift = real_or(node, "drift", 0.0, 0.0, json::kLargest);
  box.drift_s = real_or(node, "drift_s", box.drift_s, 0.001, 1e6);
  add_box(scene, box);
}

// --- Buffers -------------------------------------------------------------------------------------------------------

/// Where buffers come from, and how many samples they may have.
struct BufferSource {
  const std::string& path;  ///< of the scene file
  const ImageDecoder& decode;
  const SceneLimits& limits;
  uint64_t most;
};

bool is_exr(const Bytes& content) {
  constexpr uint8_t kMagic[] = {0x76, 0x2f, 0x31, 0x01};
  return content.size() >= std::size(kMagic) && std::equal(std::begin(kMagic), std::end(kMagic), content.begin());
}

std::vector<glm::vec3> samples_from_file(const json::Node& node, const BufferSource& source) {
  const std::string where = source.path + ": " + node.pointer();
  const std::string file = path_from_uri(node.string(), where, source.limits.named_paths);
  const bool table = file.ends_with(".csv");
  if (!table && !file.ends_with(".exr")) node.fail("the ending names no format of a buffer", ".csv or .exr");
  if (!table && !source.decode) node.fail("there is no reader of images here", "a .csv file or numbers");
  const Bytes bytes = SceneFolder(source.path, source.limits.named_paths).read(file, source.limits.file_bytes, where);
  if (table)
    return samples_from_csv({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, where + ": " + file,
                            source.most);
  if (!is_exr(bytes))  // before the reader of pictures, which would name others too
    throw Error(ErrorKind::bad_input, where + ": " + file, "it is no EXR", "a .csv table or an .exr");
  return samples_from_image(source.decode(bytes, where + ": " + file, source.limits.texture_bytes), where + ": " + file,
                            source.most);
}

/// The samples under a key, each number in [least, json::kLargest]; none where the key is absent.
std::vector<glm::vec3> read_buffer(const json::Node& lights, std::string_view key, double least,
                                   const BufferSource& source) {
  const auto node = lights.find(key);
  if (!node) return {};
  if (node->is_array()) {
    std::vector<glm::vec3> samples;
    const size_t count = node->array(0, SIZE_MAX).size();
    if (count > source.most)
      node->fail("the lights are over the limit", within_limit(source.most, "more", "--max-lights"), ErrorKind::limit);
    for (size_t i = 0; i < count; ++i) samples.push_back(node->element(i).vec3(least, json::kLargest));
    return samples;
  }
  std::vector<glm::vec3> samples = samples_from_file(*node, source);
  for (size_t i = 0; i < samples.size(); ++i)
    for (int k = 0; k < 3; ++k)
      if (!(samples[i][k] >= float(least) && samples[i][k] <= float(json::kLargest)))
        node->fail("sample " + std::to_string(i) + " is out of range",
                   "numbers from " + json::number_text(least) + " to 1e+18");
  return samples;
}

void read_buffers(const json::Node& node, Scene& scene, BufferSource source) {
  source.most -= std::min<uint64_t>(source.most, scene.lights.size());
  node.member("position");
  const std::vector<glm::vec3> position = read_buffer(node, "position", -json::kLargest, source);
  const std::vector<glm::vec3> color = read_buffer(node, "color", 0.0, source);
  const std::vector<glm::vec3> falloff = read_buffer(node, "falloff", 0.0, source);
  for (const auto& [key, samples] : {std::pair("color", &color), std::pair("falloff", &falloff)})
    if (node.find(key) && samples->size() != position.size())
      node.fail(std::string("'") + key + "' has " + std::to_string(samples->size()) + " samples, 'position' " +
                    std::to_string(position.size()),
                "as many of each: sample i is light i");
  const double intensity = real_or(node, "intensity", 1.0, 0.0, json::kLargest);
  const auto range = node.find("range");
  for (size_t i = 0; i < position.size(); ++i) {
    Light light;
    light.position = position[i];
    if (!color.empty()) light.color = color[i];
    set_property(light, LightProperty::intensity, glm::dvec4(intensity));
    if (!falloff.empty()) light.attenuation = falloff[i];
    if (range) light.range = range->real(json::kSmallest, json::kLargest);
    scene.lights.push_back(light);
  }
}

/// Reads one element of the list: a light, or what stands for many.
void read_lights_of(const json::Node& node, Scene& scene, const std::string& path, const SceneLimits& limits,
                    const ImageDecoder& decode) {
  std::vector<std::string_view> types;
  for (const LightTypeRow& light : kLightTypes) types.push_back(light.name);
  types.insert(types.end(), {kRing.object, kBox.object, kBuffers.object});
  const std::string_view type = types[node.member("type").choice(types)];
  const auto is = [&](const json::ObjectKeys& keys) {
    if (type != keys.object) return false;
    node.check_keys(keys);
    return true;
  };
  if (is(kRing)) return read_ring(node, scene, limits);
  if (is(kBox)) return read_box(node, scene, limits);
  if (is(kBuffers)) return read_buffers(node, scene, {path, decode, limits, limits.lights});
  for (const LightKeys& light : light_keys())
    if (is(light.of_light())) LightReader(node, light, scene).read();
}

}  // namespace

std::vector<json::ObjectKeys> light_json_keys() {
  std::vector<json::ObjectKeys> all;
  for (const LightKeys& light : light_keys()) all.push_back(light.of_light());
  all.insert(all.end(), {kRing, kBox, kBuffers});
  for (const LightKeys& light : light_keys()) all.push_back(light.of_step());
  return all;
}

void read_lights(const json::Node& list, Scene& scene, const std::string& path, const SceneLimits& limits,
                 const ImageDecoder& decode) {
  const size_t count = list.array(0, SIZE_MAX).size();
  for (size_t i = 0; i < count; ++i) read_lights_of(list.element(i), scene, path, limits, decode);
}

}  // namespace trueshade
