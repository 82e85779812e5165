#pragma once
// Triangles in the window, as boxes: where an implementation of a profile may have put each vertex (docs/gl_rules.md
// section 9).
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "judge/bounds/level_hulls.h"
#include "judge/bounds/profile.h"
#include "oracle/exact_coverage.h"
#include "scenes/scene.h"

namespace trueshade::oracle {

using Pair = std::array<double, 2>;

/// A vertex in window space, pixels, y up, with the places that float arithmetic and snapping may give it.
struct WindowVertex {
  Pair exact{};                    ///< of the real coordinates: equal where two triangles share the vertex
  Pair low{}, high{};              ///< the box that the snapped vertex lies in; coverage is computed from it
  Pair plane{}, plane_reach{};     ///< the vertex that attribute planes go through: within reach of plane
  Pair float_reach{};              ///< what float arithmetic alone makes of `exact`
  double z = 0, z_error = 0;       ///< window depth
  double u = 0, u_error = 0;       ///< 1 / w
  std::array<double, 3> weight{};  ///< the vertex as a sum, in clip space, of the submitted triangle's three
  /// The same weights in the window, where attributes that are noperspective vary linearly (GL 4.6 core, 13.7.1), and
  /// how far each may be off.
  std::array<double, 3> linear{};
  double linear_error = 0;
};

/// A triangle in the window; where clipping cuts a triangle, one of the triangles that it leaves.
struct Piece {
  std::array<WindowVertex, 3> v;
  bool cut = false;          ///< by near, far or w
  bool leaves_view = false;  ///< has an edge that the profile may cut at the sides of the view
  bool facing_known = true;
  int sign = 1;       ///< of the area; -1: edges are turned
  bool front = true;  ///< meaningful where facing_known
  /// What is left of the triangle by near, far and w, and by the sides of the view too, where a driver may cut it into
  /// pieces of its own that a polygon offset tells apart; null elsewhere.
  std::shared_ptr<const std::vector<std::vector<WindowVertex>>> polygons{};
  /// The vertices submitted, behind the eye too (u below 0), of a cut triangle whose planes go through these; else
  /// null.
  std::shared_ptr<const std::array<WindowVertex, 3>> submitted{};
};

/// Whether a piece covers a sample.
enum class Cover : uint8_t { no, maybe, certain };

/// How a piece covers a sample. Edge i runs from vertex i+1 to vertex i+2. With A and B the edge's ends relative to the
/// sample, each coordinate anywhere in its box, the edge function is E = Ax By - Ay Bx. The four occur once each, so
/// interval arithmetic gives the exact hull. It contains the sum (|dx| + |dy|) e_v of docs/gl_rules.md section 9.
struct Coverage {
  Cover cover = Cover::no;
  unsigned uncertain_edges = 0;  ///< bit i: 0 lies in the interval of edge function i
  double chance_other = 0;       ///< predicted probability that the sample is not where nominal vertices put it
  bool nominal = true;           ///< covered where every interval is at its middle
};

/// How the piece covers the sample (x, y), pixels, y up. Cover::maybe at best where the piece's facing is not known.
///   edges: bit i: test edge i; the sample is known to lie inside of the others
Coverage coverage_at(const Piece& piece, const Profile& profile, ClipOrigin origin, double x, double y,
                     unsigned edges = 7);

/// What holds for every sample of a box, corners included. An edge function is affine in the sample, so its extremes
/// are at the corners.
struct BoxCoverage {
  bool none = false;   ///< no sample is covered
  unsigned edges = 7;  ///< bit i: some sample of the box may lie outside of edge i; 0: all are covered for certain
};

/// How the piece covers the samples from `low` to `high`, pixels, y up. The defaults, which promise nothing, where the
/// piece's facing is not known.
BoxCoverage coverage_of_box(const Piece& piece, const Pair& low, const Pair& high);

/// Whether the sample (x, y) lies to the left of a -> b by the vertices' `exact` places: by the sign of twice the area
/// of (a, b, sample), which is exactly antisymmetric in a and b. 0 is decided by the edge's direction, so that a closed
/// mesh has a definite winding number about every sample.
bool nominally_left(const WindowVertex& a, const WindowVertex& b, double x, double y);

/// Transforms a scene's triangles to window space, and bounds how far an implementation of a profile may place them.
class Projector {
 public:
  /// Borrows the scene.
  ///   drawn_at: the window pixel at the picture's lower left. GL's rules move with it (14.2); float errors do not.
  ///   hulls: hulls of the scene's textures that another projector found; null: none are known
  Projector(const Scene& scene, const Pipeline& pipeline, const Profile& profile, std::array<int, 2> drawn_at = {},
            std::shared_ptr<LevelHulls> hulls = nullptr);

