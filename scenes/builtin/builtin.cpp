#include "scenes/builtin/builtin.h"

#include <algorithm>
#include <array>
#include <charconv>

#include "core/error.h"
#include "core/fp_env.h"
#include "core/likeliest_name.h"
#include "scenes/builtin/builtin_scenes.h"

namespace trueshade {
namespace builtin {

Light point_light(const glm::dvec3& position, const glm::dvec3& color, double range) {
  Light light;
  light.position = glm::vec3(position);
  light.color = glm::vec3(color);
  light.range = float(range);
  light.attenuation = {1.0f, float(1.0 / range), float(10.0 / (range * range))};
  return light;
}

void add_moving(Scene& scene, const Light& light, const glm::dvec3& u, const glm::dvec3& v, double period,
                double phase) {
  scene.timeline.orbits.push_back(
      {uint32_t(scene.lights.size()), light.position, glm::vec3(u), glm::vec3(v), float(period), float(phase)});
  scene.lights.push_back(light);
}

glm::dvec2 even_point(uint32_t index) {
  const double x = 0.5 + 0.7548776662466927 * index, y = 0.5 + 0.5698402909980532 * index;
  return {x - std::floor(x), y - std::floor(y)};
}

glm::dvec3 color_of_hue(double hue, double saturation) {
  const double t = (hue - std::floor(hue)) * 6.0;
  glm::dvec3 color(0.0);
  for (int k = 0; k < 3; ++k) {
    const double turned = t + 2.0 * double((3 - k) % 3);  // red is brightest at 0, green at 2, blue at 4
    const double around = turned >= 6.0 ? turned - 6.0 : turned;
    const double away = around > 3.0 ? 6.0 - around : around;  // 0 at the channel's own hue, 3 opposite it
    const double level = 2.0 - away;
    color[k] = 1.0 - saturation * (1.0 - (level < 0.0 ? 0.0 : level > 1.0 ? 1.0 : level));
  }
  return color;
}

}  // namespace builtin
namespace {

struct Row {
  BuiltinInfo info;
  Scene (*make)(const builtin::Parameters&);
  uint32_t most_objects;  ///< 0: the scene has no parameter `objects`
  bool has_glass = false;
};

constexpr std::array<Row, 8> kRows{{
    {{"city", "a city at night: 2,490 cubes under 757 street and roof lamps"}, builtin::city, 1u << 20},
    {{"rabbits", "125 rabbits of 40,000 triangles each under 100 lamps"}, builtin::rabbits, 1u << 20},
    {{"sphere", "a sphere of 20,000 faces between 100 overlapping lights"}, builtin::sphere, 0},
    {{"red", "a canyon of 4 million vertices under ambient, point and spot lights, 100 in all"}, builtin::red, 0},
    {{"cornell", "the Cornell box with two blocks and coloured lights"}, builtin::cornell, 0},
    {{"circle", "lights on a circle, coloured by a ramp and noise, around a torus knot"}, builtin::circle, 1u << 20},
    {{"lecture", "a textured room under 14 sweeping spot lights"}, builtin::lecture, 0},
    {{"atrium", "a hall of arches with a fountain under 256 warm and cool lamps"}, builtin::atrium, 0, true},
}};

std::string joined_names() {
  std::string names;
  for (const Row& row : kRows) names += (names.empty() ? "" : " ") + std::string(row.info.name);
  return names;
}

/// What a spec says, piece by piece; knows the spec for its errors.
class SpecReader {
 public:
  explicit SpecReader(std::string_view spec) : spec_(spec), rest_(spec) {}

  const Row& scene() {
    const std::string_view name = piece();
    for (const Row& row : kRows)
      if (row.info.name == name) return row;
    std::vector<std::string_view> names;
    for (const Row& row : kRows) names.push_back(row.info.name);
    fail("no built-in scene has this name", did_you_mean(name, names) + "one of " + joined_names());
  }

  builtin::Parameters parameters(const Row& row, const SceneLimits& limits) {
    builtin::Parameters p;
    bool has_seed = false, has_radius = false, has_glass = false;
    while (more_) {
      const std::string_view text = piece();
      const size_t equals = text.find('=');
      const std::string key(text.substr(0, equals));
      if (equals == std::string_view::npos) fail("'" + key + "' has no value", "write key=value");
      const std::string_view value = text.substr(equals + 1);
      if (key == "lights" && !p.lights) {
        p.lights = uint32_t(number(key, value, 0, UINT32_MAX));
        if (*p.lights > limits.lights)
          throw Error(ErrorKind::limit, where(), "lights=" + std::string(value) + " is over the limit of lights",
                      within_limit(limits.lights, "", "--max-lights"));
      } else if (key == "objects" && row.most_objects > 0 && !p.objects) {
        p.objects = uint32_t(number(key, value, 1, row.most_objects));
      } else if (key == "seed" && !has_seed) {
        p.seed = number(key, value, 0, UINT64_MAX);
        has_seed = true;
      } else if (key == "glass" && row.has_glass && !has_glass) {
        p.glass = number(key, value, 0, 1) == 1;
        has_glass = true;
      } else if (key == "radius" && !has_radius) {
        if (value != "overlap" && value != "constant")
          fail("radius is '" + std::string(value) + "'", "overlap or constant");
        p.constant_radius = value == "constant";
        has_radius = true;
      } else {
        std::vector<std::string_view> keys{"lights", "seed"};
        if (row.most_objects > 0) keys.emplace_back("objects");
        if (row.has_glass) keys.emplace_back("glass");
        keys.emplace_back("radius");
        std::string all;
        for (const std::string_view name : keys) all += ' ' + std::string(name);
        const bool is_known = std::find(keys.begin(), keys.end(), key) != keys.end();
        fail("the key '" + key + "' is unknown here or given twice",
             (is_known ? std::string() : did_you_mean(key, keys)) + "keys are" + all);
      }
    }
    return p;
  }

 private:
  std::string where() const { return "builtin:" + std::string(spec_); }

  [[noreturn]] void fail(const std::string& reason, const std::string& remedy) const {
    throw Error(ErrorKind::bad_input, where(), reason, remedy);
  }

  std::string_view piece() {
    const size_t comma = rest_.find(',');
    const std::string_view text = rest_.substr(0, comma);
    more_ = comma != std::string_view::npos;
    rest_ = more_ ? rest_.substr(comma + 1) : std::string_view();
    return text;
  }

  uint64_t number(const std::string& key, std::string_view text, uint64_t least, uint64_t most) const {
    uint64_t value = 0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (code != std::errc() || end != text.data() + text.size() || value < least || value > most)
      fail(key + " is '" + std::string(text) + "'",
           "a whole number from " + std::to_string(least) + " to " + std::to_string(most));
    return value;
  }

  std::string_view spec_, rest_;
  bool more_ = true;
};

}  // namespace

std::span<const BuiltinInfo> builtin_scenes() {
  static const auto infos = [] {
    std::array<BuiltinInfo, kRows.size()> list;
    for (size_t i = 0; i < list.size(); ++i) list[i] = kRows[i].info;
    return list;
  }();
  return infos;
}

Scene builtin_scene(std::string_view spec, const SceneLimits& limits) {
  const FpScope fp;
  SpecReader reader(spec);
  const Row& row = reader.scene();
  Scene scene = row.make(reader.parameters(row, limits));
  scene.spec = "builtin:" + std::string(spec);
  validate(scene, limits);
  return scene;
}

}  // namespace trueshade
