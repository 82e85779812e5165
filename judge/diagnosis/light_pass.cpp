#include "judge/diagnosis/light_pass.h"

#include <algorithm>

#include "judge/diagnosis/plain_program.h"
#include "judge/diagnosis/predicted_store.h"
#include "judge/diagnosis/predicted_term.h"
#include "judge/diagnosis/reread_depth.h"
#include "judge/diagnosis/view_axes.h"
#include "oracle/matrices.h"
#include "scenes/pipeline/light_mesh.h"

namespace trueshade::oracle {

namespace {

/// The surface at the position that the pass rebuilds of its depth, by LightFault::near and far.
PlainSurface taken(const LightPass& pass, PlainSurface surface) {
  const LightFault& f = pass.fault;
  if ((f.near == 1 && f.far == 1) || !surface.covered) return surface;
  const Camera& c = pass.camera;
  const DepthPlanes made{double(c.near), double(c.far)}, read{made.near * f.near, made.far * f.far};
  surface.position = reread(triple(c.eye), pass.view[2], surface.position, made, read);
  return surface;
}

/// The point where x, y and w of clip space are all 0; nothing where there is none, as for an orthographic matrix.
std::optional<Triple3> eye_of(const Matrix4& clip) {
  const auto row = [&](size_t r) { return Triple3{clip[r], clip[4 + r], clip[8 + r]}; };
  const Triple3 yw = cross(row(1), row(3)), wx = cross(row(3), row(0)), xy = cross(row(0), row(1));
  const double determinant = inner(row(0), yw);
  if (row(3) == Triple3{} || determinant == 0) return std::nullopt;
  const Triple3 sum = plus(plus(times(yw, clip[12]), times(wx, clip[13])), times(xy, clip[15]));
  return times(sum, -1 / determinant);
}

/// What the sum of lights starts from: emission and ambient light.
Triple3 start_of(const LightPass& pass, const PlainSurface& surface) {
  const LightModel& model = pass.pipeline.light_model;
  Triple3 out{};
  for (size_t k = 0; k < 3; ++k) {
    if (model.emission) out[k] = surface.emission[k];
    const double ambient = pass.fault.no_ambient ? 0 : double(model.global_ambient[int(k)]);
    out[k] += ambient * (model.order == TermOrder::albedo_last ? 1 : surface.albedo[k]) *
              (model.emission ? surface.ambient_share : 1);
  }
  return out;
}

/// The target's alpha where there is a surface.
double alpha_of(const LightPass& pass, const PlainSurface& surface) {
  return pass.pipeline.light_model.alpha_from_albedo ? surface.albedo[3] : 1;
}

/// A channel as the model outputs it: clamped to [0, 1] where the model says so.
double output_of(const LightPass& pass, double x) {
  return pass.pipeline.light_model.clamp_result ? std::clamp(x, 0.0, 1.0) : x;
}

/// Calls draw(index, light, times) for each light that is drawn at the pixel, in the order of drawing.
template <class Draw>
void each_light(const LightPass& pass, const PlainSurface& surface, const PredictedTerms& maker,
                const std::vector<uint8_t>* listed, const Draw& draw) {
  const LightFault& fault = pass.fault;
  const auto count = std::min(pass.lights.size(), size_t(fault.most_lights));
  uint32_t reached = 0;
  for (size_t at = 0; at < count; ++at) {
    const size_t i = fault.reversed ? pass.lights.size() - 1 - at : at;
    const Light& light = pass.lights[i];
    if (int64_t(i) == fault.missing || (listed != nullptr && (*listed)[i] == 0)) continue;
    const int fragments = maker.fragments(surface, light);
    if (fragments == 0) continue;
    if (fault.most_at_pixel < count) {
      if (!maker.in_range(surface, light)) continue;
      if (!is_ambient(light.type) && ++reached > fault.most_at_pixel) continue;
    }
    draw(uint32_t(i), light, int64_t(i) == fault.twice ? 2 * fragments : fragments);
  }
}

}  // namespace

LightPass light_pass_of(const Scene& scene, const Pipeline& pipeline) {
  LightPass pass{scene.camera, pipeline, scene.lights, {}, {}, view_axes(scene.camera, pipeline), scene.clear};
  const Matrix4 clip = projection_of(scene.camera, pipeline.geometry, pipeline.width, pipeline.height);
  pass.axis = view_axis(clip), pass.drawn_from = eye_of(clip);
  if (is_mesh(pipeline.light_volumes.point) || is_mesh(pipeline.light_volumes.spot))
    pass.shapes = std::make_shared<LightShapes>(pipeline.light_volumes);
  if (!pipeline.light_program.used()) return pass;
  pass.program = std::make_shared<PlainProgram>(scene, pipeline);
  LightModel& model = pass.pipeline.light_model;
  const bool alpha = model.alpha_from_albedo;
  model = {};
  model.alpha_from_albedo = alpha;
  model.falloff = Falloff::none, model.specular = Specular::none, model.cone = Cone::none;
  return pass;
}

PredictedPixel predicted_pixel(const LightPass& pass, const PlainSurface& given, const std::vector<uint8_t>* listed,
                               std::vector<TracedLight>* trace) {
  const PlainSurface surface = taken(pass, given);
  const PredictedStore texels(pass.pipeline, pass.fault.store), cleared(pass.pipeline, LightFault::Store::right);
  PredictedPixel out;
  if (!surface.covered) {
    for (int k = 0; k < 4; ++k) {
      out.value[size_t(k)] = double(pass.clear[k]);
      out.stored[size_t(k)] = cleared.stored(double(pass.clear[k]), k);
    }
    return out;
  }
  const PredictedTerms maker(pass, surface);
  const Strategy strategy = pass.pipeline.strategy;
  const bool last = pass.pipeline.light_model.order == TermOrder::albedo_last;
  if (pass.program != nullptr && surface.unlit) {
    for (int k = 0; k < 4; ++k) {
      out.value[size_t(k)] = surface.albedo[size_t(k)];
      out.stored[size_t(k)] = texels.stored(out.value[size_t(k)], k);
    }
    return out;
  }
  const double alpha = output_of(pass, alpha_of(pass, surface));
  const auto colored = [&](Triple3 v) {
    for (size_t k = 0; k < 3; ++k) v[k] = output_of(pass, last ? v[k] * surface.albedo[k] : v[k]);
    return v;
  };
  Triple3 sum = pass.program != nullptr ? maker.start() : start_of(pass, surface);
  if (!blends_lights(strategy)) {
    each_light(pass, surface, maker, listed, [&](uint32_t index, const Light& light, int times_drawn) {
      const Triple3 term = maker.term(surface, light);
      for (size_t k = 0; k < 3; ++k) {
        sum[k] += times_drawn * term[k];
        if (pass.fault.sum == LightFault::Sum::halves) sum[k] = rounded_to(sum[k], 10, -14, LightFault::Store::nearest);
      }
      if (trace == nullptr) return;
      const Triple3 now = colored(sum);  // what finish() makes of it is not followed light by light
      trace->push_back({index, maker.in_range(surface, light), term != Triple3{}, {now[0], now[1], now[2], alpha}});
    });
    sum = colored(sum);
    const std::array<double, 4> finished = maker.finished(sum, alpha);
    for (int k = 0; k < 4; ++k) {
      out.value[size_t(k)] = finished[size_t(k)];
      out.stored[size_t(k)] = texels.stored(out.value[size_t(k)], k);
    }
    return out;
  }
  const bool multipass = strategy == Strategy::forward_multipass;
  for (int k = 0; k < 4; ++k) out.stored[size_t(k)] = cleared.stored(double(pass.clear[k]), k);
  bool first = multipass;
  if (!multipass && pass.pipeline.light_volumes.base) {
    const Triple3 start = colored(sum);
    for (int k = 0; k < 4; ++k) out.stored[size_t(k)] = texels.stored(k < 3 ? start[size_t(k)] : alpha, k);
  }
  each_light(pass, surface, maker, listed, [&](uint32_t index, const Light& light, int times_drawn) {
    Triple3 term = maker.term(surface, light);
    if (first) {  // the first draw of forward-multipass stores, with what the sum starts from
      first = false;
      term = colored(plus(term, sum));
      for (int k = 0; k < 4; ++k) out.stored[size_t(k)] = texels.stored(k < 3 ? term[size_t(k)] : alpha, k);
      return;
    }
    term = colored(term);
    for (int i = 0; i < times_drawn; ++i)
      texels.blend(term, alpha, multipass ? kAddLight : pass.pipeline.blend, out.stored);
    if (trace == nullptr) return;
    TracedLight traced{index, maker.in_range(surface, light), term != Triple3{}, {}};
    for (int k = 0; k < 4; ++k)
      traced.value[size_t(k)] = value_of_stored(pass.pipeline.target, out.stored[size_t(k)], k);
    trace->push_back(traced);
  });
  if (first) {
    const Triple3 start = colored(sum);
    for (int k = 0; k < 4; ++k) out.stored[size_t(k)] = texels.stored(k < 3 ? start[size_t(k)] : alpha, k);
  }
  for (int k = 0; k < 4; ++k) out.value[size_t(k)] = value_of_stored(pass.pipeline.target, out.stored[size_t(k)], k);
  return out;
}

std::vector<LightAdded> lights_added(const LightPass& pass, const PlainSurface& given) {
  const PlainSurface surface = taken(pass, given);
  const PredictedTerms maker(pass, surface);
  const bool last = pass.pipeline.light_model.order == TermOrder::albedo_last;
  std::vector<LightAdded> added;
  if (pass.program != nullptr && surface.unlit) return added;
  for (uint32_t i = 0; i < pass.lights.size(); ++i) {
    const int fragments = maker.fragments(surface, pass.lights[i]);
    Triple3 term = fragments > 0 ? times(maker.term(surface, pass.lights[i]), fragments) : Triple3{};
    if (term == Triple3{}) continue;
    for (size_t k = 0; k < 3 && last; ++k) term[k] *= surface.albedo[k];
    added.push_back({i, term});
  }
  return added;
}

}  // namespace trueshade::oracle
