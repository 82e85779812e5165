#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "shading/frame.h"
#include "shading/output/post.h"

namespace trueshade {

/// The least part of the picture around `region` that has to be drawn so that the region gets the picture's pixels:
/// whole squares of `light.tile`, and as many pixels around as bloom and the edge filter look away from a pixel.
/// `planes`: those that the frame needs.
PictureRegion region_to_draw(const Pipeline& pipeline, const PictureRegion& region,
                             std::span<const std::string> planes);

/// The part of `from`, an image of the region `drawn`, that shows the region `part` of it.
Image part_of(Image from, const PictureRegion& drawn, const PictureRegion& part);

/// Whether a region's pixels depend on a number that only the whole picture tells: see PictureConstants.
bool has_constants(const Pipeline& pipeline);

/// What some rows of a picture add to its PictureConstants.
struct MeasuredRows {
  std::vector<double> logarithms;   ///< of each row the sum of its pixels'; empty where no tones are mapped
  uint32_t view_scale = 1;          ///< of these rows alone
  std::array<Extent, 3> extents{};  ///< of these rows alone
};

/// Finds PictureConstants some rows at a time. To measure rows takes as long as to draw them, and any process may do
/// it: the numbers are the same, bit for bit. Borrows scene and pipeline, which has_constants().
class PictureMeasurement {
 public:
  PictureMeasurement(const PreparedScene& scene, const Pipeline& pipeline);

  int parts() const;
  MeasuredRows measure(int part, const Execution& execution) const;  ///< counts from the top; Error as render_frame()
  void add(const MeasuredRows& rows);                                ///< all parts in turn
  PictureConstants constants() const;                                ///< of a picture whose parts are all added

 private:
  std::vector<PictureRegion> regions(int part) const;

  const PreparedScene& scene_;
  const Pipeline& pipeline_;
  const int width_, rows_;  // of a region that is drawn at a time
  LogarithmicMean logarithms_;
  PictureConstants constants_;
};

/// Measures all parts in turn.
PictureConstants picture_constants(const PreparedScene& scene, const Pipeline& pipeline, const Execution& execution);

}  // namespace trueshade
