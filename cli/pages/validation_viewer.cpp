#include "cli/pages/validation_viewer.h"

#include <algorithm>
#include <utility>

#include "cli/pages/page.h"
#include "cli/pages/pixel_classes.h"
#include "cli/pages/validation_parts.h"
#include "cli/pages/validation_places.h"
#include "cli/pages/viewer.h"

namespace trueshade {
namespace {

using oracle::StageVerdict;

/// The captured plane that is looked at: the target, or of a capture without one the first plane that both have.
struct ComparedPlane {
  const Image *reference = nullptr, *test = nullptr;
  std::string name = "color";
};

ComparedPlane compared_plane(const Validation& v) {
  if (!v.reference) return {};
  if (v.capture.color.width > 0) return {&v.reference->color, &v.capture.color};
  for (const NamedImage& ours : v.reference->aovs) {
    const Image* theirs = v.capture.plane(ours.name);
    if (theirs != nullptr && theirs->format == ours.image.format && info(ours.image.format).channels > 1)
      return {&ours.image, theirs, ours.name};
  }
  return {};
}

/// Of several pixels' values: floats as linear light, directions and positions between their least and their most.
PageLayer value_layer(const std::string& id, const std::string& name, const std::string& about, const Image& image,
                      const std::string& plane) {
  const bool is_light = plane == "color" || plane == "albedo" || plane == "specular" || plane == "emission";
  PageLayer layer = is_light ? layer_of_image(id, name, about, image) : layer_of_extents(id, name, about, image);
  const std::string axes = plane == "position" || plane == "normal" ? "XYZW" : plane == "uv" ? "UV" : "RGBA";
  for (size_t k = 0; k < layer.channels() && layer.channels() > 1; ++k)
    layer.channel_names[k] = std::string(1, axes[std::min(k, axes.size() - 1)]);
  return layer;
}

PageLayer class_layer(const StageVerdict& s, const std::string& under) {
  PageLayer layer;
  layer.id = "classes-" + s.stage, layer.name = "Classes, " + s.stage;
  layer.about = "How each pixel of the stage " + s.stage + " was judged, a colour a class.";
  layer.look = Look::classes, layer.reduction = Reduction::largest;
  layer.channel_names = {""}, layer.widths = {8};
  layer.width = s.width, layer.height = s.height;
  layer.classes = classes_of(s);
  layer.details.put("stage", s.stage);
  if (!under.empty()) layer.details.put("under", under);
  layer.read = [&s](int x, int y, int count, uint32_t* codes) {
    for (int i = 0; i < count; ++i) codes[i] = uint32_t(s.classes[size_t(y) * size_t(s.width) + size_t(x + i)]);
  };
  return layer;
}

/// A picture of how far two are apart, each difference enlarged, for paper and pages without scripts.
Image difference_picture(const Image& from, const Image& to, int gain) {
  Image picture(from.width, from.height, Format::rgba8);
  const FormatInfo layout = info(from.format);
  for (int y = 0; y < from.height; ++y)
    for (int x = 0; x < from.width; ++x) {
      uint8_t* texel = picture.texel(x, y);
      for (int k = 0; k < std::min(layout.channels, 3); ++k) {
        const uint32_t a = from.code(x, y, k), b = to.code(x, y, k);
        const double apart = layout.number_class == NumberClass::floating
                                 ? (a == b ? 0.0 : std::abs(from.value(x, y, k) - to.value(x, y, k)))
                                 : (a > b ? a - b : b - a) / double(layout.largest_code(k));
        texel[k] = apart * gain < 1 ? uint8_t(apart * gain * 255 + 0.5) : 255;  // NaN is shown as white
      }
      texel[3] = 255;
    }
  return picture;
}

std::string pictures_of(const Validation& v, const ComparedPlane& plane, int gain) {
  std::string html = "<div class=pictures>\n";
  if (plane.reference != nullptr) {
    html += figure(*plane.reference, "Reference", "what Trueshade draws of the same scene and pipeline");
    html += figure(*plane.test, "Test", "as captured");
    html += figure(difference_picture(*plane.reference, *plane.test, gain), "Difference",
                   "how far both are apart, enlarged " + std::to_string(gain) + " times");
  }
  for (const StageVerdict& s : v.verdict.stages)
    html += figure(class_picture(s), "Classes of stage " + s.stage, "a colour each; violations enlarged");
  return html + "</div>\n";
}

void add_planes(const Validation& v, PageViewer& viewer) {
  if (!v.reference) return;
  for (const NamedImage& plane : v.reference->aovs) {
    if (plane.name == "id.object")
      viewer.add(layer_of_ids("object", "Object", "The object that the reference shows, from 1; 0 is nothing drawn.",
                              plane.image));
    if (plane.name == "light.count")
      viewer.add(layer_of_counts("lights", "Lights", "How many lights reach and face the surface in the reference.",
                                 plane.image));
  }
}

}  // namespace

void add_judgement(const Validation& v, PageViewer& viewer, const std::string& under) {
  for (const StageVerdict& s : v.verdict.stages) viewer.add(class_layer(s, under));
  if (const StageVerdict* failed = failed_stage(v.verdict)) viewer.opens = "classes-" + failed->stage;
  for (Places& places : places_of(v)) viewer.places.push_back(std::move(places));
  for (PixelExplanation& worst : worst_pixels_of(v)) viewer.explanations.push_back(std::move(worst));
}

std::string validation_viewer(const Validation& v, const Scene& scene) {
  constexpr int kGain = 16;
  const ComparedPlane plane = compared_plane(v);
  PageViewer viewer;
  viewer.gain = kGain;
  if (plane.reference != nullptr) {
    viewer.add(value_layer("reference", "Reference", "What Trueshade draws of the same scene and pipeline.",
                           *plane.reference, plane.name));
    viewer.add(value_layer("test", "Test", "What was captured, as it is stored.", *plane.test, plane.name));
    const bool is_same_layout = plane.reference->format == plane.test->format;
    if (is_same_layout) {
      viewer.layers.back().base = "reference";
      viewer.add(layer_of_difference("Difference",
                                     "How far test and reference are apart, channel by channel, enlarged.",
                                     viewer.layers[0], viewer.layers[1]));
      const bool is_float = info(plane.test->format).number_class == NumberClass::floating;
      viewer.compared = Compared{"reference", "test",
                                 std::string(is_float ? "Floats" : "Codes") + " as they are stored in " +
                                     std::string(info(plane.test->format).name) +
                                     ". The reference is one legal picture; others are legal too."};
    }
  }
  add_judgement(v, viewer, plane.test != nullptr ? "test" : "");
  add_planes(v, viewer);
  add_accounts(scene, v, viewer);
  viewer.explain_command = v.explain_command;
  return viewer_part(viewer, pictures_of(v, plane, kGain), 0);
}

}  // namespace trueshade
