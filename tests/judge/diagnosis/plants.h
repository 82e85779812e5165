#pragma once
#include <initializer_list>

#include "tests/judge/diagnosis/planted.h"

namespace trueshade::testing {

// The types of Plant's fields, for tables of plants.
using Input = std::function<bool(Scene&, Pipeline&, int)>;
using Output = std::function<void(const Scene&, const Pipeline&, oracle::Capture&, int)>;
using Names = std::vector<std::string_view>;

/// The size of a variant; those beyond the last begin again.
inline float pick(std::initializer_list<float> sizes, int variant) {
  return sizes.begin()[size_t(variant) % sizes.size()];
}

inline float dot_of(const glm::vec3& a, const glm::vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

/// A plane of the capture by its name; null where the capture has none.
inline Image* plane_of(oracle::Capture& capture, std::string_view name) {
  for (NamedImage& p : capture.planes)
    if (p.name == name) return &p.image;
  return nullptr;
}

/// A base that culls back faces.
inline void culled_back(Scene&, Pipeline& p) { p.geometry.cull_face = CullFace::back; }

const std::vector<Plant>& plants_of_pictures();
const std::vector<Plant>& plants_of_planes();
const std::vector<Plant>& plants_of_scenes();
const std::vector<Plant>& plants_of_lights();
const std::vector<Plant>& plants_of_materials();
const std::vector<Plant>& plants_of_filters();
const std::vector<Plant>& plants_of_gloss();

}  // namespace trueshade::testing
