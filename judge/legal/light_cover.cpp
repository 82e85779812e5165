#include "judge/legal/light_cover.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "judge/legal/surface.h"

namespace trueshade::oracle {

namespace {

constexpr double kGuardBand = 0x1p15;  // pixels
constexpr size_t kMostPatterns = 12;   // edges in doubt whose sides are all tried
constexpr double kNearestW = 0x1p-126;

using Triple = std::array<double, 3>;

Triple cross(const Triple& a, const Triple& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double dot(const Triple& a, const Triple& b) { return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2]; }
double reach_of(const Triple& a, const Triple& error) {
  return std::fabs(a[0]) * error[0] + std::fabs(a[1]) * error[1] + std::fabs(a[2]) * error[2];
}

Scene scene_of(const Scene& scene, const Light& light, const LightMesh& mesh) {
  Scene s;
  s.camera = scene.camera;
  s.materials.resize(1);
  s.instances.resize(1);
  std::vector<glm::vec3> vertices(mesh.unit.size());
  light_vertices(mesh, light, vertices);
  Mesh& m = s.meshes.emplace_back();
  for (const glm::vec3& v : vertices)
    for (int k = 0; k < 3; ++k) m.position[size_t(k)].push_back(v[k]), m.normal[size_t(k)].push_back(0.0f);
  m.indices = mesh.indices;
  return s;
}

Pipeline pipeline_of(const Pipeline& pipeline) {
  Pipeline p = pipeline;
  p.geometry.cull_face = pipeline.light_volumes.cull_face;
  p.geometry.front_face = FrontFace::ccw;
  p.geometry.depth_clamp = pipeline.light_volumes.depth_clamp;
  return p;
}

}  // namespace

/// A triangle that reaches behind the eye, by its lines.
struct Endless {
  std::array<Triple, 3> line{};   ///< of edge i, from corner i+1 to i+2; inside where positive
  std::array<Triple, 3> error{};  ///< of the line's coefficients
  Triple reach{};                 ///< (|alpha| + |beta|) e
  bool facing_known = true;

  Coverage at(double x, double y) const {
    Coverage result;
    result.cover = facing_known ? Cover::certain : Cover::maybe;
    bool inside[2] = {true, true};
    for (size_t i = 0; i < 3; ++i) {
      const Triple p{x, y, 1};
      const double e = dot(line[i], p), doubt = (reach[i] + reach_of(p, error[i])) * (1 + 0x1p-20);
      if (e < -doubt) inside[0] = false;
      if (e > doubt) inside[1] = false;
      if (std::fabs(e) > doubt && facing_known) continue;
      result.uncertain_edges |= 1u << i;
      result.cover = Cover::maybe;
      result.nominal = result.nominal && e > 0;
      result.chance_other = std::max(result.chance_other, 0.5 * (1 - std::min(1.0, std::fabs(e) / doubt)));
    }
    if (!inside[0] && (facing_known || !inside[1])) return {};
    return result;
  }
};

struct LightOutline::Shape {
  uint32_t triangle = 0;
  std::optional<Piece> piece;
  Endless endless;
  std::array<Pair, 3> corner{};  ///< that edges are told by
  int sign = 1;
  bool cut = false;
  double low[2] = {-HUGE_VAL, -HUGE_VAL}, high[2] = {HUGE_VAL, HUGE_VAL};

