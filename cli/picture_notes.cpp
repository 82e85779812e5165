#include "cli/picture_notes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "cli/preparation.h"
#include "core/fp_env.h"
#include "core/image_rows.h"
#include "core/srgb.h"
#include "shading/output/view_image.h"

namespace trueshade {
namespace {

/// Computes the determinant by Gaussian elimination with column pivoting. The matrix counts as singular if the
/// determinant's magnitude is not above 1e-12 times p, where p is the product of each column's largest magnitude. A
/// determinant that is NaN counts as singular too.
bool is_singular(const std::array<float, 16>& column_major) {
  std::array<std::array<double, 4>, 4> m{};
  double determinant = 1.0, scale = 1.0;
  for (size_t c = 0; c < 4; ++c) {
    double largest = 0.0;
    for (size_t r = 0; r < 4; ++r) {
      m[r][c] = double(column_major[4 * c + r]);
      largest = std::max(largest, std::fabs(m[r][c]));
    }
    scale *= largest;
  }
  for (size_t c = 0; c < 4; ++c) {
    const auto larger = [c](const auto& a, const auto& b) { return std::fabs(a[c]) < std::fabs(b[c]); };
    std::swap(m[c], *std::max_element(m.begin() + std::ptrdiff_t(c), m.end(), larger));
    if (m[c][c] == 0.0) return true;
    determinant *= m[c][c];
    for (size_t r = c + 1; r < 4; ++r)
      for (size_t k = 4; k-- > c;) m[r][k] -= m[r][c] / m[c][c] * m[c][k];
  }
  return !(std::fabs(determinant) > 1e-12 * scale);
}

/// The alpha of a picture aside, whether every channel of every pixel is 0.
bool is_black(const Image& picture) {
  const int channels = std::min(info(picture.format).channels, 3);
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x)
      for (int c = 0; c < channels; ++c)
        if (picture.code(x, y, c) != 0) return false;
  return true;
}

}  // namespace

std::string empty_note(const Scene& scene, const FrameStats& stats) {
  if (stats.covered_pixels == 0 && stats.transparent_fragments == 0) {
    if (stats.triangles == 0) return "Nothing is drawn: The scene has no triangles";
    if (scene.camera.clip_from_world && is_singular(*scene.camera.clip_from_world))
      return "Nothing is drawn: The matrix clip_from_world of the camera is singular, or nearly, so that it takes the "
             "scene to a "
             "plane, a line or a point (its elements stand column by column)";
    return "Nothing is drawn: None of " + std::to_string(stats.triangles) +
           " triangles covers a pixel (the camera may look past the scene or stand beyond its near and far planes, "
           "and cull_face may leave out the side that it sees)";
  }
  return {};
}

namespace {

/// Why nothing of the scene is to be seen; empty where something is.
std::string black_note(const Scene& scene, const Pipeline& pipeline, const Frame& frame) {
  if (std::string empty = empty_note(scene, frame.stats); !empty.empty()) return empty;
  if (pipeline.view != ImageView::lit || !is_black(frame.color)) return {};
  if (scene.lights.empty()) return "The picture is black: The scene has no lights";
  const bool has_flat = std::any_of(scene.lights.begin(), scene.lights.end(),
                                    [](const Light& l) { return has_area(l.type) && row_of(l.type).is_aimed; });
  return "The picture is black: None of its " + std::to_string(scene.lights.size()) +
         " lights brightens a surface (their ranges may be too short, their colours 0, or the surfaces may face "
         "away; " +
         (has_flat ? "rectangles and disks shine to one side, cross(up, right); " : "") +
         "--view normal and --view light-count show which)";
}

/// Pixels with a channel above 1, of a format of floats.
size_t pixels_above_1(const Image& picture) {
  const FpScope fp;
  const size_t channels = size_t(std::min(info(picture.format).channels, 3)), width = size_t(picture.width);
  std::vector<float> row(channels * width);
  size_t count = 0;
  for (int y = 0; y < picture.height; ++y) {
    read_row(picture, y, int(channels), row.data());
    for (size_t x = 0; x < width; ++x) {
      bool any = false;
      for (size_t c = 0; c < channels; ++c) any |= row[channels * x + c] > 1.0f;
      count += any ? 1 : 0;
    }
  }
  return count;
}

/// Pixels with a channel at the largest value that the format holds.
size_t clamped_pixels(const Image& picture) {
  const FormatInfo layout = info(picture.format);
  const size_t pixels = size_t(picture.width) * size_t(picture.height);
  size_t clamped = 0;
  if (layout.bytes_per_channel == 1) {
    const uint8_t* texel = picture.texels.data();
    for (size_t i = 0; i < pixels; ++i, texel += 4) clamped += std::max({texel[0], texel[1], texel[2]}) == 255 ? 1 : 0;
    return clamped;
  }
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      bool any = false;
      for (int c = 0; c < 3; ++c) any = any || picture.code(x, y, c) == layout.largest_code(c);
      clamped += any ? 1 : 0;
    }
  return clamped;
}

