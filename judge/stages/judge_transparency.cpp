#include "judge/stages/judge_transparency.h"

#include <algorithm>
#include <cstring>

#include "core/error.h"
#include "core/threads/parallel_for.h"

namespace trueshade::oracle {

namespace {

/// The target before and after transparent objects, from the driver's own state before each.
class TransparencyJudge {
 public:
  TransparencyJudge(const Scene& scene, const Pipeline& pipeline, const Profile& profile, const Capture& capture)
      : pipeline_(pipeline),
        profile_(profile),
        mask_(capture.mask),
        layers_(scene, pipeline, profile, capture),
        classes_(size_t(pipeline.width) * size_t(pipeline.height), PixelClass::exact),
        rows_(size_t(pipeline.height)) {
    for (size_t i = 0; i < classes_.size(); ++i)
      if (mask_.has(i)) classes_[i] = PixelClass::left_out;
  }

  void start(const Image& target) { before_ = target; }

  /// Objects [first, end) were drawn.
  void objects(uint32_t first, uint32_t end, const Image& target) {
    parallel_for(pipeline_.height, 0, [&](int y) {
      for (int x = 0; x < pipeline_.width; ++x)
        if (!mask_.has(x, y)) judge(x, y, first, end, target);
    });
    before_ = target;
  }

  StageVerdict verdict() {
    for (int y = 0; y < pipeline_.height; ++y)
      for (int x = 0; x < pipeline_.width; ++x) rows_[size_t(y)].classes.push_back(classes_[at(x, y)]);
    return verdict_of("transparency", profile_, pipeline_.width, pipeline_.height, rows_);
  }

 private:
  size_t at(int x, int y) const { return size_t(y) * size_t(pipeline_.width) + size_t(x); }

  void judge(int x, int y, uint32_t first, uint32_t end, const Image& target) {
    const PlaneView before(&before_), after(&target);
    std::vector<LayeredTexel> ways(1);
    for (int k = 0; k < before.channels; ++k) ways[0].texel[size_t(k)] = known_texel(before.stored(x, y, k));
    RowTally& row = rows_[size_t(y)];
    const TransparentPixel pixel = layers_.any(x, y) ? layers_.at(x, y, first, end) : TransparentPixel{};
    if (pixel.layers.empty()) {
      const size_t bytes = size_t(before.layout.bytes_per_texel());
      if (std::memcmp(before_.texel(x, y), target.texel(x, y), bytes) == 0) return;
    } else {
      ways = layers_.ways(pixel, ways[0].texel);
      may_have_other_layers(pixel, uint32_t(y) * uint32_t(pipeline_.width) + uint32_t(x), row);
      row.covered += pixel.layers.front().drawn ? 1 : 0;
    }
    LayeredVerdict v = judge_ways(ways, after, "color", x, y, profile_);
    if (profile_.blend == BlendRule::any_precision) v.match.choices.clear();  // factors may be rounded in many ways
    if (worse(v.pixel_class, classes_[at(x, y)])) classes_[at(x, y)] = v.pixel_class;
    const uint32_t instance = pixel.layers.empty() ? first : pixel.layers.front().instance;
    row.record(x, y, v.pixel_class, v.match, "after transparent instance " + std::to_string(instance));
  }

  const Pipeline pipeline_;
  const Profile profile_;
  const PixelMask& mask_;
  const TransparentLayers layers_;
  std::vector<PixelClass> classes_;
  std::vector<RowTally> rows_;
  Image before_;
};

}  // namespace

LayeredVerdict judge_ways(std::span<const LayeredTexel> ways, const PlaneView& view, const char* name, int x, int y,
                          const Profile& profile) {
  LayeredVerdict closest;
  bool undefined = false;
  const auto pixel = uint32_t(size_t(y) * size_t(view.image->width) + size_t(x));
  for (size_t i = 0; i < ways.size(); ++i) {
    const LayeredTexel& way = ways[i];
    Match m;
    for (int k = 0; k < view.channels; ++k) {
      const LegalTexel& t = way.texel[size_t(k)];
      m.texel_is(view, name, k, t, view.quantised() ? way.value[size_t(k)] : t.nominal, view.stored(x, y, k), pixel,
                 profile);
    }
    undefined = undefined || way.undefined;
    if (m.legal && !way.undefined) {
      PixelClass c = way.pixel_class;
      if (m.second && worse(PixelClass::store_2, c)) c = PixelClass::store_2;
      if (m.second && way.looked_up && worse(PixelClass::tex, c)) c = PixelClass::tex;
      m.choices.clear(), m.store_count = 0;  // of several blends: which of them chose is not known
      return {c, m};
    }
    if (i == 0 || m.excess < closest.match.excess) closest.match = m;
  }
  closest.pixel_class = undefined ? PixelClass::undefined : PixelClass::violation;
  closest.match.choices.clear();
  closest.match.stored_values = 0;
  return closest;
}

void may_have_other_layers(const TransparentPixel& pixel, uint32_t at, RowTally& row) {
  double same = 1;
  const TransparentLayer* open = nullptr;
  for (const TransparentLayer& layer : pixel.layers) {
    if (layer.either_way) same *= 0.5, open = &layer;
    if (layer.certain) continue;
    same *= 1 - double(layer.chance_other);
    open = &layer;
  }
  if (open != nullptr) row.may_be_other(at, uint64_t(open->instance) << 32 | open->triangle, 1 - same);
}

StageVerdict judge_transparency(const Scene& scene, const Pipeline& pipeline, const Profile& profile,
                                const Capture& capture, const LightSteps& objects) {
  TransparencyJudge judge(scene, pipeline, resolved(profile, pipeline), capture);
  int last = -2;
  objects([&](int instance, const Image& target) {
    if ((last == -2) != (instance == -1) || instance <= last || target.width != pipeline.width ||
        target.height != pipeline.height || target.format != capture.color.format)
      throw Error(ErrorKind::bad_input, "target after instance " + std::to_string(instance),
                  "is not one that comes next",
                  "hand over -1 and then transparent instances in order, in the capture's size and format");
    if (instance < 0)
      judge.start(target);
    else
      judge.objects(uint32_t(std::max(0, last + 1)), uint32_t(instance) + 1, target);
    last = instance;
  });
  for (size_t i = size_t(std::max(0, last + 1)); i < scene.instances.size(); ++i)
    if (scene.materials[scene.instances[i].material].transparent)
      throw Error(ErrorKind::bad_input, capture.name, "ends before transparent instance " + std::to_string(i),
                  "hand over the target after the last one");
  return judge.verdict();
}

}  // namespace trueshade::oracle
