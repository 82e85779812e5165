#include "gl/emit/designs.h"

#include "gl/emit/glsl.h"

namespace trueshade::oracle {

std::string_view name_of(GlDesign design) {
  switch (design) {
    case GlDesign::deferred_loop:
      return "deferred-loop";
    case GlDesign::deferred_volumes:
      return "deferred-volumes";
    case GlDesign::tiled:
      return "tiled";
    case GlDesign::forward_plus:
      return "forward-plus";
    case GlDesign::forward_loop:
      return "forward-loop";
    case GlDesign::forward_multipass:
      return "forward-multipass";
  }
  return {};
}

Pipeline design_pipeline(const Pipeline& pipeline, GlDesign design) {
  Pipeline p = pipeline;
  p.strategy = strategy_of(design);
  LightVolumes& v = p.light_volumes;
  const bool bare = v.point == LightExtent::unbounded && v.spot == LightExtent::unbounded;
  if (design == GlDesign::deferred_volumes && bare && ends_at_range(p.light_model.falloff)) {
    v.point = v.spot = LightExtent::box;  // the light-volume paper's state
    v.cull_face = CullFace::front;
    v.depth_clamp = true;
  }
  if (design == GlDesign::tiled) {
    p.gbuffer.position_from_depth = true;
    p.gbuffer.normal.format = Format::rgba16f;
  }
  if (is_forward(design)) p.gbuffer.position_from_depth = false;
  return p;
}

}  // namespace trueshade::oracle
