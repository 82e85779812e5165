#pragma once

namespace trueshade {

/// Window depth of a triangle over its samples: z0 + (E_1 g1 + E_2 g2), clamped to what its corners reach.
/// docs/arithmetic.md section 5. depth_plane-inl.h is the same for vectors.
struct DepthPlane {
  double z0, g1, g2;
  double low, high;  ///< least and greatest depth of the corners

  /// Of a triangle with depths z at its corners in canonical order, and a positive doubled area.
  static DepthPlane of_corners(double z0, double z1, double z2, double area) {
    const double low = z1 < z2 ? z1 : z2, high = z1 < z2 ? z2 : z1;
    return {z0, (z1 - z0) / area, (z2 - z0) / area, z0 < low ? z0 : low, z0 > high ? z0 : high};
  }

  /// The plane whose depths are clamped to [least, most] as well. To clamp to the corners' range and then to [least,
  /// most] is to clamp once, to the corners' range with its ends clamped.
  DepthPlane in_range(double least, double most) const {
    return {z0, g1, g2, clamped(low, least, most), clamped(high, least, most)};
  }

  double at(double e1, double e2) const { return clamped(z0 + (e1 * g1 + e2 * g2), low, high); }

 private:
  static double clamped(double z, double least, double most) {
    const double raised = z < least ? least : z;
    return most < raised ? most : raised;
  }
};

}  // namespace trueshade
