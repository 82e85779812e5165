#pragma once
#include <functional>
#include <optional>
#include <string_view>

#include "scenes/json/json_value.h"
#include "scenes/timeline.h"

// How the values of an object, a light or a camera of a scene's text are read: said once, or by steps over time.
namespace trueshade {

/// A value that an object of the text names, checked; nothing where it does not name it. Of a step as of the whole.
using ValueReader = std::function<std::optional<glm::dvec4>(const json::Node& object)>;

/// Reader of `components` numbers under a key: one number for 1, else an array. Rounded to float.
ValueReader numbers(std::string_view key, int components, double least, double most);

/// Reader of an angle in degrees, in radians; not rounded to float.
ValueReader degrees(std::string_view key, double least, double most);

/// What the text says of one value.
struct Said {
  std::optional<glm::dvec4> value;  ///< the same at all times
  std::optional<Track> track;       ///< by steps; never both
  bool at_all() const { return value || track; }
};

/// The steps of one object, light or camera. Borrows the node.
class StepReader {
 public:
  /// Checks the steps' keys and times. `step_keys` are those a step may have.
  StepReader(const json::Node& node, const json::ObjectKeys& step_keys);

  /// What the node or its steps say of a value. Fails where both do.
  Said said(std::string_view key, const ValueReader& read) const;

  /// As said() of unit vectors; fails where two steps in a row are opposite, as nothing leads from one to the other.
  Said said_direction(std::string_view key, const ValueReader& read) const;

 private:
  const json::Node& node_;
  std::optional<json::Node> steps_;
  Track frame_;  // the times of all steps, and how they are joined
};

}  // namespace trueshade
