// After T. Lottes, "FXAA" (NVIDIA, 2009): the edge search of its published description, without its blur of single
// pixels, in our own arithmetic. docs/post.md.
#include <algorithm>
#include <cmath>

#include "core/threads/parallel_for.h"
#include "shading/output/derived_planes.h"
#include "shading/output/post.h"

namespace trueshade {
namespace {

constexpr int kReach = 12;                                     // pixels an edge is followed each way
static_assert(kReach + 2 <= kEdgeReach);
constexpr float kLeastContrast = 0.0625f, kContrast = 0.125f;  // absolute, and as a share of the brightest

/// Luminance of each pixel, clamped to [0, 1]; past the border its last pixel goes on.
struct Lumas {
  int width, height;
  std::vector<float> values;

  explicit Lumas(const Picture& p) : width(p.width), height(p.height), values(size_t(p.width) * size_t(p.height)) {
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        float c[3];
        for (int k = 0; k < 3; ++k) c[k] = p.at(x, y)[k] > 0.0f ? std::min(p.at(x, y)[k], 1.0f) : 0.0f;
        values[size_t(y) * size_t(width) + size_t(x)] = luminance(c[0], c[1], c[2]);
      }
  }
  float at(int x, int y) const {
    return values[size_t(std::clamp(y, 0, height - 1)) * size_t(width) + size_t(std::clamp(x, 0, width - 1))];
  }
};

/// Where a pixel's edge lies: the neighbour across it, and the share of that neighbour to take; 0: leave the pixel.
struct Blend {
  int dx = 0, dy = 0;
  float share = 0.0f;
};

Blend blend_at(const Lumas& l, int x, int y) {
  const float m = l.at(x, y), n = l.at(x, y - 1), s = l.at(x, y + 1), w = l.at(x - 1, y), e = l.at(x + 1, y);
  const float most = std::max({m, n, s, w, e}), contrast = most - std::min({m, n, s, w, e});
  if (contrast < std::max(kLeastContrast, kContrast * most)) return {};
  const float nw = l.at(x - 1, y - 1), ne = l.at(x + 1, y - 1), sw = l.at(x - 1, y + 1), se = l.at(x + 1, y + 1);
  const float level =
      (std::fabs((nw + sw) - 2.0f * w) + 2.0f * std::fabs((n + s) - 2.0f * m)) + std::fabs((ne + se) - 2.0f * e);
  const float upright =
      (std::fabs((nw + ne) - 2.0f * n) + 2.0f * std::fabs((w + e) - 2.0f * m)) + std::fabs((sw + se) - 2.0f * s);
  const bool is_level = level >= upright;
  const float before = is_level ? n : w, after = is_level ? s : e;
  const bool first = std::fabs(before - m) >= std::fabs(after - m);
  const int side = first ? -1 : 1, dx = is_level ? 0 : side, dy = is_level ? side : 0;
  const float across = first ? before : after, middle = 0.5f * (m + across), end = 0.25f * std::fabs(across - m);

  // Follow the edge both ways until the mean of the two pixels at it leaves their mean here.
  int steps[2] = {kReach, kReach};
  float past[2] = {0.0f, 0.0f};
  bool found[2] = {false, false};
  for (int way = 0; way < 2; ++way)
    for (int k = 1; k <= kReach && !found[way]; ++k) {
      const int along = way == 0 ? -k : k, ex = is_level ? x + along : x, ey = is_level ? y : y + along;
      past[way] = 0.5f * (l.at(ex, ey) + l.at(ex + dx, ey + dy)) - middle;
      found[way] = std::fabs(past[way]) >= end;
      if (found[way]) steps[way] = k;
    }
  if (!found[0] && !found[1]) return {};
  const int nearer = found[0] && (!found[1] || steps[0] <= steps[1]) ? 0 : 1;
  // At its end the edge must turn to the other side of this pixel; else it is the neighbour that is cut.
  if ((past[nearer] < 0.0f) == (m < middle)) return {};
  return {dx, dy, 0.5f - float(steps[nearer]) / float(steps[0] + steps[1])};
}

}  // namespace

Picture smoothed_edges(const Picture& picture, int threads) {
  const Lumas lumas(picture);
  Picture out = picture;
  parallel_for(picture.height, threads, [&](int y) {
    for (int x = 0; x < picture.width; ++x) {
      const Blend blend = blend_at(lumas, x, y);
      if (!(blend.share > 0.0f)) continue;
      const float* here = picture.at(x, y);
      const float* there =
          picture.at(std::clamp(x + blend.dx, 0, picture.width - 1), std::clamp(y + blend.dy, 0, picture.height - 1));
      for (int c = 0; c < 3; ++c) out.at(x, y)[c] = here[c] + blend.share * (there[c] - here[c]);
    }
  });
  return out;
}

}  // namespace trueshade
