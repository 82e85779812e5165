#include "cli/banded_picture.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "bands/picture_writer.h"
#include "cli/notes.h"
#include "cli/picture_encoding.h"
#include "cli/pictures.h"
#include "core/file_ending.h"
#include "core/threads/clock.h"

namespace trueshade {
namespace {

/// An image that has no texels.
Image shape(int width, int height, Format format) {
  Image image;
  image.width = width, image.height = height, image.format = format;
  return image;
}

/// All that may change a byte of the files.
std::string identity_of(const LargePicture& picture) {
  std::string text;
  for (const auto& [key, value] : picture.metadata) text += key + '=' + value + '\n';
  for (const std::string& name : picture.aovs) text += name + '\n';
  for (const std::string& file : picture.files) text += file + '\n';
  return text + std::to_string(int(picture.file_options.values)) + ' ' +
         std::to_string(int(picture.file_options.encoding));
}

Metadata metadata_without_hash(const RenderedFrame& result) {
  Metadata metadata = metadata_of(result);
  std::erase_if(metadata, [](const auto& entry) { return entry.first == "trueshade:imageHash"; });
  return metadata;
}

/// Files that grow.
class BandsIntoFiles : public BandConsumer {
 public:
  BandsIntoFiles(const LargePicture& picture, Resume resume)
      : picture_(picture), writer_(picture, identity_of(picture), resume) {}

  int rows_done() const override { return writer_.rows_done(); }
  const std::string& why_anew() const { return writer_.why_anew(); }
  void take(const DrawnBand& band) override { writer_.take(band); }
  void finish(RenderedFrame& result) override {
    PictureWriter::Finished finished = writer_.finish();
    result.image_hash = std::move(finished.hash);
    result.aov_hashes = std::move(finished.plane_hashes);
    result.frame.stats = std::move(finished.counts);
    const PictureRegion drawn = picture_.drawn();
    result.frame.color = shape(drawn.width, drawn.height, picture_.color());
    const std::vector<Format> formats = picture_.planes();
    for (size_t i = 0; i < formats.size(); ++i)
      result.frame.aovs.push_back({picture_.aovs[i], shape(drawn.width, drawn.height, formats[i])});
  }

 private:
  const LargePicture& picture_;
  PictureWriter writer_;
};

/// A picture in memory.
class BandsIntoMemory : public BandConsumer {
 public:
  explicit BandsIntoMemory(const LargePicture& picture) : picture_(picture) {
    const PictureRegion drawn = picture.drawn();
    frame_.color = Image(drawn.width, drawn.height, picture.color());
    const std::vector<Format> formats = picture.planes();
    for (size_t i = 0; i < formats.size(); ++i)
      frame_.aovs.push_back({picture.aovs[i], Image(drawn.width, drawn.height, formats[i])});
    frame_.view_scale = picture.constants.view_scale;
  }

  int rows_done() const override { return 0; }
  void take(const DrawnBand& band) override {
    copy(band.color, frame_.color);
    for (size_t i = 0; i < band.planes.size(); ++i) copy(band.planes[i], frame_.aovs[i].image);
    rows_ += band.rows;
    add_counts(band.counts, frame_.stats);
  }
  void finish(RenderedFrame& result) override { result.frame = std::move(frame_); }

 private:
  void copy(std::span<const uint8_t> texels, Image& to) const {
    std::memcpy(to.texel(0, rows_), texels.data(), texels.size());
  }

  const LargePicture& picture_;
  Frame frame_;
  int rows_ = 0;
};

}  // namespace

bool is_streamed(const RenderOptions& options, const Pipeline& pipeline) {
  const bool streams = std::none_of(options.outputs.begin(), options.outputs.end(),
                                    [](const std::string& path) { return has_ending(path, ".html"); });
  return streams && !options.cube_map && !options.raw_video && is_large(pipeline, options.execution.region);
}

BandedPicture::BandedPicture(const RenderOptions& options, const PreparedScene& scene, const Execution& execution,
                             RenderedFrame result, const std::vector<std::string>& files, int rows)
    : options_(options),
      streamed_(trueshade::is_streamed(options, result.pipeline)),
      result_(std::move(result)),
      picture_{scene, result_.pipeline, execution, planes_to_render(options), {}, {}, {}, {}} {
  if (streamed_) {
    picture_.files = files;
    picture_.metadata = metadata_without_hash(result_);
    picture_.file_options = file_options(options, picture_.pipeline, result_.scene);
    picture_.file_options.threads = execution.threads;
  }
  picture_.rows = rows != 0 ? rows : band_rows(picture_);
}

void BandedPicture::set_constants(const PictureConstants& constants) {
  picture_.constants = constants;
  result_.frame.view_scale = constants.view_scale;
}

void BandedPicture::begin() {
  if (!streamed_) {
    consumer_ = std::make_unique<BandsIntoMemory>(picture_);
    return;
  }
  const Resume resume = !options_.resume ? Resume::no : options_.json ? Resume::with_plane_hashes : Resume::yes;
  auto files = std::make_unique<BandsIntoFiles>(picture_, resume);
  picture_.rows_done = files->rows_done();
  if (picture_.rows_done > 0)
    say_notes(
        {"The picture goes on after " + std::to_string(picture_.rows_done) + " rows that an earlier run has drawn"});
  if (!files->why_anew().empty()) say_notes({"The picture begins anew, because " + files->why_anew()});
  consumer_ = std::move(files);
}

std::vector<uint8_t> BandedPicture::bytes_of(const DrawnBand& band) const {
  return bytes_of_band(band, streamed_ && !options_.json ? SentPlanes::no : SentPlanes::yes);
}

void BandedPicture::take(const DrawnBand& band) {
  if (result_.start_ms == 0.0) result_.start_ms = process_ms();  // of bands, the first whole one is what counts
  consumer_->take(band);
}

RenderedFrame& BandedPicture::finish() {
  const uint32_t view_scale = result_.frame.view_scale;
  consumer_->finish(result_);
  result_.frame.view_scale = view_scale;
  return result_;
}

}  // namespace trueshade