  /// Whether any sample of the picture may lie in the triangle. If so, sets `rect` to the pixels that may, y up. Cheap:
  /// most triangles of a fine mesh have no sample.
  bool near_pixels(uint32_t instance, uint32_t triangle, PixelRect& rect) const;

  /// Sets `out` to the triangle's pieces: what the near and far planes and w > 0 leave. None where a clip coordinate is
  /// NaN or infinite.
  void pieces(uint32_t instance, uint32_t triangle, std::vector<Piece>& out) const;

  /// The clip coordinates of the three vertices, in floats, in the order of operations of docs/arithmetic.md. Triangles
  /// with equal clip coordinates make equal fragments (GL 4.6, appendix A).
  std::array<std::array<float, 4>, 3> clip_of(uint32_t instance, uint32_t triangle) const;

  /// The largest |x|, |y| of the viewport in the driver's window, pixels: planes are set up in these coordinates.
  const Pair& window_reach() const { return window_reach_; }
  /// The camera's matrix, in double.
  const Matrix4& clip_from_world() const { return clip_from_world_; }
  /// The profile that vertices are bounded by.
  const Profile& profile() const { return profile_; }
  /// The pipeline, a copy of its own.
  const Pipeline& pipeline() const { return pipeline_; }
  /// The scene, which is borrowed.
  const Scene& scene() const { return scene_; }
  /// The hulls of the scene's textures, for another projector of the scene.
  const std::shared_ptr<LevelHulls>& level_hulls() const { return level_hulls_; }
  /// The picture's width in pixels.
  int width() const { return pipeline_.width; }
  /// The picture's height in pixels.
  int height() const { return pipeline_.height; }

 private:
  struct ClipVertex {
    std::array<double, 4> c{}, error{};
    std::array<double, 4>
        along{};  ///< how far a cut vertex may lie along its edge: moves coverage, leaves the planes alone
    std::array<double, 3> weight{};
  };
  struct Faces {
    CullFace culled;
    FrontFace front;
  };
  struct InstanceMatrix {
    float row[4][4];
    std::array<double, 4> error;  ///< largest clip error of any vertex of the mesh
  };
  ClipVertex clip_vertex(uint32_t instance, uint32_t vertex, size_t corner) const;
  WindowVertex window_vertex(const ClipVertex& v, bool leaves_view) const;
  void snap(WindowVertex& v, int axis, const ClipVertex& clip, double error, double along, bool leaves_view) const;
  void exact_pieces(const std::array<ClipVertex, 3>& corners, const Faces& faces, std::vector<Piece>& out) const;
  void cut(std::vector<ClipVertex>& polygon, int plane) const;
  double plane_distance(const ClipVertex& v, int plane) const;
  std::vector<WindowVertex> corners_of(const std::vector<ClipVertex>& polygon) const;
  void lean_on(const std::array<WindowVertex, 3>& submitted, WindowVertex& v) const;
  void weigh_linearly(const std::array<ClipVertex, 3>& corners, WindowVertex& v) const;
  bool face(const Faces& faces, Piece& piece) const;
  Faces faces_of(uint32_t instance) const;

  const Scene& scene_;
  const Pipeline pipeline_;
  const Profile profile_;
  Viewport viewport_;
  std::array<int, 2> drawn_at_;
  Pair window_reach_{};
  Matrix4 clip_from_world_;
  std::vector<InstanceMatrix> matrices_;
  std::shared_ptr<LevelHulls> level_hulls_;
  double z_scale_, z_offset_;
};

}  // namespace trueshade::oracle
