#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "shading/frame.h"

namespace trueshade::viewer {

/// Where the time between two pictures goes. Wall time, ms.
enum class Part : uint8_t {
  interval,  ///< from one shown picture to the next
  draw,      ///< render_frame(), in its own thread
  convert,   ///< to the codes of a screen, in the same thread; next to nothing where the picture holds them
  compose,   ///< the picture copied to the window
  panels,    ///< panels laid out and drawn over it
  present,   ///< the window handed to the display
};
inline constexpr std::string_view kPartNames[] = {"interval", "draw", "convert", "compose", "panels", "present"};
inline constexpr size_t kParts = std::size(kPartNames);

/// The parts of one shown picture.
struct PictureTimes {
  std::array<double, kParts> ms{};
  StageTimes core_ms{};  ///< of the draw: core time by stage
  double operator[](Part part) const { return ms[size_t(part)]; }
  double& operator[](Part part) { return ms[size_t(part)]; }
};

/// The last pictures, for graphs, and figures of all since the last begin().
class FrameTimes {
 public:
  static constexpr size_t kShown = 240;

  void add(const PictureTimes& times);
  const std::vector<PictureTimes>& shown() const { return shown_; }  ///< the last kShown, oldest first

  void begin(double process_cpu_s);  ///< figures count from here
  /// One JSON object: pictures, seconds, pictures a second, CPU milliseconds a picture over all threads, and of each
  /// part the median, the 95th and 99th of 100 and the most. Empty parts where nothing was shown.
  std::string report(double process_cpu_s) const;

 private:
  std::vector<PictureTimes> shown_, counted_;
  double cpu_begin_s_ = 0.0;
};

/// The least of the values that `share` of them are not above; 0 of none.
double quantile(std::vector<double> values, double share);

/// CPU time that this process has had, over all threads, seconds.
double process_cpu_seconds();

}  // namespace trueshade::viewer
