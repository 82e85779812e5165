#include "view/saved_files.h"

#include <filesystem>

#include "cli/frame_text.h"
#include "cli/looks.h"
#include "core/image_files/image_io.h"
#include "scenes/pipeline/shipped_models.h"
#include "view/saved_scene.h"

namespace trueshade::viewer {
namespace {

constexpr size_t kShortHash = 12;  // digits in names

std::string named(const std::string& name, const std::string& hash, const char* ending) {
  return name + '-' + hash.substr(0, kShortHash) + ending;
}

}  // namespace

std::string write_picture(const std::string& path, const std::string& name, const EditedScene& scene,
                          const DrawnPicture& picture) {
  RenderedFrame rendered{scene.scene(), picture.pipeline, {}, picture.state.time, picture.frame, {}, {}, {}};
  rendered.image_hash = image_hash(picture.frame.color);
  rendered.scene_hash = scene_hash(scene.scene());
  rendered.looks = picture.state.looks;
  ImageFileOptions options;
  options.display = display_of(looks_of_text(rendered.looks), picture.pipeline, scene.scene());
  if (picture.pipeline.view != ImageView::lit || picture.pipeline.post.encode == PostChain::Encode::srgb)
    options.values = PictureValues::display_codes;
  const std::string file = path.empty() ? named(name, rendered.image_hash, ".png") : path;
  write_image(file, picture.frame.color, {}, metadata_of(rendered), options);
  return "wrote " + file + "  sha256:" + rendered.image_hash;
}

std::string write_scene(const std::string& path, const SceneFacts& facts, const DrawnPicture& picture) {
  const std::string hash = image_hash(picture.frame.color);
  std::string file = path;
  if (file.empty()) {
    const std::string& scene = facts.reference ? facts.reference->scene : facts.spec;
    file = named(facts.name, hash, ".json");
    if (!scene.starts_with("builtin:")) file = (std::filesystem::path(scene).parent_path() / file).string();
  }
  const std::string text = saved_scene(facts, picture, file);
  write_file(file, {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
  const std::string& model = picture.pipeline.light_program.file;
  const bool is_file = !model.empty() && !names_shipped_model(model);  // whose text is in no scene file
  return "wrote " + file + "  draws sha256:" + hash + (is_file ? " with --light-shader " + model : "");
}

}  // namespace trueshade::viewer