/// Whether pixels without a surface stand at the largest value, as on a white background.
bool is_clear_clamped(const Scene& scene, const Pipeline& pipeline, const FormatInfo& layout) {
  const float brightest = std::max({scene.clear.r, scene.clear.g, scene.clear.b});
  if (layout.number_class == NumberClass::floating) return brightest > 1.0f;
  if (layout.srgb || pipeline.post.encode != PostChain::Encode::linear) return brightest >= float(kSrgbCodeStarts[254]);
  return brightest >= 1.0f - 0.5f / float(layout.largest_code(0));
}

/// How many pixels of a picture have a surface; of averaged samples, their share. All where that is not known, as of
/// glass alone.
size_t pixels_with_surface(const FrameStats& stats, size_t pixels) {
  if (stats.covered_pixels == 0 || stats.pixels == 0) return pixels;
  return size_t(std::llround(double(pixels) * double(stats.covered_pixels) / double(stats.pixels)));
}

/// How much of what is drawn stands at the largest value that a picture's format holds, or that a PNG of it does.
std::string clamp_note(const Scene& scene, const Pipeline& pipeline, const Frame& frame, bool to_png, bool exposed) {
  constexpr size_t kLeastPercent = 5;
  const Image& picture = frame.color;
  const FormatInfo layout = info(picture.format);
  const bool floats = layout.number_class == NumberClass::floating;
  if (pipeline.view != ImageView::lit || pipeline.post.tone_map != PostChain::ToneMap::none || (floats && !to_png))
    return {};
  if (!floats && layout.number_class != NumberClass::unorm) return {};
  const size_t pixels = size_t(picture.width) * size_t(picture.height),
               drawn = pixels_with_surface(frame.stats, pixels);
  const size_t empty = is_clear_clamped(scene, pipeline, layout) ? pixels - drawn : 0;
  const size_t all_clamped = floats ? pixels_above_1(picture) : clamped_pixels(picture);
  const size_t clamped = std::min(all_clamped - std::min(all_clamped, empty), drawn);
  if (100 * clamped < kLeastPercent * drawn || clamped == 0) return {};
  const std::string share =
      std::to_string(clamped) + " of " + std::to_string(drawn) + " pixels with a surface have a channel ";
  const std::string bring = exposed ? ")" : ", and --exposure auto brings it into range)";
  if (floats)
    return share + "above 1, the largest value of a PNG: Brighter light is cut off there (an EXR keeps it" + bring;
  return share + "at 1, the largest value of " + std::string(layout.name) +
         ": Brighter light is cut off there (--target rgba16f keeps it" + bring;
}

/// Says so where a screen shows next to nothing of a picture that is not black.
std::string dim_note(const Pipeline& pipeline, const Frame& frame, bool exposed) {
  const Image& picture = frame.color;
  constexpr double kDim = 10.0 / 255.0, kDimLight = 0.003;  // the light that sRGB has as 10 of 255
  constexpr int kShownPercent = 1;
  const FormatInfo layout = info(picture.format);
  if (pipeline.view != ImageView::lit || exposed || layout.number_class == NumberClass::integer) return {};
  const bool is_light = layout.srgb || layout.number_class == NumberClass::floating;
  const size_t pixels = size_t(picture.width) * size_t(picture.height);
  const uint64_t covered = std::max<uint64_t>(frame.stats.covered_pixels, 1);
  const FpScope fp;
  size_t shown = 0;
  std::vector<float> row(3 * size_t(picture.width));
  for (int y = 0; y < picture.height; ++y) {
    read_row(picture, y, 3, row.data());
    for (size_t x = 0; x < row.size(); x += 3)
      shown += std::max({row[x], row[x + 1], row[x + 2]}) > float(is_light ? kDimLight : kDim) ? 1 : 0;
    if (100 * shown > kShownPercent * std::min<uint64_t>(covered, pixels)) return {};
  }
  if (is_black(picture)) return {};
  return "The picture is nearly black: A screen shows " + std::to_string(pixels - shown) + " of " +
         std::to_string(pixels) + " pixels darker than 10 of 255 (" + (is_light ? "" : "--target rgba16f with ") +
         "--exposure auto brings light into range)";
}

