#pragma once
#include <functional>
#include <glm/vec2.hpp>
#include <vector>

#include "scenes/mesh.h"
#include "scenes/shapes.h"

// Turned and arched parts of buildings, for the built-in scenes. As scenes/shapes.h: computed in double, triangles
// counter-clockwise seen from where the normals point to.
namespace trueshade {

/// Appends a net of columns x rows quads, patch after patch. `surface` gives the point of grid line (column, row);
/// going along columns, then rows, then normals is right-handed.
void add_net(Mesh& mesh, int columns, int rows, const std::function<SurfacePoint(int column, int row)>& surface);

/// A profile in (radius, y), from the bottom up on the outside; each curve is smooth in itself, with edges between
/// them.
using Profile = std::vector<std::vector<glm::dvec2>>;

/// Points of a quarter of an ellipse from `from` to `to`, that bulges outwards (or hollows), for profiles.
std::vector<glm::dvec2> rounded(const glm::dvec2& from, const glm::dvec2& to, bool bulges, int steps = 6);

/// The profile turned about the y axis in `segments` steps; `flutes` grooves of depth `groove` (share of the radius).
Mesh turned_mesh(const Profile& profile, int segments, int flutes = 0, double groove = 0.0);

/// A wall along x with a round opening: from -width/2 to width/2, from y = 0 (where the arc springs) to `height`,
/// `thickness` along z, an opening of radius `radius`, and a moulding around it on both faces.
Mesh arch_mesh(double width, double height, double thickness, double radius);

/// Half a cylinder seen from inside, along z from -1/2 to 1/2, of radius 1 over y = 0, with coffers sunk by `depth` in
/// `around` x `along` cells. Ribs have the first colour, the coffers' ground the second.
Mesh vault_mesh(int around, int along, double length, double depth, const glm::dvec3& rib, const glm::dvec3& ground);

/// A round water surface of radius 1 at y = 0, with waves of that height going out from the middle.
Mesh water_mesh(double height);

}  // namespace trueshade
