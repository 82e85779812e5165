#pragma once
// Frames with a fault, by where it happens: in what is drawn, in what is lit, in a plane, in the picture.
#include <functional>
#include <glm/vec3.hpp>
#include <string_view>
#include <vector>

#include "tests/judge/diagnosis/unseen_faults.h"

namespace trueshade::testing {

using SceneChange = std::function<void(Scene&, Pipeline&)>;
/// All is drawn wrong, planes and picture.
oracle::Capture drawn_with(const Subject& subject, const SceneChange& change);
/// The planes are right, the picture is that of the changed scene.
oracle::Capture lit_with(const Subject& subject, const SceneChange& change);

/// A picture of floats, R, G and B, rows from the top.
struct FloatPicture {
  int width = 0, height = 0;
  std::vector<glm::dvec3> texels;
  glm::dvec3& at(int x, int y) { return texels[size_t(y) * size_t(width) + size_t(x)]; }
  const glm::dvec3& at(int x, int y) const { return texels[size_t(y) * size_t(width) + size_t(x)]; }
  const glm::dvec3& near(int x, int y) const;  ///< of the nearest pixel that there is
};
FloatPicture floats_of(const Image& image);

/// The planes are right, the picture is `change` of what the right lights sum up to before it is stored in codes.
using PictureChange = std::function<void(FloatPicture&, const oracle::Capture& right)>;
oracle::Capture pictured_with(const Subject& subject, const PictureChange& change);

/// The planes are right, and light i at a surface (that position) is `weight` times what it adds.
using LightWeight = std::function<double(size_t light, const glm::dvec3& position, int x, int y)>;
oracle::Capture weighted_with(const Subject& subject, const LightWeight& weight);
/// What each light adds alone.
std::vector<FloatPicture> terms_of(const Subject& subject);
/// The light that adds most to the picture; ambient ones are left out.
size_t strongest_light(const Subject& subject);

/// A plane is stored wrongly where there is a surface, and lit from as it is. `change` takes the value and the
/// capture's right planes.
using PlaneChange = std::function<glm::dvec3(const glm::dvec3& value, int x, int y, const oracle::Capture& right)>;
oracle::Capture stored_with(const Subject& subject, std::string_view plane, const PlaneChange& change);

/// The object that is seen in the most pixels but `rank`, transparent ones left out.
size_t seen_object(const Subject& subject, size_t rank);

oracle::Capture right_of(const Subject& subject);

}  // namespace trueshade::testing
