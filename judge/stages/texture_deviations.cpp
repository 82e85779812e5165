#include "judge/stages/texture_deviations.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>

#include "core/threads/parallel_for.h"
#include "judge/legal/surface_values.h"
#include "judge/stages/tally.h"

namespace trueshade::oracle {

namespace {

/// Channels of a plane that are tested together.
struct ChannelGroup {
  std::string_view name, plane;
  int first, count;
};
constexpr ChannelGroup kGroups[] = {{"albedo", "albedo", 0, 3},       {"albedo.A", "albedo", 3, 1},
                                    {"specular", "specular", 0, 3},   {"emission", "emission", 0, 3},
                                    {"emission.A", "emission", 3, 1}, {"normal", "normal", 0, 3}};
constexpr size_t kGroupCount = std::size(kGroups);

using Values = std::array<std::array<double, 3>, kGroupCount>;

/// A channel group of one material.
struct GroupKey {
  uint32_t material;
  size_t group;
  auto operator<=>(const GroupKey&) const = default;
};
using Deviations = std::map<GroupKey, std::vector<Deviation>>;

/// The material's lookups at a sample, and what they are of each cause: all maps' causes in the order of the maps,
/// empty where the cause changes nothing.
struct ChangedTexels {
  SurfaceTexels nominal;
  std::vector<std::optional<SurfaceTexels>> changed;
};

/// Whether the plane's format has an alpha. Where it has none, a format with one may stand in, whose alpha is 1.
bool stores_alpha(const GBufferState& planes, std::string_view plane) {
  return info(plane == "albedo" ? planes.albedo.format : planes.emission).channels > 3;
}

/// Makes deviations of pixels.
class TextureSampler {
 public:
  TextureSampler(const Scene& scene, const Pipeline& pipeline, const Profile& profile, const Capture& capture,
                 const TexelWay& way)
      : projector_(scene, pipeline, profile, capture.drawn_at), way_(way) {
    for (size_t g = 0; g < kGroupCount; ++g) {
      views_[g] = plane_of(capture, pipeline, kGroups[g].plane);
      const bool is_alpha = kGroups[g].first == 3;
      if (is_alpha && (views_[g].channels < 4 || !stores_alpha(pipeline.gbuffer, kGroups[g].plane))) views_[g] = {};
    }
  }

  void add(const TexturedPixel& pixel, TriangleForms& forms, Deviations& out) const;
  TriangleForms forms() const { return TriangleForms(projector_); }

 private:
  Values values_of(const SurfaceValues& surface) const;
  std::optional<ChangedTexels> texels_of(const Material& material, const Piece& piece, const SurfacePoint& point,
                                         const TriangleValues& values, double x, double y) const;
  void add_channel(const TexturedPixel& pixel, size_t group, int k, const Values& nominal,
                   std::span<const Values> changed, std::vector<Deviation>& out) const;

