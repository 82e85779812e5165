#pragma once
// One picture of `render` that is drawn in bands, by this process or by several.
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bands/drawn_band.h"
#include "cli/frame_text.h"
#include "cli/options.h"

namespace trueshade {

/// Whether the files of a picture are streamed while it is drawn: large pictures, into .png and .exr.
bool is_streamed(const RenderOptions& options, const Pipeline& pipeline);

/// Takes the bands of a picture, from the top down.
class BandConsumer {
 public:
  virtual ~BandConsumer() = default;
  virtual int rows_done() const = 0;               ///< that an earlier run has drawn
  virtual void take(const DrawnBand& band) = 0;    ///< Error(io)
  virtual void finish(RenderedFrame& result) = 0;  ///< Error(io)
};

class BandedPicture {
 public:
  /// `result`: a frame that is not drawn yet. `files`: of the outputs. `band_rows`: 0: by the memory that there is;
  /// else a multiple of kStripRows for files that are streamed.
  BandedPicture(const RenderOptions& options, const PreparedScene& scene, const Execution& execution,
                RenderedFrame result, const std::vector<std::string>& files, int band_rows);

  /// Before anything else where has_constants().
  void set_constants(const PictureConstants& constants);

  BandedPicture(const BandedPicture&) = delete;
  BandedPicture& operator=(const BandedPicture&) = delete;

  /// Makes what takes the bands, once: the files, or the picture in memory. Rows that are done are not drawn again.
  void begin();
  int rows_done() const { return picture_.rows_done; }
  void set_rows_done(int rows) { picture_.rows_done = rows; }  ///< as begin() has found them on another rank

  int bands() const { return picture_.bands(); }
  DrawnBand draw(int band) const { return draw_band(picture_, band); }
  std::vector<uint8_t> bytes_of(const DrawnBand& band) const;
  DrawnBand band_of(int index, std::vector<uint8_t> bytes) const {
    return band_of_bytes(picture_, index, std::move(bytes));
  }

  void take(const DrawnBand& band);
  /// The picture, once all bands are taken. Of a streamed one the images have no texels, hashes are known, and the
  /// files are written.
  RenderedFrame& finish();
  bool is_streamed() const { return streamed_; }

 private:
  const RenderOptions& options_;
  const bool streamed_;
  RenderedFrame result_;
  LargePicture picture_;
  std::unique_ptr<BandConsumer> consumer_;
};

}  // namespace trueshade
