#pragma once
// What people get wrong of a G-buffer: how a plane is encoded, and how surfaces are drawn.
#include <span>
#include <string>
#include <string_view>

#include "judge/diagnosis/expected_planes.h"

namespace trueshade::oracle {

/// The planes that are compared, as captures name them; `all` stands for every one.
enum class Plane : uint8_t { depth, position, normal, albedo, uv, object, material, all };
inline constexpr size_t kPlanes = 7;
inline constexpr std::string_view kPlaneNames[] = {"depth", "position",  "normal",      "albedo",
                                                   "uv",    "id.object", "id.material", "G-buffer"};

/// What an encoding reads beside the pixel's numbers.
struct PlaneContext {
  const Scene& scene;
  const Pipeline& pipeline;
  std::array<std::array<double, 3>, 3> view{};  ///< rows: right, up, towards the viewer
  std::array<double, 3> eye{};                  ///< where all rays meet; of an orthographic matrix the camera's
};
PlaneContext plane_context(const Scene& scene, const Pipeline& pipeline);

/// Where a plane's pixel came from.
struct PlaneMove {
  bool flip_x = false, flip_y = false;
  int x = 0, y = 0;
};

struct PlaneFault {
  enum class Search : uint8_t { none, one_of, depth_offset, object };
  std::string_view name, text;  ///< text: `%s` stands for the parameter
  Plane plane = Plane::all;     ///< that it changes; of `redraw` all of them
  void (*change)(const PlaneContext&, PlaneValues&, double) = nullptr;
  bool (*redraw)(Scene&, Pipeline&, double) = nullptr;  ///< false: there is nothing that it changes
  void (*move)(PlaneMove&, double) = nullptr;
  Search search = Search::none;
  std::span<const double> starts{};
  double doubt = 0;
  double reach = 0;  ///< steps of the plane, or of the values that it is rounded to, that it may be off
  std::string (*says)(double) = nullptr;
};

std::span<const PlaneFault> plane_faults();   ///< plane_faults.cpp: encodings and moves
std::span<const PlaneFault> redraw_faults();  ///< redraw_faults.cpp: states and scenes

}  // namespace trueshade::oracle