  Projector projector_;
  const TexelWay way_;
  std::array<PlaneView, kGroupCount> views_;
};

Values TextureSampler::values_of(const SurfaceValues& surface) const {
  const GBufferState& g = projector_.pipeline().gbuffer;
  Values out{};
  for (int k = 0; k < 3; ++k) {
    const auto c = size_t(k);
    const Range base = surface.base_color(k, g.albedo.interpolation);
    out[0][c] = surface.albedo(base).value;
    out[2][c] = surface.specular(base, k).value;
    out[3][c] = surface.emission(base, k).value;
    out[5][c] = surface.normal(k, g.normal.interpolation).value;
  }
  out[1][0] = surface.base_color(3, g.albedo.interpolation).value;
  out[4][0] = surface.ambient_share().value;
  const PlaneView& normal = views_[5];
  if (normal && normal.decoded != nullptr && normal.decoded->unit_length) {
    const double length = std::hypot(out[5][0], out[5][1], out[5][2]);
    for (double& c : out[5]) c /= length;
  }
  return out;
}

void TextureSampler::add_channel(const TexturedPixel& pixel, size_t group, int k, const Values& nominal,
                                 std::span<const Values> changed, std::vector<Deviation>& out) const {
  const PlaneView& view = views_[group];
  const bool is_normal = kGroups[group].plane == "normal" && view.unorm();
  const int channel = kGroups[group].first + k, x = int(pixel.pixel % uint32_t(projector_.width())),
            y = int(pixel.pixel / uint32_t(projector_.width()));
  const auto held = [&](const Values& v) {
    const double value = v[group][size_t(k)];
    return view.held(is_normal ? value * 0.5 + 0.5 : value, channel);
  };
  const double expected = held(nominal);
  std::optional<Deviation> d = view.deviation(x, y, channel, expected);
  if (!d) return;
  d->by_cause.reserve(changed.size());
  for (const Values& v : changed) d->by_cause.push_back(held(v) - expected);
  if (std::any_of(d->by_cause.begin(), d->by_cause.end(), [](double c) { return c != 0; }))
    out.push_back(*std::move(d));
}

void set(SurfaceTexels& texels, size_t map, const TexelChanges::Rgba& texel) {
  texels[map].emplace();
  for (size_t c = 0; c < 4; ++c) (*texels[map])[c] = {texel[c], texel[c], texel[c]};
}

/// Nothing where a nearest texel is in doubt.
std::optional<ChangedTexels> TextureSampler::texels_of(const Material& material, const Piece& piece,
                                                       const SurfacePoint& point, const TriangleValues& values,
                                                       double x, double y) const {
  const auto slots = maps_of(material);
  std::array<std::optional<TexelChanges>, kMaterialMaps> changes;
  ChangedTexels out;
  for (size_t map = 0; map < kMaterialMaps; ++map) {
    if (!slots[map]->used()) continue;
    changes[map] =
        texel_changes(projector_.scene().textures[size_t(slots[map]->texture)], slots[map]->sampler,
                      map_sample(projector_, *slots[map], piece, point, values, x, y).nominal, map == kNormalMap, way_);
    if (!changes[map]) return std::nullopt;
    set(out.nominal, map, changes[map]->texel);
  }
  for (size_t map = 0; map < kMaterialMaps; ++map)
    for (size_t cause = 0; cause < kTexelCauses && changes[map]; ++cause) {
      const TexelChanges::Rgba& change = changes[map]->change[cause];
      std::optional<SurfaceTexels>& changed = out.changed.emplace_back();
      if (change == TexelChanges::Rgba{}) continue;
      TexelChanges::Rgba texel = changes[map]->texel;
      for (size_t c = 0; c < 4; ++c) texel[c] += change[c];
      set(changed.emplace(out.nominal), map, texel);
    }
  return out;
}

void TextureSampler::add(const TexturedPixel& pixel, TriangleForms& forms, Deviations& out) const {
  const PossibleSurface& surface = pixel.surface;
  const uint32_t material = projector_.scene().instances[surface.instance].material;
  const auto width = uint32_t(projector_.width());
  const double x = pixel.pixel % width + 0.5, y = projector_.height() - 1 - int(pixel.pixel / width) + 0.5;
  const std::shared_ptr<const TriangleForm> form = forms.of(surface.instance, surface.triangle);
  const Piece& piece = form->pieces()[surface.piece];
  constexpr auto kMiddle = SurfacePoint::Within::middle;
  const SurfacePoint point(piece, form->shape(surface.piece), projector_.profile(), x, y, kMiddle);
  const std::optional<ChangedTexels> texels =
      texels_of(projector_.scene().materials[material], piece, point, form->values(), x, y);
  if (!texels) return;
  const auto shaded = [&](const SurfaceTexels& given) {
    return values_of(SurfaceValues(projector_, form, surface, x, y, kMiddle, &given));
  };
  const Values nominal = shaded(texels->nominal);
  std::vector<Values> changed;
  for (const std::optional<SurfaceTexels>& t : texels->changed) changed.push_back(t ? shaded(*t) : nominal);
  for (size_t g = 0; g < kGroupCount; ++g)
    for (int k = 0; k < kGroups[g].count && views_[g]; ++k)
      add_channel(pixel, g, k, nominal, changed, out[{material, g}]);
}

}  // namespace

std::vector<TextureDeviations> texture_deviations(const Scene& scene, const Pipeline& pipeline, const Profile& profile,
                                                  const Capture& capture, std::span<const TexturedPixel> textured,
                                                  const TexelWay& way) {
  const TextureSampler sampler(scene, pipeline, profile, capture, way);
  constexpr size_t kChunk = 256;
  const size_t chunks = (textured.size() + kChunk - 1) / kChunk;
  std::vector<Deviations> parts(chunks);
  parallel_for(int(chunks), 0, [&](int i) {
    TriangleForms forms = sampler.forms();
    const size_t first = size_t(i) * kChunk;
    for (const TexturedPixel& p : textured.subspan(first, std::min(kChunk, textured.size() - first)))
      sampler.add(p, forms, parts[size_t(i)]);
  });
  Deviations all;
  for (Deviations& part : parts)
    for (auto& [key, list] : part) {
      std::vector<Deviation>& of = all[key];
      std::move(list.begin(), list.end(), std::back_inserter(of));
    }
  std::vector<TextureDeviations> out;
  for (auto& [key, list] : all) {
    TextureDeviations& d = out.emplace_back();
    d.material = key.material, d.plane = kGroups[key.group].name, d.list = std::move(list);
    const auto slots = maps_of(scene.materials[key.material]);
    for (size_t map = 0; map < kMaterialMaps; ++map)
      if (slots[map]->used()) d.maps.push_back(MaterialMap(map));
  }
  return out;
}

}  // namespace trueshade::oracle
