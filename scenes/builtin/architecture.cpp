#include "scenes/builtin/architecture.h"

#include <cmath>

#include "scenes/trig.h"

namespace trueshade {
namespace {

void add_color(Mesh& mesh, const glm::dvec3& color) {
  for (int k = 0; k < 3; ++k) mesh.color[size_t(k)].push_back(float(color[k]));
  mesh.color[3].push_back(1.0f);
}

/// Normal of a curve of a profile at point i, outwards: to the right of the way up.
glm::dvec2 profile_normal(const std::vector<glm::dvec2>& curve, size_t i) {
  const glm::dvec2 a = curve[i == 0 ? 0 : i - 1], b = curve[i + 1 == curve.size() ? i : i + 1];
  const double x = b.y - a.y, y = a.x - b.x;
  const double length = std::sqrt(x * x + y * y);
  return {x / length, y / length};
}

/// Radius of a fluted shaft at a direction, as a share, and its slope by the angle.
glm::dvec2 fluted(double angle, int flutes, double groove) {
  if (flutes == 0) return {1.0, 0.0};
  return {1.0 - groove * (0.5 - 0.5 * cosine(flutes * angle)), -groove * 0.5 * flutes * sine(flutes * angle)};
}

/// Both faces of a wall above an arc, without the arc's own surface.
void add_arch_face(Mesh& mesh, double width, double height, double radius, double z) {
  constexpr int kArc = 28, kSide = 2, kRows = 7, kColumns = kArc + 2 * kSide;
  const double side = z > 0.0 ? 1.0 : -1.0;
  add_net(mesh, kColumns, kRows, [&](int column, int row) {
    double x, bottom = 0.0;
    if (column <= kSide) {
      x = -width / 2 + (width / 2 - radius) * column / kSide;
    } else if (column >= kSide + kArc) {
      x = radius + (width / 2 - radius) * (column - kSide - kArc) / kSide;
    } else {
      const double angle = kPi * (kSide + kArc - column) / kArc;
      x = radius * cosine(angle);
      bottom = radius * sine(angle);
    }
    return SurfacePoint{{side * x, bottom + (height - bottom) * row / kRows, z}, {0.0, 0.0, side}};
  });
}

/// A round moulding along the arc.
void add_moulding(Mesh& mesh, double radius, double thick, double z) {
  add_net(mesh, 28, 8, [&](int column, int row) {
    const double angle = kPi * column / 28, around = 2.0 * kPi * row / 8;
    const glm::dvec3 out(cosine(angle), sine(angle), 0.0);
    const glm::dvec3 normal = out * cosine(around) + glm::dvec3(0.0, 0.0, 1.0) * sine(around);
    return SurfacePoint{out * radius + glm::dvec3(0.0, 0.0, z) + normal * thick, normal};
  });
}

double smooth(double t) {
  const double c = t < 0.0 ? 0.0 : t > 1.0 ? 1.0 : t;
  return c * c * (3.0 - 2.0 * c);
}

/// How far a coffer is sunk at (s, t) in [-1, 1]^2, 0 to 1: two steps.
double coffer(double s, double t) {
  const double m = std::fabs(s) > std::fabs(t) ? std::fabs(s) : std::fabs(t);
  return 0.5 * smooth((0.84 - m) * 12.0) + 0.5 * smooth((0.60 - m) * 12.0);
}

}  // namespace

void add_net(Mesh& mesh, int columns, int rows, const std::function<SurfacePoint(int, int)>& surface) {
  const uint32_t first = uint32_t(mesh.vertex_count());
  for (int row = 0; row <= rows; ++row)
    for (int column = 0; column <= columns; ++column) {
      const SurfacePoint p = surface(column, row);
      add_vertex(mesh, p.position, unit(p.normal));
    }
  for_each_quad_in_patches(columns, rows, [&](int column, int row) {
    const uint32_t a = first + uint32_t(row * (columns + 1) + column), d = a + uint32_t(columns + 1);
    add_quad(mesh, a, a + 1, d + 1, d);
  });
}

std::vector<glm::dvec2> rounded(const glm::dvec2& from, const glm::dvec2& to, bool bulges, int steps) {
  std::vector<glm::dvec2> points;
  for (int i = 0; i <= steps; ++i) {
    const double angle = 0.5 * kPi * i / steps;
    const double s = i == steps ? 1.0 : sine(angle), c = i == steps ? 0.0 : cosine(angle);
    // Along one axis as the sine goes, along the other as 1 - cosine does.
    const double x = bulges ? s : 1.0 - c, y = bulges ? 1.0 - c : s;
    points.emplace_back(from.x + (to.x - from.x) * x, from.y + (to.y - from.y) * y);
  }
  return points;
}

Mesh turned_mesh(const Profile& profile, int segments, int flutes, double groove) {
  Mesh mesh;
  mesh.name = "turned";
  for (const std::vector<glm::dvec2>& curve : profile) {
    const bool is_shaft = flutes > 0 && curve.size() > 2 && curve.front().y + 0.5 < curve.back().y;
    const int around = is_shaft ? segments : 40;
    // Rows go up, columns round against the clock seen from below, so that the normals come out.
    add_net(mesh, around, int(curve.size()) - 1, [&](int column, int row) {
      const double angle = -2.0 * kPi * (column % around) / around;
      const glm::dvec2 p = curve[size_t(row)], n = profile_normal(curve, size_t(row));
      const glm::dvec2 share = is_shaft ? fluted(angle, flutes, groove) : glm::dvec2(1.0, 0.0);
      const glm::dvec3 out(cosine(angle), 0.0, sine(angle)), along(-sine(angle), 0.0, cosine(angle));
      return SurfacePoint{out * (p.x * share.x) + glm::dvec3(0.0, p.y, 0.0),
                          (out - along * (share.y / share.x)) * n.x + glm::dvec3(0.0, n.y, 0.0)};
    });
  }
  return mesh;
}

Mesh arch_mesh(double width, double height, double thickness, double radius) {
  Mesh mesh;
  mesh.name = "arch";
  for (const double z : {thickness / 2, -thickness / 2}) add_arch_face(mesh, width, height, radius, z);
  add_net(mesh, 28, 4, [&](int column, int row) {
    const double angle = kPi * column / 28;
    const glm::dvec3 out(cosine(angle), sine(angle), 0.0);
    return SurfacePoint{out * radius + glm::dvec3(0.0, 0.0, thickness * (0.5 - row / 4.0)), -out};
  });
  for (const double z : {thickness / 2, -thickness / 2}) add_moulding(mesh, radius + 0.13, 0.075, z);
  return mesh;
}

Mesh vault_mesh(int around, int along, double length, double depth, const glm::dvec3& rib, const glm::dvec3& ground) {
  constexpr int kSteps = 14;  // a cell: both bevels fall between grid lines
  Mesh mesh;
  mesh.name = "vault";
  const auto sunk = [&](double u, double v) {
    const double s = u * around, t = v * along;
    return coffer(2.0 * (s - std::floor(s)) - 1.0, 2.0 * (t - std::floor(t)) - 1.0);
  };
  const auto point = [&](double u, double v) {
    const double angle = kPi * u, radius = 1.0 + depth * sunk(u, v);
    return glm::dvec3(radius * cosine(angle), radius * sine(angle), (0.5 - v) * length);
  };
  const int columns = around * kSteps, rows = along * kSteps;
  add_net(mesh, columns, rows, [&](int column, int row) {
    const double u = double(column) / columns, v = double(row) / rows, du = 0.4 / columns, dv = 0.4 / rows;
    // Seen from inside: columns run over the arch, rows away from the viewer.
    return SurfacePoint{point(u, v), cross(point(u + du, v) - point(u - du, v), point(u, v + dv) - point(u, v - dv))};
  });
  for (int row = 0; row <= rows; ++row)
    for (int column = 0; column <= columns; ++column)
      add_color(mesh, rib + (ground - rib) * smooth(2.0 * sunk(double(column) / columns, double(row) / rows) - 1.0));
  return mesh;
}

Mesh water_mesh(double height) {
  constexpr int kAround = 84, kRings = 42;
  Mesh mesh;
  mesh.name = "water";
  add_net(mesh, kAround, kRings, [&](int column, int row) {
    const double angle = -2.0 * kPi * (column % kAround) / kAround, r = 1.0 - 0.999 * double(row) / kRings;
    const double phase = 38.0 * r + 1.5 * sine(3.0 * angle), wave = height * sine(phase),
                 slope = height * 38.0 * cosine(phase);
    const glm::dvec3 out(cosine(angle), 0.0, sine(angle));
    return SurfacePoint{out * r + glm::dvec3(0.0, wave, 0.0), glm::dvec3(0.0, 1.0, 0.0) - out * slope};
  });
  return mesh;
}

}  // namespace trueshade
