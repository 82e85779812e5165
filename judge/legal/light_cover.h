#pragma once
// How many fragments the geometry of a light may have at a sample: deferred-volumes draws meshes without a depth test,
// so every triangle that covers the sample, and that culling leaves, is a draw of the pixel.
#include <memory>
#include <span>
#include <vector>

#include "judge/bounds/window.h"
#include "scenes/pipeline/light_mesh.h"

namespace trueshade::oracle {

/// How many fragments of a light's mesh a pixel may have: the least, the most, and the nominal number.
struct FragmentCount {
  uint8_t least = 0, most = 0;
  uint8_t nominal = 0;     ///< the number if vertices are in the middle of their boxes
  bool cut = false;        ///< the doubt comes from near, far, w or the sides of the view
  float chance_other = 0;  ///< predicted probability that the number is not the nominal one
  uint32_t triangle = 0;   ///< index of one of the mesh's triangles that are in doubt
};

/// Counts the fragments of one light's mesh at each pixel. Every count from least to most is legal, but for triangles
/// of one facing that share an edge: exactly one of them has a sample on that edge (GL 4.6 core, 14.6.1).
///
/// A triangle that reaches behind the eye has no window vertices there, and close to the eye's plane none worth the
/// name. Under depth clamp nothing but w > 0 cuts it, at a place of the driver's choosing: the sides of the view, or a
/// guard band beyond them, of 2^15 pixels at most as D3D11.3's 16.8 window coordinates have it (3.2.4.1). Wherever it
/// is cut, its edges stay on the lines through their clip coordinates: E(p) = (a x b) . p in homogeneous window
/// coordinates, inside where all three have the sign of the determinant (Olano and Greer, "Triangle Scan Conversion
/// using 2D Homogeneous Coordinates", 1997). Snapped or cut ends lie within e of the line on either axis, e = 2^-b / 2
/// + 2^-23 (3 2^15) and the float error of an end that is seen, which moves E by no more than (|alpha| + |beta|) e; an
/// error d of clip coordinates by |p x a| . d.
class LightOutline {
 public:
  /// Transforms the light's mesh to window space. Copies what it needs of the scene.
  LightOutline(const Scene& scene, const Pipeline& pipeline, const Profile& profile, std::array<int, 2> drawn_at,
               const Light& light, const LightMesh& mesh);
  ~LightOutline();

  /// Sets out[x] to the number of fragments that the mesh has at pixel x of row y (y up); to 0 outside the viewport.
  void count_row(int y, std::span<FragmentCount> out) const;

 private:
  struct Shape;
  struct Doubt;
  void add_endless(uint32_t triangle);
  void settle(int x, double y, std::span<const Doubt> doubts, FragmentCount& count) const;

  Scene scene_;  ///< the mesh alone
  std::unique_ptr<Projector> projector_;
  std::vector<Shape> shapes_;
};

}  // namespace trueshade::oracle
