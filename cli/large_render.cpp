#include "cli/large_render.h"

#include <algorithm>

#include "bands/picture_writer.h"
#include "cli/activity.h"
#include "cli/notes.h"
#include "cli/picture_encoding.h"
#include "core/error.h"
#include "core/file_ending.h"
#include "shading/picture_region.h"

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

}  // namespace

bool renders_in_bands(const RenderOptions& options, const Pipeline& pipeline) {
  const bool streams = std::none_of(options.outputs.begin(), options.outputs.end(),
                                    [](const std::string& path) { return has_ending(path, ".html"); });
  return streams && !options.cube_map && !options.raw_video && is_large(pipeline, options.execution.region);
}

void render_in_bands(const RenderOptions& options, const PreparedScene& scene, const std::vector<std::string>& files,
                     RenderedFrame& result) {
  Activity activity("rendering", Activity::Counts::by_hand);
  PictureConstants constants;
  if (has_constants(result.pipeline)) {
    activity.now("measuring the whole picture");
    constants = picture_constants(scene, result.pipeline, result.execution,
                                  [&activity](int done, int total) { activity.show(done, total, "parts"); });
    activity.now("rendering");
  }
  result.frame.view_scale = constants.view_scale;
  LargePicture picture{scene,
                       result.pipeline,
                       result.execution,
                       options.aovs,
                       files,
                       metadata_without_hash(result),
                       file_options(options, result.pipeline),
                       constants};
  picture.rows = band_rows(picture);
  PictureWriter writer(picture, identity_of(picture), options.resume ? Resume::yes : Resume::no);
  picture.rows_done = writer.rows_done();
  if (options.resume && picture.rows_done > 0)
    say_notes(
        {"The picture goes on after " + std::to_string(picture.rows_done) + " rows that an earlier run has drawn"});
  for (int band = 0; band < picture.bands(); ++band) {
    writer.take(draw_band(picture, band));
    activity.show(band + 1, picture.bands(), "bands");
  }
  PictureWriter::Finished finished = writer.finish();
  result.image_hash = finished.hash;
  result.frame.stats = finished.counts;
  result.aov_hashes = std::move(finished.plane_hashes);
  const PictureRegion drawn = picture.drawn();
  result.frame.color = shape(drawn.width, drawn.height, picture.color());
  const std::vector<Format> formats = picture.planes();
  for (size_t i = 0; i < formats.size(); ++i)
    result.frame.aovs.push_back({options.aovs[i], shape(drawn.width, drawn.height, formats[i])});
}

}  // namespace trueshade
