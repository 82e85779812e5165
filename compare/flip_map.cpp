// Andersson et al., "FLIP" (2020; see flip_filters.cpp): section 4.1 the colour pipeline, 4.2 the features, 4.3 how
// both become one error. Separable filters, a band of rows at a time: a band needs its neighbours' rows as far as the
// filters reach, and recomputes them.
#include "compare/flip_map.h"

#include <algorithm>
#include <cmath>

#include "compare/flip_filters.h"
#include "core/threads/parallel_for.h"

namespace trueshade::compare {
namespace {

constexpr int kFlipBandRows = 64;

using Vec3 = std::array<double, 3>;
using Matrix = std::array<Vec3, 3>;

constexpr Matrix inverse(const Matrix& m) {
  const auto cofactor = [&m](size_t r, size_t c) {
    const size_t r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
    return m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1];
  };
  const double determinant = m[0][0] * cofactor(0, 0) + m[0][1] * cofactor(0, 1) + m[0][2] * cofactor(0, 2);
  Matrix out{};
  for (size_t r = 0; r < 3; ++r)
    for (size_t c = 0; c < 3; ++c) out[c][r] = cofactor(r, c) / determinant;
  return out;
}

/// XYZ of linear RGB, each over that of white, from the chromaticities of sRGB (IEC 61966-2-1): so white is 1, 1, 1.
constexpr Matrix relative_xyz_matrix() {
  constexpr double kX[] = {0.64, 0.30, 0.15}, kY[] = {0.33, 0.60, 0.06}, kWhiteX = 0.3127, kWhiteY = 0.3290;
  Matrix primaries{};
  for (size_t c = 0; c < 3; ++c)
    primaries[0][c] = kX[c] / kY[c], primaries[1][c] = 1.0, primaries[2][c] = (1.0 - kX[c] - kY[c]) / kY[c];
  const Vec3 white = {kWhiteX / kWhiteY, 1.0, (1.0 - kWhiteX - kWhiteY) / kWhiteY};
  const Matrix back = inverse(primaries);
  for (size_t c = 0; c < 3; ++c) {
    const double luminance = back[c][0] * white[0] + back[c][1] * white[1] + back[c][2] * white[2];
    for (size_t r = 0; r < 3; ++r) primaries[r][c] *= luminance / white[r];
  }
  return primaries;
}

struct FloatMatrix {
  float m[3][3] = {};
  constexpr explicit FloatMatrix(const Matrix& from) {
    for (size_t r = 0; r < 3; ++r)
      for (size_t c = 0; c < 3; ++c) m[r][c] = float(from[r][c]);
  }
  std::array<float, 3> times(float a, float b, float c) const {
    return {m[0][0] * a + m[0][1] * b + m[0][2] * c, m[1][0] * a + m[1][1] * b + m[1][2] * c,
            m[2][0] * a + m[2][1] * b + m[2][2] * c};
  }
};

/// Computed by the compiler: before main() a host's rounding mode or traps may be in force.
constexpr FloatMatrix kXyzOfRgb{relative_xyz_matrix()}, kRgbOfXyz{inverse(relative_xyz_matrix())};

/// CIELAB, its a and b scaled by the lightness, as colours look fainter in the dark (Hunt's effect).
std::array<float, 3> hunt_lab(const std::array<float, 3>& rgb) {
  constexpr float kDelta = 6.0f / 29.0f;
  const std::array<float, 3> xyz = kXyzOfRgb.times(rgb[0], rgb[1], rgb[2]);
  float root[3];
  for (size_t i = 0; i < 3; ++i)
    root[i] = xyz[i] > kDelta * kDelta * kDelta ? std::cbrt(xyz[i]) : xyz[i] / (3 * kDelta * kDelta) + 4.0f / 29.0f;
  const float lightness = 116.0f * root[1] - 16.0f, hunt = 0.01f * lightness;
  return {lightness, hunt * 500.0f * (root[0] - root[1]), hunt * 200.0f * (root[1] - root[2])};
}

/// Distance of colours: HyAB to the power of 0.7.
float color_distance(const std::array<float, 3>& a, const std::array<float, 3>& b) {
  const float x = a[1] - b[1], y = a[2] - b[2];
  return std::pow(std::fabs(a[0] - b[0]) + std::sqrt(x * x + y * y), 0.7f);
}

/// A distance as an error in [0, 1]: up to 0.4 of the largest, between green and blue, it is spread over [0, 0.95].
float color_error(float distance) {
  constexpr float kKnee = 0.4f, kKneeError = 0.95f;
  static const float largest = color_distance(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1}));
  if (distance < kKnee * largest) return kKneeError / (kKnee * largest) * distance;
  return kKneeError + (distance - kKnee * largest) / (largest - kKnee * largest) * (1 - kKneeError);
}

