#include <algorithm>
#include <cmath>

#include "judge/bounds/edge_span.h"
#include "oracle/scalar_renderer.h"

namespace trueshade::oracle {

namespace {

/// Products of all pairs of numbers. std::min of a list of four would be a loop.
inline EdgeSpan times(const EdgeSpan& a, const EdgeSpan& b) {
  const double p = a.low * b.low, q = a.low * b.high, r = a.high * b.low, s = a.high * b.high;
  return {std::min(std::min(p, q), std::min(r, s)), std::max(std::max(p, q), std::max(r, s))};
}

}  // namespace

EdgeSpan edge_span(const WindowVertex& a, const WindowVertex& b, double x, double y) {
  const EdgeSpan ax{a.low[0] - x, a.high[0] - x}, ay{a.low[1] - y, a.high[1] - y};
  const EdgeSpan bx{b.low[0] - x, b.high[0] - x}, by{b.low[1] - y, b.high[1] - y};
  const bool points = ax.low == ax.high && ay.low == ay.high && bx.low == bx.high && by.low == by.high;
  const auto is_far = [](const EdgeSpan& e) { return std::fabs(e.low) >= 0x1p17; };
  if (points && (is_far(ax) || is_far(ay) || is_far(bx) || is_far(by))) {  // 2^25 subpixels: the products need more than a double
    const auto fixed = [](double v) { return Int128(std::llround(v * kSubpixels)); };
    const Int128 e = fixed(ax.low) * fixed(by.low) - fixed(ay.low) * fixed(bx.low);
    return {double(e), double(e)};  // only its sign is read
  }
  const EdgeSpan p = times(ax, by), q = times(ay, bx);
  if (points) return {p.low - q.low, p.low - q.low};  // 26 bits each: exact
  const double slack =
      0x1p-50 * (std::max(std::fabs(p.low), std::fabs(p.high)) + std::max(std::fabs(q.low), std::fabs(q.high)));
  return {p.low - q.high - slack, p.high - q.low + slack};
}

namespace {

/// The hull of edge_span() over a box of samples, whatever each of them rounds: |E| is made of products of sizes that
/// are largest at corners too, and a sample's rounding and slack are below 2^-48 of them.
EdgeSpan edge_span_of_box(const WindowVertex& a, const WindowVertex& b, const Pair& low, const Pair& high) {
  EdgeSpan all{HUGE_VAL, -HUGE_VAL};
  double size = 0;
  for (unsigned corner = 0; corner < 4; ++corner) {
    const double x = (corner & 1u) != 0 ? high[0] : low[0], y = (corner & 2u) != 0 ? high[1] : low[1];
    const EdgeSpan p = times({a.low[0] - x, a.high[0] - x}, {b.low[1] - y, b.high[1] - y});
    const EdgeSpan q = times({a.low[1] - y, a.high[1] - y}, {b.low[0] - x, b.high[0] - x});
    all.low = std::min(all.low, p.low - q.high), all.high = std::max(all.high, p.high - q.low);
    size =
        std::max(size, std::max(std::fabs(p.low), std::fabs(p.high)) + std::max(std::fabs(q.low), std::fabs(q.high)));
  }
  if (!std::isfinite(size)) return {-HUGE_VAL, HUGE_VAL};  // a vertex next to w = 0
  return {all.low - 0x1p-46 * size, all.high + 0x1p-46 * size};
}

/// Whether lower edges are in, where the profile says which are.
bool owns_low_side(FillRule fill, ClipOrigin origin) {
  if (fill == FillRule::left_first || fill == FillRule::left_last) return fill == FillRule::left_first;
  return (fill == FillRule::left_low) == (origin == ClipOrigin::lower_left);
}

/// Whether a sample on the edge a -> b of a counter-clockwise triangle belongs to it.
bool owns_edge(const WindowVertex& a, const WindowVertex& b, int sign, bool low_side) {
  const double dx = sign * (b.low[0] - a.low[0]), dy = sign * (b.low[1] - a.low[1]);
  if (dy != 0) return dy < 0;         // downwards: the inside is to the right
  return low_side ? dx > 0 : dx < 0;  // rightwards: the inside is above
}

}  // namespace

Coverage coverage_at(const Piece& piece, const Profile& profile, ClipOrigin origin, double x, double y,
                     unsigned edges) {
  Coverage result;
  result.cover = piece.facing_known ? Cover::certain : Cover::maybe;
  bool any_inside[2] = {true, true};  // for either sign, where the facing is not known
  for (size_t i = 0; i < 3; ++i) {
    if ((edges >> i & 1u) == 0) continue;
    const WindowVertex &a = piece.v[(i + 1) % 3], &b = piece.v[(i + 2) % 3];
    EdgeSpan e = edge_span(a, b, x, y);
    if (!piece.facing_known) {
      if (e.high < 0) any_inside[0] = false;
      if (e.low > 0) any_inside[1] = false;
      result.uncertain_edges |= 1u << i;
      result.chance_other = 0.5;
      result.nominal = result.nominal && piece.sign * (e.low + e.high) > 0;
      continue;
    }
    if (piece.sign < 0) e = {-e.high, -e.low};
    if (e.high < 0) return {};
    if (e.low > 0) continue;
    if (e.low == 0 && e.high == 0 && profile.fill != FillRule::unstated) {
      if (!owns_edge(a, b, piece.sign, owns_low_side(profile.fill, origin))) return {};
      continue;
    }
    result.cover = Cover::maybe;
    result.uncertain_edges |= 1u << i;
    const double middle = e.low + e.high;
    result.nominal = result.nominal && (middle > 0 || (middle == 0 && owns_edge(a, b, piece.sign, true)));
    // Of an edge moved evenly over its interval, the share on the other side of the sample than the middle.
    const double width = e.high - e.low;
    result.chance_other = std::max(result.chance_other, width > 0 ? std::min(e.high, -e.low) / width : 0.5);
  }
  if (!any_inside[0] && !any_inside[1]) return {};
  return result;
}

BoxCoverage coverage_of_box(const Piece& piece, const Pair& low, const Pair& high) {
  BoxCoverage box;
  if (!piece.facing_known) return box;
  for (size_t i = 0; i < 3; ++i) {
    EdgeSpan e = edge_span_of_box(piece.v[(i + 1) % 3], piece.v[(i + 2) % 3], low, high);
    if (piece.sign < 0) e = {-e.high, -e.low};
    if (e.high < 0) box.none = true;
    if (e.low > 0) box.edges &= ~(1u << i);
  }
  return box;
}

bool nominally_left(const WindowVertex& a, const WindowVertex& b, double x, double y) {
  const double ax = a.exact[0] - x, ay = a.exact[1] - y, bx = b.exact[0] - x, by = b.exact[1] - y;
  const double p = ax * by, q = ay * bx;
  if (p != q) return p > q;
  return by != ay ? by < ay : bx > ax;
}

}  // namespace trueshade::oracle
