#include "judge/stages/transparent_layers.h"

#include <algorithm>
#include <cmath>

#include "judge/legal/light_output.h"
#include "judge/legal/patch.h"
#include "judge/stages/captured_surface.h"
#include "judge/stages/tally.h"
#include "scenes/pipeline/transparency.h"

namespace trueshade::oracle {

namespace {

constexpr size_t kMostDoubts = 6;

bool ordered_down(DepthFunc f) { return f == DepthFunc::less || f == DepthFunc::lequal; }
bool ordered_up(DepthFunc f) { return f == DepthFunc::greater || f == DepthFunc::gequal; }

/// The pipeline with a forward strategy, for surfaces that lights read without planes between.
Pipeline forward_of(const Pipeline& pipeline) {
  Pipeline p = pipeline;
  p.strategy = Strategy::forward_loop;
  p.gbuffer = surface_planes(p);
  return p;
}

/// What transparent surfaces are blended in: of a plane that was captured in a format with an alpha which the
/// pipeline's has not, that one, whose alpha is blended too.
Format blended_format(const Pipeline& pipeline, const Capture& capture) {
  const bool in_albedo = pipeline.transparency.mode == TransparencyMode::into_albedo;
  const Format asked = in_albedo ? pipeline.gbuffer.albedo.format : pipeline.target;
  if (!in_albedo) return capture.color.width > 0 ? capture.color.format : asked;
  const Image* const albedo = capture.plane("albedo");
  return albedo != nullptr && info(albedo->format).channels > info(asked).channels ? albedo->format : asked;
}

}  // namespace

/// The depths that the opaque surfaces may have left at a pixel, as keys.
struct TransparentLayers::Front {
  double low, high;
};

TransparentLayers::~TransparentLayers() = default;

TransparentLayers::TransparentLayers(const Scene& scene, const Pipeline& pipeline, const Profile& profile,
                                     const Capture& capture, const JudgedRows& rows)
    : pipeline_(pipeline),
      profile_(profile),
      blend_(pipeline.transparency.blend),
      format_(blended_format(pipeline, capture)),
      projector_(scene, forward_of(pipeline), profile, capture.drawn_at) {
  find_fronts(capture, rows);
  fragments_ = find_transparent(projector_, front_high_, rows);
  if (pipeline.transparency.mode != TransparencyMode::after_lights) return;
  Pipeline of_glass = pipeline;
  of_glass.light_model.alpha_from_albedo = true;
  lights_.emplace(scene, of_glass, profile_.arithmetic);
}

void TransparentLayers::find_fronts(const Capture& capture, const JudgedRows& rows) {
  const auto pixels = size_t(pipeline_.width) * size_t(pipeline_.height);
  const GeometryState& state = pipeline_.geometry;
  const bool down = ordered_down(state.depth_func), up = ordered_up(state.depth_func);
  front_low_.assign(pixels, down || up ? clear_key(state) : HUGE_VAL);
  front_high_ = front_low_;
  if (!down && !up) return;
  const PlaneView depth = plane_of(capture, pipeline_, "depth");
  if (depth) {
    for (int y = 0; y < pipeline_.height; ++y)
      for (int x = 0; x < pipeline_.width; ++x) {
        const double stored = depth_in_buffer(state, depth.stored(x, y, 0));
        const size_t pixel = size_t(pipeline_.height - 1 - y) * size_t(pipeline_.width) + size_t(x);
        const double key = up ? -stored : stored, error = depth.packing_error(x, y);
        front_low_[pixel] = key - error, front_high_[pixel] = key + error;
      }
    return;
  }
  const PossibleSurfaces opaque = possible_surfaces(projector_, rows);
  for (size_t pixel = 0; pixel < pixels; ++pixel)
    for (const PossibleSurface& c : opaque.at(pixel)) {
      front_low_[pixel] = std::min(front_low_[pixel], c.low);
      if (c.certain) front_high_[pixel] = std::min(front_high_[pixel], c.high);
    }
}

bool TransparentLayers::any(int x, int y) const {
  return !fragments_.at(size_t(pipeline_.height - 1 - y) * size_t(pipeline_.width) + size_t(x)).empty();
}

/// Tests a fragment against the opaque surfaces. False where it surely fails; where it may pass or fail, makes the
/// layer uncertain and returns true.
bool TransparentLayers::test_depth(const SurfaceValues& values, const Front& front, TransparentLayer& layer) const {
  const DepthFunc func = pipeline_.geometry.depth_func;
  if (func == DepthFunc::always) return true;
  if (func == DepthFunc::never) return false;
  const Range z = values.depth();
  const bool up = ordered_up(func), strict = func == DepthFunc::less || func == DepthFunc::greater;
  if (!up && !ordered_down(func)) {  // EQUAL, NOTEQUAL: depths of opaque surfaces are not followed
    layer.certain = false, layer.doubt = PixelClass::depth_tie, layer.patch = -1, layer.chance_other = 0.5f;
    return true;
  }
  const double low = up ? -z.high : z.low, high = up ? -z.low : z.high, middle = up ? -z.value : z.value;
  if (strict ? low >= front.high : low > front.high) return false;
  if (strict ? high < front.low : high <= front.low) return true;
  layer.certain = false, layer.doubt = PixelClass::depth_tie, layer.patch = -1;
  layer.drawn = layer.drawn && (strict ? middle < front.high : middle <= front.high);
  layer.chance_other = 0.5f;
  return true;
}

/// Sets the colors that a transparent fragment may be drawn with: `nominal`, and `other`, the set of all that the
/// lights may make of it where comparisons may go either way. In mode into_albedo, the colors are albedos.
void TransparentLayers::shade(const SurfaceValues& values, const PossibleSurface& drawn, int x, int y,
                              TransparentLayer& layer) const {
  const Interpolation how = pipeline_.gbuffer.albedo.interpolation;
  layer.looked_up = values.looked_up();
  layer.undefined = !values.bounded();
  if (!lights_) {
    for (int k = 0; k < 4; ++k) {
      const Range base = values.base_color(k, how);
      layer.nominal[size_t(k)] = k < 3 ? values.albedo(base) : base;
    }
    return;
  }
  ShadedSurface surface = shaded_surface(values, pipeline_.gbuffer);
  surface.object = drawn.instance + 1, surface.pixel = {x, y};
  surface.material = projector_.scene().instances[drawn.instance].material + 1;
  static thread_local ProgramBounds::Block block;  // which is large
  static thread_local std::vector<uint32_t> near;
  const ShadedSurface* const only[] = {&surface};
  lights_->take_near(only, block, near);
  const LightOutput lit =
      output_of(*lights_, surface, lights_->at(surface, near, block.registers), block.registers);
  layer.nominal = lit.nominal, layer.other = lit.other, layer.either_way = lit.either_way;
  layer.undefined = layer.undefined || lit.undefined;
}

TransparentPixel TransparentLayers::at(int x, int y_top, uint32_t first, uint32_t end) const {
  const int y = pipeline_.height - 1 - y_top;
  const size_t pixel = size_t(y) * size_t(pipeline_.width) + size_t(x);
  const std::span<const PossibleSurface> all = fragments_.at(pixel);
  TransparentPixel out;
  const auto ours = [&](const PossibleSurface& c) { return c.instance >= first && c.instance < end; };
  if (std::none_of(all.begin(), all.end(), ours)) return out;
  const std::vector<ClosedPatch> patches = closed_patches(projector_, all, x + 0.5, y + 0.5);
  for (const ClosedPatch& patch : patches) {
    const bool known = std::all_of(patch.members.begin(), patch.members.end(),
                                   [](const ClosedPatch::Member& m) { return m.sense != 0; });
    out.turns.push_back(known ? patch.turns : kOpenPatch);
  }
  for (size_t i = 0; i < all.size(); ++i) {
    const PossibleSurface& c = all[i];
    if (!ours(c)) continue;
    TransparentLayer layer;
    layer.instance = c.instance, layer.triangle = c.triangle;
    layer.certain = c.certain, layer.drawn = c.nominal || c.certain, layer.chance_other = c.chance_other;
    layer.doubt = c.masked ? PixelClass::tex : c.cut ? PixelClass::clip : PixelClass::edge;
    for (size_t p = 0; p < patches.size(); ++p)
      for (const ClosedPatch::Member& m : patches[p].members)
        if (m.surface == i) layer.patch = int(p), layer.turn = m.sense;
    const SurfaceValues values(projector_, c, x + 0.5, y + 0.5);
    const int patch = layer.patch;
    const bool passes = test_depth(values, {front_low_[pixel], front_high_[pixel]}, layer);
    // What hides some of a patch says nothing of which triangle has the sample.
    if (patch >= 0 && (!passes || layer.patch < 0))
      for (TransparentLayer& other : out.layers)
        if (other.patch == patch) other.patch = -1;
    if (patch >= 0 && (!passes || layer.patch < 0)) out.turns[size_t(patch)] = kOpenPatch;
    if (patch >= 0 && out.turns[size_t(patch)] == kOpenPatch) layer.patch = -1;
    if (!passes) continue;
    shade(values, c, x, y, layer);
    out.layers.push_back(layer);
  }
  return out;
}

/// Appends the texel that one way of drawing the layers over `from` leaves; nothing where closed patches rule it out.
///   drawn: bit i: the i-th uncertain layer is drawn
///   other: comparisons that may go either way go the other way
void TransparentLayers::chain(const TransparentPixel& pixel, const Texel& from, unsigned drawn, bool other,
                              std::vector<LayeredTexel>& out) const {
  LayeredTexel way;
  way.texel = from;
  std::vector<int> turns(pixel.turns.size(), 0);
  unsigned bit = 0;
  for (const TransparentLayer& layer : pixel.layers) {
    bool is_drawn = true;
    if (!layer.certain) {
      is_drawn = (drawn >> bit++ & 1u) != 0;
      if (is_drawn != layer.drawn && worse(layer.doubt, way.pixel_class)) way.pixel_class = layer.doubt;
    }
    if (!is_drawn) continue;
    if (layer.patch >= 0) turns[size_t(layer.patch)] += layer.turn;
    const bool branch = other && layer.either_way;
    if (branch && worse(PixelClass::branch, way.pixel_class)) way.pixel_class = PixelClass::branch;
    const std::array<Range, 4>& source = branch ? layer.other : layer.nominal;
    way.texel = blended_texel(blend_, format_, profile_, source, way.texel);
    way.looked_up = way.looked_up || layer.looked_up;
    way.undefined = way.undefined || layer.undefined;
    for (size_t k = 0; k < 4; ++k) way.value[k] = source[k].value;
  }
  for (size_t p = 0; p < turns.size(); ++p) {
    const bool seen = std::any_of(pixel.layers.begin(), pixel.layers.end(),
                                  [&](const TransparentLayer& l) { return l.patch == int(p); });
    if (seen && turns[p] != pixel.turns[p]) return;
  }
  out.push_back(way);
}

std::vector<LayeredTexel> TransparentLayers::ways(const TransparentPixel& pixel, const Texel& from) const {
  unsigned nominal = 0, bit = 0;
  bool branches = false;
  for (const TransparentLayer& layer : pixel.layers) {
    branches = branches || layer.either_way;
    if (!layer.certain) nominal |= (layer.drawn ? 1u : 0u) << bit++;
  }
  std::vector<LayeredTexel> out;
  if (bit <= kMostDoubts) {
    for (const bool other : {false, true}) {
      if (other && !branches) continue;
      chain(pixel, from, nominal, other, out);
      for (unsigned drawn = 0; drawn < 1u << bit; ++drawn)
        if (drawn != nominal) chain(pixel, from, drawn, other, out);
    }
    if (!out.empty()) return out;
  }
  TransparentPixel first = pixel;
  first.turns.assign(first.turns.size(), kOpenPatch);
  LayeredTexel hulls;
  hulls.texel = from;
  for (TransparentLayer& layer : first.layers) {
    layer.patch = -1;
    const Texel before = hulls.texel;
    hulls.texel = blended_texel(blend_, format_, profile_, layer.either_way ? layer.other : layer.nominal, before);
    hulls.looked_up = hulls.looked_up || layer.looked_up, hulls.undefined = hulls.undefined || layer.undefined;
    for (size_t k = 0; k < 4; ++k) hulls.value[k] = layer.nominal[k].value;
    if (layer.certain) continue;
    for (size_t k = 0; k < 4; ++k) hulls.texel[k] = hull(hulls.texel[k], before[k]);
    if (worse(layer.doubt, hulls.pixel_class)) hulls.pixel_class = layer.doubt;
    layer.certain = layer.drawn;
  }
  std::erase_if(first.layers, [](const TransparentLayer& l) { return !l.certain; });
  chain(first, from, 0, false, out);
  out.push_back(hulls);
  return out;
}

void TransparentLayers::carry(const TransparentPixel& pixel, CarriedTexel& at) const {
  const std::vector<LayeredTexel> nominal = ways(pixel, at.nominal), all = ways(pixel, at.all);
  at.split = at.split || all.size() > 1;
  at.nominal = nominal.front().texel;
  at.all = all.front().texel;
  for (const LayeredTexel& way : all) {
    for (size_t k = 0; k < 4; ++k) at.all[k] = hull(at.all[k], way.texel[k]);
    if (worse(way.pixel_class, at.doubt)) at.doubt = way.pixel_class;
    at.open = at.open || way.undefined;
  }
}

Scene without_transparent(const Scene& scene) {
  Scene out = scene;
  const auto nothing = uint32_t(out.meshes.size());
  out.meshes.emplace_back();
  for (Instance& instance : out.instances)
    if (scene.materials[instance.material].transparent) instance.mesh = nothing;
  for (Material& m : out.materials) m.transparent = false;
  return out;
}

}  // namespace trueshade::oracle