/// What of a row is filtered along it, before it is filtered down its columns.
enum BandPlane : int { kY, kCx, kCz, kCzWide, kSmooth, kEdge, kPoint, kPlanesOfBand };

/// Rows of planes of one picture, from first_row on.
struct BandPlanes {
  int width, first_row, rows;
  std::vector<float> planes[kPlanesOfBand];

  BandPlanes(int w, int first, int count) : width(w), first_row(first), rows(count) {
    for (std::vector<float>& plane : planes) plane.resize(size_t(w) * size_t(count));
  }
  float* row(int plane, int y) { return planes[plane].data() + size_t(y - first_row) * size_t(width); }
};

/// out[x] = sum of filter over row[x - r ... x + r]. Beyond the ends the last pixels go on. `padded` is scratch.
void filter_row(const float* row, int width, const HalfFilter& filter, bool antisymmetric, std::vector<float>& padded,
                float* out) {
  const int radius = int(filter.size()) - 1;
  padded.resize(size_t(width + 2 * radius));
  std::fill_n(padded.begin(), radius, row[0]);
  std::copy_n(row, width, padded.begin() + radius);
  std::fill_n(padded.begin() + radius + width, radius, row[width - 1]);
  const float* const middle = padded.data() + radius;
  for (int x = 0; x < width; ++x) out[x] = filter[0] * middle[x];
  for (int r = 1; r <= radius; ++r) {
    const float weight = filter[size_t(r)];
    const float *const right = middle + r, *const left = middle - r;
    if (antisymmetric)
      for (int x = 0; x < width; ++x) out[x] += weight * (right[x] - left[x]);
    else
      for (int x = 0; x < width; ++x) out[x] += weight * (right[x] + left[x]);
  }
}

/// The same down a column of a plane, for row y of a picture of `height` rows.
void filter_column(BandPlanes& band, int plane, int y, int height, const HalfFilter& filter, bool antisymmetric,
                   float* out) {
  const float* const middle = band.row(plane, y);
  for (int x = 0; x < band.width; ++x) out[x] = filter[0] * middle[x];
  for (int r = 1; r < int(filter.size()); ++r) {
    const float weight = filter[size_t(r)];
    const float *const below = band.row(plane, std::min(y + r, height - 1)), *const above =
                                                                                 band.row(plane, std::max(y - r, 0));
    if (antisymmetric)
      for (int x = 0; x < band.width; ++x) out[x] += weight * (below[x] - above[x]);
    else
      for (int x = 0; x < band.width; ++x) out[x] += weight * (below[x] + above[x]);
  }
}

/// What a picture is, filtered, in a row: colours as hunt_lab(), and how strong edges and points are.
struct FilteredRow {
  std::vector<std::array<float, 3>> lab;
  std::vector<float> edge, point;
};

class FilteredBand {
 public:
  FilteredBand(const LinearPicture& picture, const ToneCurve& curve, const FlipFilters& filters, int first, int end)
      : picture_(picture), filters_(filters), band_(picture.width, 0, 0) {
    const int reach = int(std::max(filters.achromatic.size(), filters.smooth.size())) - 1;
    const int top = std::max(first - reach, 0), bottom = std::min(end + reach, picture.height);
    band_ = BandPlanes(picture.width, top, bottom - top);
    for (int y = top; y < bottom; ++y) filter_along(y, curve);
  }

  void filter_down(int y, FilteredRow& out) {
    const auto width = size_t(picture_.width);
    for (std::vector<float>& line : lines_) line.resize(width);
    out.lab.resize(width), out.edge.resize(width), out.point.resize(width);
    down(kY, y, filters_.achromatic, false, 0);
    down(kCx, y, filters_.red_green, false, 1);
    down(kCz, y, filters_.blue_yellow, false, 2);
    down(kCzWide, y, filters_.blue_yellow_wide, false, 3);
    for (size_t x = 0; x < width; ++x)
      out.lab[x] = lab_of_opponent(lines_[0][x], lines_[1][x], lines_[2][x] + lines_[3][x]);
    down(kEdge, y, filters_.smooth, false, 0);
    down(kSmooth, y, filters_.edge, true, 1);
    down(kPoint, y, filters_.smooth, false, 2);
    down(kSmooth, y, filters_.point, false, 3);
    for (size_t x = 0; x < width; ++x) {
      out.edge[x] = std::sqrt(lines_[0][x] * lines_[0][x] + lines_[1][x] * lines_[1][x]);
      out.point[x] = std::sqrt(lines_[2][x] * lines_[2][x] + lines_[3][x] * lines_[3][x]);
    }
  }

