#pragma once
// What people get wrong of a G-buffer: how a plane is encoded, and how surfaces are drawn.
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "judge/bounds/profile.h"
#include "judge/diagnosis/expected_planes.h"
#include "judge/diagnosis/fault_parameter.h"

namespace trueshade::oracle {

/// The planes that are compared, in the order of kPlaneNames; `all` stands for every one.
enum class Plane : uint8_t { depth, position, normal, albedo, uv, object, material, specular, emission, all };
inline constexpr size_t kPlanes = 9;
inline constexpr std::string_view kPlaneNames[] = {"depth",     "position",    "normal",   "albedo",   "uv",
                                                   "id.object", "id.material", "specular", "emission", "G-buffer"};

/// What the encoding of a plane depends on beside the pixel's numbers.
struct PlaneContext {
  const Scene& scene;
  const Pipeline& pipeline;
  std::array<std::array<double, 3>, 3> view{};  ///< rows: right, up, towards the viewer
  std::array<double, 3> eye{};                  ///< where all rays meet; of an orthographic matrix the camera's
};

/// The context of encodings for a scene. Borrows both arguments.
PlaneContext plane_context(const Scene& scene, const Pipeline& pipeline);

/// How a plane is flipped and shifted.
struct PlaneMove {
  bool flip_x = false, flip_y = false;
  int x = 0, y = 0;
};

struct PlaneEvidence;

/// Which pixels the numbers of a suspected fault are fitted to.
enum class Fit : uint8_t {
  none,    ///< they are as they are suspected
  object,  ///< the pixels of one object
  camera   ///< all pixels
};

/// A row of the tables of G-buffer faults: what a renderer does wrong, and how it changes the expected planes.
struct PlaneFault {
  enum class Search : uint8_t {
    none,          ///< it has no number
    one_of,        ///< the best of `starts`
    depth_offset,  ///< the middle of what depths are off by
    object,        ///< an object that has pixels which are wrong
    smooth,        ///< a factor, from the best of `starts`
    suspected      ///< what `suspects` names, and the numbers by least squares
  };
  std::string_view name, text;  ///< text: `%s` stands for the parameter
  Plane plane = Plane::all;     ///< the one that the fault changes; `all` where it draws otherwise
  void (*change)(const PlaneContext&, PlaneValues&, double) = nullptr;
  bool (*redraw)(Scene&, Pipeline&, double) = nullptr;  ///< false: it changes nothing here
  void (*move)(PlaneMove&, double) = nullptr;
  Search search = Search::none;
  std::span<const double> starts{};
  double doubt = 0;
  double reach = 0;  ///< steps of the plane, or of what it rounds to, by which a prediction may be off
  std::string (*says)(double) = nullptr;
  // Of Search::suspected:
  bool (*edit)(Scene&, Pipeline&, const FaultParameter&) = nullptr;         ///< as redraw, by all numbers
  std::vector<FaultParameter> (*suspects)(const PlaneEvidence&) = nullptr;  ///< parameters to start from
  ParameterForm numbers{};
  enum class Of : uint8_t { object, material } of = Of::object;  ///< what FaultParameter::number counts
  Fit fit = Fit::none;
  bool averages = false;   ///< pixels that are off may be averages of two surfaces beside one another
  bool estimated = false;  ///< `suspects` estimates its numbers from the pixels
  double start = 0;        ///< of each number: what changes nothing
  bool (*sample)(const Scene&, Sampling&, double) = nullptr;  ///< as redraw, by how textures are read
  double change_of = 0;  ///< a small change of a number; below 0: times the scene's extent

  /// Which numbers the fault's parameter has.
  ParameterForm form() const {
    if (search == Search::suspected) return numbers;
    return {search != Search::none, false, 0};
  }
  /// Whether the fault's numbers are estimated from the pixels, and only as exact as these.
  bool is_estimate() const { return fit != Fit::none || search == Search::smooth || estimated; }
  /// Whether the fault changes what is drawn, so that all expected planes must be made again.
  bool redraws() const { return redraw != nullptr || edit != nullptr || sample != nullptr; }
};

// Shorter names of the searches that the tables use most.
inline constexpr auto kOneOf = PlaneFault::Search::one_of, kSmooth = PlaneFault::Search::smooth;

/// Faults of how planes are encoded, flipped and shifted (plane_faults.cpp).
std::span<const PlaneFault> plane_faults();
/// Faults of how the planes specular and emission are encoded (gloss_faults.cpp).
std::span<const PlaneFault> gloss_faults();
/// Faults of the drawing state and of the scene, which change what is drawn (redraw_faults.cpp).
std::span<const PlaneFault> redraw_faults();
/// Faults of one object: its matrix and its triangles (object_faults.cpp).
std::span<const PlaneFault> object_faults();
/// Faults of the camera (camera_faults.cpp).
std::span<const PlaneFault> camera_faults();
/// Faults of one material (material_faults.cpp).
std::span<const PlaneFault> material_faults();

}  // namespace trueshade::oracle
