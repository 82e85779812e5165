#include "cli/judged_mask.h"

#include "shading/frame.h"

namespace trueshade {
namespace {

const Image* plane_named(const std::vector<NamedImage>& planes, const std::string& name) {
  for (const NamedImage& plane : planes)
    if (plane.name == name) return &plane.image;
  return nullptr;
}

/// Leaves out where a plane holds one of the numbers. Returns whether it holds one anywhere.
bool leave_out_where(const Image& ids, const compare::IgnoredIds& ignored, PixelMask& mask) {
  bool found = false;
  for (int y = 0; y < mask.height; ++y)
    for (int x = 0; x < mask.width; ++x)
      if (ignored.has(uint32_t(ids.value(x, y, 0))))
        mask.left_out[size_t(y) * size_t(mask.width) + size_t(x)] = 1, found = true;
  return found;
}

void check_covered(const compare::MaskRules& rules, const Image& objects, const PixelMask& mask) {
  uint64_t covered = 0, left_out = 0;
  for (int y = 0; y < mask.height; ++y)
    for (int x = 0; x < mask.width; ++x)
      if (objects.value(x, y, 0) != 0.0) ++covered, left_out += mask.has(x, y) ? 1 : 0;
  compare::check_left_out(rules, left_out, covered, "pixels with a surface");
}

}  // namespace

PixelMask judged_mask(const compare::MaskRules& rules, const PictureFile* file, const Scene& scene, Pipeline pipeline,
                      const oracle::Capture& capture, std::vector<std::string>* notes) {
  PixelMask mask{pipeline.width, pipeline.height, {}};
  if (file != nullptr)
    mask = compare::mask_of(*file, pipeline.width, pipeline.height);
  else
    mask.left_out.resize(size_t(mask.width) * size_t(mask.height));
  pipeline.post = {}, pipeline.view = ImageView::lit;
  const std::vector<std::string> planes = {"id.object", "id.material"};
  const std::vector<NamedImage> ours = render_frame(scene, pipeline, {}, planes).aovs;
  for (const compare::IgnoredIds& ignored : rules.ignored) {
    bool found = false;
    for (const std::vector<NamedImage>* ids : {&ours, &capture.planes})
      if (const Image* plane = plane_named(*ids, ignored.plane)) found |= leave_out_where(*plane, ignored, mask);
    if (!found && notes != nullptr)
      notes->push_back("--ignore " + ignored.text() + " leaves nothing out: no pixel has it");
  }
  compare::check_left_out(rules, mask.count(), mask.left_out.size(), "pixels");
  check_covered(rules, *plane_named(ours, "id.object"), mask);
  return mask;
}

}  // namespace trueshade
