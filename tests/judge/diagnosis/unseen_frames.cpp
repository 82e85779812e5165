#include "tests/judge/diagnosis/unseen_frames.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>

#include "shading/given_surfaces.h"
#include "tests/judge/captured.h"

namespace trueshade::testing {
namespace {

Image& plane_of(oracle::Capture& capture, std::string_view name) {
  return std::find_if(capture.planes.begin(), capture.planes.end(), [&](auto& p) { return p.name == name; })->image;
}

/// Codes of rgba8 from a picture of floats; alpha stays.
void store(const FloatPicture& picture, Image& target) {
  for (int y = 0; y < target.height; ++y)
    for (int x = 0; x < target.width; ++x)
      for (int c = 0; c < 3; ++c)
        target.set_code(x, y, c, uint32_t(std::lround(255.0 * std::clamp(picture.at(x, y)[c], 0.0, 1.0))));
}

bool has_surface(const oracle::Capture& capture, int x, int y) {
  return capture.plane("id.object")->value(x, y, 0) > 0;
}

FloatPicture sum_of(const Subject& subject) {
  Pipeline floats = subject.pipeline;
  floats.target = Format::rgba32f, floats.light_model.clamp_result = false;  // clamped where it is stored
  return floats_of(render_frame(subject.scene, floats).color);
}

}  // namespace

const glm::dvec3& FloatPicture::near(int x, int y) const {
  return at(std::clamp(x, 0, width - 1), std::clamp(y, 0, height - 1));
}

FloatPicture floats_of(const Image& image) {
  FloatPicture out{image.width, image.height, std::vector<glm::dvec3>(size_t(image.width) * size_t(image.height))};
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < 3; ++c) out.at(x, y)[c] = image.value(x, y, c);
  return out;
}

oracle::Capture right_of(const Subject& subject) { return captured(subject.scene, subject.pipeline); }

oracle::Capture drawn_with(const Subject& subject, const SceneChange& change) {
  Subject wrong = subject;
  change(wrong.scene, wrong.pipeline);
  return captured(wrong.scene, wrong.pipeline);
}

oracle::Capture lit_with(const Subject& subject, const SceneChange& change) {
  oracle::Capture capture = right_of(subject);
  capture.color = drawn_with(subject, change).color;
  return capture;
}

oracle::Capture pictured_with(const Subject& subject, const PictureChange& change) {
  oracle::Capture capture = right_of(subject);
  FloatPicture picture = sum_of(subject);
  change(picture, capture);
  store(picture, capture.color);
  return capture;
}

std::vector<FloatPicture> terms_of(const Subject& subject) {
  std::vector<std::string> names;
  for (size_t i = 0; i < subject.scene.lights.size(); ++i) names.push_back("light." + std::to_string(i));
  std::vector<FloatPicture> terms;
  for (const NamedImage& plane : render_frame(subject.scene, subject.pipeline, {}, names).aovs)
    terms.push_back(floats_of(plane.image));
  return terms;
}

oracle::Capture weighted_with(const Subject& subject, const LightWeight& weight) {
  const std::vector<FloatPicture> terms = terms_of(subject);
  return pictured_with(subject, [&](FloatPicture& picture, const oracle::Capture& right) {
    const FloatPicture positions = floats_of(*right.plane("position"));
    for (int y = 0; y < picture.height; ++y)
      for (int x = 0; x < picture.width; ++x) {
        glm::dvec3 sum(0.0), weighted(0.0);  // of terms in which the albedo may be missing, so their ratio counts
        for (size_t i = 0; has_surface(right, x, y) && i < terms.size(); ++i)
          sum += terms[i].at(x, y), weighted += terms[i].at(x, y) * weight(i, positions.at(x, y), x, y);
        for (int c = 0; c < 3; ++c)
          if (sum[c] > 0) picture.at(x, y)[c] *= weighted[c] / sum[c];
      }
  });
}

size_t strongest_light(const Subject& subject) {
  const std::vector<FloatPicture> terms = terms_of(subject);
  size_t strongest = 0;
  double most = -1;
  for (size_t i = 0; i < terms.size(); ++i) {
    double sum = 0;
    for (const glm::dvec3& t : terms[i].texels) sum += std::min(1.0, t.x + t.y + t.z);
    if (subject.scene.lights[i].type != LightType::ambient && sum > most) most = sum, strongest = i;
  }
  return strongest;
}

oracle::Capture stored_with(const Subject& subject, std::string_view name, const PlaneChange& change) {
  oracle::Capture capture = right_of(subject);
  const oracle::Capture right = capture;
  Image& plane = plane_of(capture, name);
  for (int y = 0; y < plane.height; ++y)
    for (int x = 0; x < plane.width; ++x) {
      if (!has_surface(right, x, y)) continue;
      const glm::dvec3 value = change({plane.value(x, y, 0), plane.value(x, y, 1), plane.value(x, y, 2)}, x, y, right);
      for (int c = 0; c < 3; ++c) {
        const auto number = float(value[c]);
        uint32_t bits = uint32_t(std::lround(255.0 * std::clamp(value[c], 0.0, 1.0)));
        if (info(plane.format).number_class == NumberClass::floating) std::memcpy(&bits, &number, sizeof bits);
        plane.set_code(x, y, c, bits);
      }
    }
  GivenSurfaces given{capture.plane("depth"),  capture.plane("id.object"), capture.plane("position"),
                      capture.plane("normal"), capture.plane("albedo"),    capture.plane("specular"),
                      capture.plane("emission")};
  given.clear_depth = subject.pipeline.geometry.clear_depth;
  capture.color = light_surfaces(subject.scene, subject.pipeline, {}, given).color;
  return capture;
}

size_t seen_object(const Subject& subject, size_t rank) {
  const oracle::Capture right = right_of(subject);
  const Image& ids = *right.plane("id.object");
  std::map<size_t, int> counts;
  for (int y = 0; y < ids.height; ++y)
    for (int x = 0; x < ids.width; ++x)
      if (ids.code(x, y, 0) > 0) ++counts[ids.code(x, y, 0) - 1];
  std::vector<std::pair<int, size_t>> seen;
  for (const auto& [object, pixels] : counts) seen.emplace_back(-pixels, object);
  std::sort(seen.begin(), seen.end());
  return seen[std::min(rank, seen.size() - 1)].second;
}

}  // namespace trueshade::testing