  bool left_of(size_t edge, double x, double y) const {
    if (!piece) return sign * dot(endless.line[edge], {x, y, 1}) > 0;
    return nominally_left(piece->v[(edge + 1) % 3], piece->v[(edge + 2) % 3], x, y);
  }
  bool nominally_covers(double x, double y) const {
    int left = 0;
    for (size_t i = 0; i < 3; ++i) left += left_of(i, x, y) ? 1 : 0;
    return left == (sign > 0 ? 3 : 0);
  }
};

/// A shape that may or may not have the sample of a pixel.
struct LightOutline::Doubt {
  int x;
  uint32_t shape;
  unsigned edges;
  float chance_other;
};

LightOutline::~LightOutline() = default;

LightOutline::LightOutline(const Scene& scene, const Pipeline& pipeline, const Profile& profile,
                           std::array<int, 2> drawn_at, const Light& light, const LightMesh& mesh)
    : scene_(scene_of(scene, light, mesh)),
      projector_(std::make_unique<Projector>(scene_, pipeline_of(pipeline), profile, drawn_at)) {
  const bool depth_clamp = pipeline.light_volumes.depth_clamp;
  // Near the eye's plane w has few digits left: a vertex is anywhere, and its edges are where they are all the same.
  const auto blurred = [&](const Piece& piece) {
    return std::any_of(piece.v.begin(), piece.v.end(), [&](const WindowVertex& v) {
      return std::max(v.high[0] - v.low[0], v.high[1] - v.low[1]) > std::ldexp(2.0, -profile.subpixel_bits) + 0.0625;
    });
  };
  std::vector<Piece> pieces;
  for (uint32_t t = 0; t < mesh.triangles(); ++t) {
    bool behind = false;
    for (const auto& clip : projector_->clip_of(0, t)) behind = behind || !(double(clip[3]) > kNearestW);
    if (behind && depth_clamp && !profile.exact_vertices) {
      add_endless(t);
      continue;
    }
    projector_->pieces(0, t, pieces);
    if (depth_clamp && !profile.exact_vertices && std::any_of(pieces.begin(), pieces.end(), blurred)) {
      add_endless(t);
      continue;
    }
    for (const Piece& piece : pieces) {
      Shape& shape = shapes_.emplace_back();
      shape.triangle = t, shape.piece = piece, shape.sign = piece.sign, shape.cut = piece.cut || piece.leaves_view;
      for (size_t a = 0; a < 2; ++a) {
        shape.low[a] = HUGE_VAL, shape.high[a] = -HUGE_VAL;
        for (const WindowVertex& v : piece.v)
          shape.low[a] = std::min(shape.low[a], v.low[a]), shape.high[a] = std::max(shape.high[a], v.high[a]);
      }
      for (size_t i = 0; i < 3; ++i) shape.corner[i] = piece.v[i].exact;
    }
  }
}

void LightOutline::add_endless(uint32_t triangle) {
  const Profile& profile = projector_->profile();
  const Pipeline& pipeline = projector_->pipeline();
  const Viewport view = resolved_viewport(pipeline.geometry, pipeline.width, pipeline.height);
  const bool turned = pipeline.geometry.clip_origin == ClipOrigin::upper_left;
  const Mesh& mesh = scene_.meshes[0];
  const double half[2] = {view.width * 0.5, view.height * 0.5}, corner[2] = {double(view.x), double(view.y)};
  std::array<Triple, 3> at{}, error{};
  Shape shape;
  bool all_behind = true;
  for (size_t i = 0; i < 3; ++i) {
    const uint32_t vertex = mesh.indices[3 * size_t(triangle) + i];
    double c[4], off[4];
    for (size_t r = 0; r < 4; ++r) {
      double t[4];
      for (size_t k = 0; k < 4; ++k)
        t[k] = double(float(projector_->clip_from_world()[4 * k + r])) * (k < 3 ? double(mesh.position[k][vertex]) : 1);
      c[r] = ((t[0] + t[1]) + t[2]) + t[3];
      off[r] =
          5 * profile.arithmetic.roundoff * (std::fabs(t[0]) + std::fabs(t[1]) + std::fabs(t[2]) + std::fabs(t[3]));
    }
    all_behind = all_behind && c[3] + off[3] <= 0;
    for (size_t a = 0; a < 2; ++a) {
      const double turn = a == 1 && turned ? -1 : 1;
      at[i][a] = turn * c[a] * half[a] + (half[a] + corner[a]) * c[3];
      error[i][a] = off[a] * half[a] + std::fabs(half[a] + corner[a]) * off[3];
      shape.corner[i][a] = turn * (c[a] / c[3]) * half[a] + (half[a] + corner[a]);
    }
    at[i][2] = c[3], error[i][2] = off[3];
  }
  if (all_behind) return;
  const double determinant = dot(cross(at[0], at[1]), at[2]);
  const double doubt = (reach_of(cross(at[0], at[1]), error[2]) + reach_of(cross(at[1], at[2]), error[0]) +
                        reach_of(cross(at[2], at[0]), error[1])) *
                       (1 + 0x1p-10);
  shape.triangle = triangle, shape.cut = true;
  shape.sign = determinant < 0 ? -1 : 1;
  shape.endless.facing_known = std::fabs(determinant) > doubt;
  const bool front = (shape.sign > 0) != turned;
  const CullFace cull = pipeline.geometry.cull_face;
  if (cull == CullFace::front_and_back) return;
  if (shape.endless.facing_known && ((cull == CullFace::front && front) || (cull == CullFace::back && !front))) return;
  const double snap = std::ldexp(profile.snap == SnapRule::nearest || profile.snap == SnapRule::toward_zero ? 0.5 : 0.6,
                                 -profile.subpixel_bits);
  const double e = snap + 3 * 0x1p-23 * (kGuardBand + projector_->window_reach()[0] + projector_->window_reach()[1]);
  for (size_t i = 0; i < 3; ++i) {
    const Triple &a = at[(i + 1) % 3], &b = at[(i + 2) % 3], &da = error[(i + 1) % 3], &db = error[(i + 2) % 3];
    const Triple line = cross(a, b);
    for (size_t k = 0; k < 3; ++k) {
      const size_t u = (k + 1) % 3, v = (k + 2) % 3;
      shape.endless.line[i][k] = shape.sign * line[k];
      shape.endless.error[i][k] = std::fabs(a[u]) * db[v] + std::fabs(b[v]) * da[u] + da[u] * db[v] +
                                  std::fabs(a[v]) * db[u] + std::fabs(b[u]) * da[v] + da[v] * db[u];
    }
    shape.endless.reach[i] = (std::fabs(line[0]) + std::fabs(line[1])) * e;
  }
  shapes_.push_back(std::move(shape));
}

void LightOutline::count_row(int y, std::span<FragmentCount> out) const {
  std::fill(out.begin(), out.end(), FragmentCount{});
  const Pipeline& pipeline = projector_->pipeline();
  const Viewport view = resolved_viewport(pipeline.geometry, pipeline.width, pipeline.height);
  const double sy = y + 0.5;
  if (y < view.y || y >= view.y + view.height) return;
  const int left = std::max(0, view.x), right = std::min(int(out.size()), view.x + view.width);
  const bool depth_clamp = pipeline.geometry.depth_clamp, exact = projector_->profile().exact_planes;
  const double near = std::min(double(pipeline.geometry.depth_near), double(pipeline.geometry.depth_far));
  const double far = std::max(double(pipeline.geometry.depth_near), double(pipeline.geometry.depth_far));
  std::vector<Doubt> doubts;
  for (uint32_t i = 0; i < shapes_.size(); ++i) {
    const Shape& shape = shapes_[i];
    if (sy < shape.low[1] || sy > shape.high[1]) continue;
    const int x0 = int(std::clamp(std::ceil(shape.low[0] - 0.5), double(left), double(right)));
    const int x1 = int(std::clamp(std::floor(shape.high[0] - 0.5) + 1, double(left), double(right)));
    for (int x = x0; x < x1; ++x) {
      Coverage c = shape.piece
                       ? coverage_at(*shape.piece, projector_->profile(), pipeline.geometry.clip_origin, x + 0.5, sy)
                       : shape.endless.at(x + 0.5, sy);
      if (c.cover == Cover::no) continue;
      if (!depth_clamp &&
          !exact) {  // near and far, which float arithmetic places with an error, may cut here after all
        const Range z =
            SurfacePoint(*shape.piece, projector_->profile(), projector_->window_reach(), x + 0.5, sy).depth();
        if (z.low <= near || z.high >= far) c.cover = Cover::maybe, c.uncertain_edges = 8, c.chance_other = 0.5;
      }
      if (c.cover == Cover::certain) {
        ++out[size_t(x)].least, ++out[size_t(x)].most, ++out[size_t(x)].nominal;
        continue;
      }
      doubts.push_back({x, i, c.uncertain_edges, float(c.chance_other)});
    }
  }
  std::stable_sort(doubts.begin(), doubts.end(), [](const Doubt& a, const Doubt& b) { return a.x < b.x; });
  for (size_t i = 0; i < doubts.size();) {
    size_t j = i;
    while (j < doubts.size() && doubts[j].x == doubts[i].x) ++j;
    settle(doubts[i].x, sy, std::span(doubts).subspan(i, j - i), out[size_t(doubts[i].x)]);
    i = j;
  }
}

/// The shapes in doubt about one sample. Edges that two of one facing share are one line: on its one side the one may
/// be, on its other the other. Where all of a facing are shared, the sum does not depend on where vertices are.
void LightOutline::settle(int x, double sy, std::span<const Doubt> doubts, FragmentCount& count) const {
  struct Line {
    Pair from, to;
    int sign;
  };
  const double sx = x + 0.5;
  for (const int sign : {1, -1}) {
    std::vector<Line> lines;
    std::vector<std::array<int, 3>> needs;  // of a shape: line + 1, negative where it lies on the line's right
    size_t shared = 0, edges = 0;
    bool open = false;
    int nominal = 0;
    float chance = 0;
    for (const Doubt& d : doubts) {
      const Shape& shape = shapes_[d.shape];
      if (shape.sign != sign) continue;
      nominal += shape.nominally_covers(sx, sy) ? 1 : 0;
      chance = std::max(chance, d.chance_other);
      count.triangle = shape.triangle;
      count.cut = count.cut || shape.cut;
      std::array<int, 3> need{};
      open = open || (d.edges & 8u) != 0;
      for (size_t e = 0; e < 3; ++e) {
        if ((d.edges >> e & 1u) == 0) continue;
        ++edges;
        const Pair &from = shape.corner[(e + 1) % 3], &to = shape.corner[(e + 2) % 3];
        const auto twin =
            std::find_if(lines.begin(), lines.end(), [&](const Line& l) { return l.from == to && l.to == from; });
        if (twin != lines.end()) ++shared;
        need[e] = twin != lines.end() ? -int(twin - lines.begin()) - 1 : int(lines.size()) + 1;
        if (twin == lines.end()) lines.push_back({from, to, sign});
      }
      needs.push_back(need);
    }
    if (needs.empty()) continue;
    int least = 0, most = int(needs.size());
    if (!open && 2 * shared == edges) {
      least = most = nominal;
    } else if (!open && lines.size() <= kMostPatterns) {
      least = int(needs.size()), most = 0;
      for (unsigned pattern = 0; pattern < 1u << lines.size(); ++pattern) {
        int covered = 0;
        for (const std::array<int, 3>& need : needs)
          covered += std::all_of(need.begin(), need.end(), [&](int n) {
            return n == 0 || ((pattern >> (std::abs(n) - 1) & 1u) != 0) == (n > 0);
          });
        least = std::min(least, covered), most = std::max(most, covered);
      }
    }
    count.least = uint8_t(count.least + least), count.most = uint8_t(count.most + most);
    count.nominal = uint8_t(count.nominal + std::clamp(nominal, least, most));
    if (least < most) count.chance_other = std::max(count.chance_other, chance);
  }
}

}  // namespace trueshade::oracle