/// How many pixels are no numbers, which a picture does not show: a PNG has 0 for NaN.
std::string nan_note(const Pipeline& pipeline, const Image& picture) {
  if (info(picture.format).number_class != NumberClass::floating || pipeline.view != ImageView::lit) return {};
  size_t count = 0;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      bool any = false;
      for (int c = 0; c < 3; ++c) any = any || std::isnan(picture.value(x, y, c));
      count += any ? 1 : 0;
    }
  if (count == 0) return {};
  return std::to_string(count) + " of " + std::to_string(size_t(picture.width) * size_t(picture.height)) +
         " pixels are NaN: Their light is no number, as that of a root of less than 0 (trueshade explain --pixel X,Y "
         "says where it first became so)";
}

/// Says so where a model's camera sees next to nothing of it.
std::string nearly_empty_note(const Scene& scene, const FrameStats& stats) {
  constexpr uint64_t kLeastOf = 500;
  const uint64_t seen = stats.covered_pixels + stats.transparent_fragments;
  if (!scene.is_model || seen == 0 || seen >= stats.pixels / kLeastOf) return {};
  return "The camera sees next to nothing: " + std::to_string(seen) + " of " + std::to_string(stats.pixels) +
         " pixels are covered (--orbit 30,20 shows all that is drawn)";
}

/// Says so where an orthographic camera of a model has another shape than the picture.
std::string stretched_note(const Scene& scene, const Pipeline& pipeline) {
  constexpr double kLeast = 1.01;
  const auto& matrix = scene.camera.clip_from_world;
  if (!scene.is_model || !scene.camera.matrix_has_gl_range || !matrix) return {};
  const auto row = [&m = *matrix](size_t r) { return glm::dvec3(m[r], m[4 + r], m[8 + r]); };
  if (row(3) != glm::dvec3(0.0)) return {};
  const FpScope fp;
  const double wide = glm::length(row(1)) / glm::length(row(0)), of_picture = aspect_of(pipeline);
  if (!(wide > 0.0) || std::max(wide / of_picture, of_picture / wide) < kLeast) return {};
  const int width = wide >= 1.0 ? pipeline.width : std::max(1, int(std::lround(pipeline.height * wide))),
            height = wide >= 1.0 ? std::max(1, int(std::lround(pipeline.width / wide))) : pipeline.height;
  return "The file's orthographic camera has another shape than the picture, so that all is stretched (--size " +
         std::to_string(width) + 'x' + std::to_string(height) + " has the camera's)";
}

/// Says so where the boxes of the view light-boxes hide nearly all of what is drawn.
std::string hidden_note(const Pipeline& pipeline, const Image& picture) {
  constexpr int kHiddenPercent = 90;
  if (pipeline.view != ImageView::light_boxes) return {};
  const size_t pixels = size_t(picture.width) * size_t(picture.height);
  size_t black = 0, empty = 0;
  for (size_t i = 0; i < pixels; ++i) {
    const uint8_t* texel = &picture.texels[4 * i];
    black += texel[0] == 0 && texel[1] == 0 && texel[2] == 0 ? 1 : 0;
    empty += std::equal(texel, texel + 3, kEmptyColor) ? 1 : 0;
  }
  const size_t percent = 100 * black / std::max<size_t>(pixels - empty, 1);
  if (percent < kHiddenPercent) return {};
  return "The view light-boxes is black on " + std::to_string(percent) +
         " % of what is drawn: Boxes are black solids, and the boxes of these lights cover what is behind them "
         "(--view light-edges shows their edges alone)";
}

}  // namespace

std::vector<std::string> picture_notes(const Scene& scene, const Pipeline& pipeline, const Frame& frame, bool to_png,
                                       bool exposed) {
  std::vector<std::string> notes;
  for (std::string note :
       {black_note(scene, pipeline, frame), clamp_note(scene, pipeline, frame, to_png, exposed),
        nan_note(pipeline, frame.color), hidden_note(pipeline, frame.color), nearly_empty_note(scene, frame.stats),
        stretched_note(scene, pipeline), dim_note(pipeline, frame, exposed)})
    if (!note.empty()) notes.push_back(std::move(note));
  return notes;
}

}  // namespace trueshade
