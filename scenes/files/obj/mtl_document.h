#pragma once
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

// What an MTL file says, as plain values.
namespace trueshade::obj {

/// A picture that a statement names, with its options.
struct MapSource {
  std::string file;  ///< as written
  uint32_t line = 0;
  float bump = 1.0f;       ///< -bm
  glm::vec2 offset{0.0f};  ///< -o
  glm::vec2 scale{1.0f};   ///< -s
  bool clamp = false;      ///< -clamp
};

/// One material. Names of fields are those of the statements in small letters; absent ones were not given.
struct MtlMaterial {
  std::string name;
  uint32_t line = 0;
  std::optional<glm::vec3> kd, ks, ke;
  std::optional<float> ns, d, pr, pm;
  int illum = 2;
  std::optional<MapSource> map_kd, map_ks, map_ke, map_d, map_bump, norm, map_pr, map_pm;
};

struct MtlDocument {
  std::string file;                             ///< stands in errors
  std::vector<MtlMaterial> materials;           ///< of different names
  std::map<std::string, uint64_t> passed_over;  ///< statements and options that nothing is made of, how often each
};

}  // namespace trueshade::obj
