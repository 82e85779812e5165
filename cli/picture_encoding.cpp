#include "cli/picture_encoding.h"

#include <algorithm>

#include "cli/looks.h"
#include "core/file_ending.h"

namespace trueshade {

ImageFileOptions file_options(const RenderOptions& options, const Pipeline& pipeline, const Scene& scene) {
  ImageFileOptions file;
  if (pipeline.view != ImageView::lit || pipeline.post.encode == PostChain::Encode::srgb)
    file.values = PictureValues::display_codes;
  if (options.encode) file.encoding = *options.encode;
  file.display = display_of(options.looks, pipeline, scene);
  file.threads = options.execution.threads;
  return file;
}

std::string encoding_note(const RenderOptions& options, const Pipeline& pipeline, const Scene& scene) {
  const Format format = pipeline.post.active() ? pipeline.post.output : pipeline.target;
  const bool linear = info(format).number_class == NumberClass::floating &&
                      file_options(options, pipeline, scene).values == PictureValues::of_target;
  const bool png = std::any_of(options.outputs.begin(), options.outputs.end(),
                               [](const std::string& path) { return has_ending(path, ".png"); });
  const bool is_usual = scene.is_model && !options.target && !options.preset && !options.pipeline_file;
  if (!linear || !png || options.encode || is_usual) return {};
  return "The target " + std::string(info(format).name) +
         " holds linear light, and the PNG is sRGB-encoded as screens take it (--encode srgb says so, --encode raw "
         "stores the values as they are)";
}

}  // namespace trueshade