 private:
  /// Opponent colours of a row (YCxCz of Kolpatzik and Bouman, 1995), filtered along it.
  void filter_along(int y, const ToneCurve& curve) {
    const int width = picture_.width;
    std::vector<float> opponent[3], grey(static_cast<size_t>(width));
    for (std::vector<float>& line : opponent) line.resize(size_t(width));
    for (int x = 0; x < width; ++x) {
      const std::array<float, 3> xyz = xyz_at(x, y, curve);
      opponent[0][size_t(x)] = 116.0f * xyz[1] - 16.0f;
      opponent[1][size_t(x)] = 500.0f * (xyz[0] - xyz[1]);
      opponent[2][size_t(x)] = 200.0f * (xyz[1] - xyz[2]);
      grey[size_t(x)] = xyz[1];  // (Y + 16) / 116
    }
    const auto along = [&](const std::vector<float>& line, const HalfFilter& filter, bool antisymmetric, int plane) {
      filter_row(line.data(), width, filter, antisymmetric, padded_, band_.row(plane, y));
    };
    along(opponent[0], filters_.achromatic, false, kY);
    along(opponent[1], filters_.red_green, false, kCx);
    along(opponent[2], filters_.blue_yellow, false, kCz);
    along(opponent[2], filters_.blue_yellow_wide, false, kCzWide);
    along(grey, filters_.smooth, false, kSmooth);
    along(grey, filters_.edge, true, kEdge);
    along(grey, filters_.point, false, kPoint);
  }

  std::array<float, 3> xyz_at(int x, int y, const ToneCurve& curve) const {
    const size_t pixel = size_t(y) * size_t(picture_.width) + size_t(x);
    float shown[3];
    for (size_t c = 0; c < 3; ++c) {
      const double v = double(picture_.rgb[c][pixel]) * curve.scale;
      const double mapped =
          ((curve.k[0] * v + curve.k[1]) * v + curve.k[2]) / ((curve.k[3] * v + curve.k[4]) * v + curve.k[5]);
      shown[c] = mapped > 0 ? float(std::min(mapped, 1.0)) : 0.0f;  // NaN is not above 0
    }
    return kXyzOfRgb.times(shown[0], shown[1], shown[2]);
  }

  static std::array<float, 3> lab_of_opponent(float y, float cx, float cz) {
    const float relative_y = (y + 16.0f) / 116.0f;
    std::array<float, 3> rgb = kRgbOfXyz.times(relative_y + cx / 500.0f, relative_y, relative_y - cz / 200.0f);
    for (float& v : rgb) v = std::clamp(v, 0.0f, 1.0f);
    return hunt_lab(rgb);
  }

  void down(int plane, int y, const HalfFilter& filter, bool antisymmetric, size_t line) {
    filter_column(band_, plane, y, picture_.height, filter, antisymmetric, lines_[line].data());
  }

  const LinearPicture& picture_;
  const FlipFilters& filters_;
  BandPlanes band_;
  std::vector<float> padded_, lines_[4];
};

void raise_band(const LinearPicture& reference, const LinearPicture& test, const ToneCurve& curve,
                const FlipFilters& filters, int band, std::vector<float>& map) {
  const int first = band * kFlipBandRows, end = std::min(first + kFlipBandRows, reference.height);
  FilteredBand r(reference, curve, filters, first, end), t(test, curve, filters, first, end);
  FilteredRow of_r, of_t;
  for (int y = first; y < end; ++y) {
    r.filter_down(y, of_r), t.filter_down(y, of_t);
    float* const out = map.data() + size_t(y) * size_t(reference.width);
    for (size_t x = 0; x < size_t(reference.width); ++x) {
      const float color = color_error(color_distance(of_r.lab[x], of_t.lab[x]));
      const float features = std::max(std::fabs(of_r.edge[x] - of_t.edge[x]), std::fabs(of_r.point[x] - of_t.point[x]));
      const float feature_error = std::sqrt(std::min(features / std::sqrt(2.0f), 1.0f));
      out[x] = std::max(out[x], std::pow(color, 1.0f - feature_error));
    }
  }
}

}  // namespace

void raise_flip_map(const LinearPicture& reference, const LinearPicture& test, const ToneCurve& curve,
                    double pixels_per_degree, int threads, std::vector<float>& map) {
  const FlipFilters filters = flip_filters(pixels_per_degree);
  parallel_for((reference.height + kFlipBandRows - 1) / kFlipBandRows, threads,
               [&](int band) { raise_band(reference, test, curve, filters, band, map); });
}

}  // namespace trueshade::compare
