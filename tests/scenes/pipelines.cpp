#include <cmath>
#include <limits>

#include "expect_error.h"
#include "scenes/pipeline/presets.h"
#include "scenes/pipeline/shipped_models.h"

namespace trueshade {
namespace {

std::string pipeline_refusal(const std::string& text) {
  return error_of(ErrorKind::bad_input, [&] { pipeline_from_json(text, "p.json", {}); });
}

Pipeline strange_pipeline() {
  Pipeline p = *preset_pipeline("touchdesigner");
  p.width = 65536;
  p.height = 1;
  p.geometry = {{-3, 4, 5, 6},
                0.25f,
                0.1f,
                DepthFunc::gequal,
                0.3f,
                true,
                CullFace::front,
                FrontFace::cw,
                ClipOrigin::upper_left,
                ClipDepth::zero_to_one,
                Provoking::first,
                Format::d16,
                -1.5f,
                0.25f};
  p.gbuffer.normal = {Format::rgb16f, Interpolation::noperspective};
  p.gbuffer.uv.interpolation = Interpolation::flat;
  p.gbuffer.unit_normals = UnitNormals::both;
  p.gbuffer.position_from_depth = true;
  p.gbuffer.half_round = HalfRound::nearest;
  p.light_model.shininess = 0.1f;
  p.light_model.specular_color = {1e-20f, 1.0f / 3.0f, 1e18f};
  p.light_model.falloff = Falloff::inverse_square;
  p.light_model.order = TermOrder::with_ambient;
  p.light_model.cone = Cone::squared_penumbra;
  p.light_model.diffuse = Diffuse::unclamped;
  p.light_model.specular = Specular::phong;
  p.light_model.specular_source = SpecularSource::metallic_roughness;
  p.light_model.viewer = Viewer::infinite;
  p.light_model.emission = true;
  p.light_model.global_ambient = {0.2f, 0.0f, 1e18f};
  p.light_model.damping = 0.1f;
  p.light_model.clamp_result = true;
  p.gbuffer.specular = Format::rgba16f;
  p.gbuffer.emission = Format::rgb16f;
  p.target = Format::rgba16f;
  p.profile = NumericProfile::mesa_llvmpipe_22_3;
  p.view = ImageView::light_tile;
  p.post = {8,
            0.5f,
            {1000.0f, 0.0f, 14, 64},
            PostChain::ToneMap::reinhard,
            1e6f,
            1e-6f,
            1e-12f,
            PostChain::Encode::srgb,
            true,
            Format::rgba16f};
  p.strategy = Strategy::deferred_volumes;
  p.light_volumes = {LightExtent::box, LightExtent::cone, 64, 2, CullFace::front, false, false};
  p.blend = {false,
             {BlendEquation::reverse_subtract, BlendFactor::src_alpha_saturate, BlendFactor::one_minus_dst_color},
             {BlendEquation::max, BlendFactor::zero, BlendFactor::constant_alpha},
             {-1.0f, 0.1f, 1e18f, 0.0f},
             {false, true, false, true}};
  p.transparency = {TransparencyMode::into_albedo, p.blend};
  p.transparency.blend.constant[3] = 0.5f;
  return p;
}

TEST_CASE("presets are found by name, valid, and named after themselves") {
  CHECK(preset_pipeline("many-lights") == Pipeline{});
  CHECK_FALSE(preset_pipeline("nonesuch"));
  for (const Preset& row : presets()) {
    CHECK(std::string(row.name) == row.pipeline.preset);
    CHECK_NOTHROW(validate(row.pipeline));
  }
}

TEST_CASE("a pipeline's text reads back as the same pipeline over any base, and writes the same text") {
  for (const Pipeline& p : {Pipeline{}, *preset_pipeline("touchdesigner"), strange_pipeline()})
    for (const Pipeline& base : {Pipeline{}, strange_pipeline()}) {
      const Pipeline again = pipeline_from_json(pipeline_json(p), "p.json", base);
      CHECK(again == p);
      CHECK(pipeline_json(again) == pipeline_json(p));
    }
}

TEST_CASE("the text of the preset gltf reads back as the preset, once its model has its text") {
  const Pipeline row = *preset_pipeline("gltf");
  Pipeline again = pipeline_from_json(pipeline_json(row), "p.json", strange_pipeline());
  CHECK(again.light_program.text.empty());
  give_text(again.light_program);
  CHECK(again == row);
  CHECK(draws_by_its_preset(again));
  again.light_program = shipped_program("ue4");
  CHECK_FALSE(draws_by_its_preset(again));
  LightProgram other{"gltf", {}, std::string(64, '0'), {}};
  CHECK_STARTS_WITH(error_of(ErrorKind::bad_input, [&] { give_text(other); }),
                    "gltf: is not the light program that the pipeline names");
}

TEST_CASE("a light model that a text states takes the place of a preset's program, and not of one that a text names") {
  const char* const text = R"({"light_model": {"damping": 0.5}})";
  Pipeline expected = *preset_pipeline("punctual");
  expected.preset = "gltf";
  expected.light_model.damping = 0.5f;
  CHECK(pipeline_from_json(text, "p.json", *preset_pipeline("gltf")) == expected);
  const Pipeline named = pipeline_from_json(R"({"light_program": {"file": "ue4"}})", "p.json", {});
  CHECK(pipeline_from_json(text, "p.json", named).light_program.file == "ue4");
  CHECK_STARTS_WITH(pipeline_refusal(R"({"preset": "gltf", "light_model": {"damping": 0.5}})"),
                    "p.json: light_model beside the preset gltf, which draws by a light program");
}

TEST_CASE("the text of the default pipeline stays as it is") {
  CHECK(
      pipeline_json({}) ==
      R"({"version":1,"preset":"many-lights","width":800,"height":800,"geometry":{"viewport":{"x":0,"y":0,"width":0,)"
      R"("height":0},"depth_near":0,"depth_far":1,"depth_func":"less","clear_depth":1,"depth_clamp":false,)"
      R"("cull_face":"none","front_face":"ccw","clip_origin":"lower_left","clip_depth":"negative_one_to_one",)"
      R"("provoking":"last","depth_format":"d32f","polygon_offset_factor":0,"polygon_offset_units":0},)"
      R"("gbuffer":{"position":{"format":"rgba32f","interpolation":"smooth"},"normal":)"
      R"({"format":"rgba32f","interpolation":"smooth"},"albedo":{"format":"rgba8","interpolation":"smooth"},"uv":)"
      R"({"format":"rgba32f","interpolation":"smooth"},"specular_format":"rgba32f","emission_format":"rgba32f",)"
      R"("unit_normals":"vertex","position_from_depth":false,"half_round":"toward_zero"},)"
      R"("light_model":{"renormalize":true,"specular_masked":true,"shininess":32,"specular_color":[0.25,0.25,0.25],)"
      R"("falloff":"linear_range","order":"factored","alpha_from_albedo":false,"cone":"none","diffuse":"clamped",)"
      R"("specular":"blinn_phong","specular_source":"model","viewer":"local","emission":false,)"
      R"("global_ambient":[0,0,0],"damping":1,"clamp_result":false},"light_volumes":{"point":"unbounded",)"
      R"("spot":"unbounded","slices":16,"stacks":8,"cull_face":"none","depth_clamp":true,"base":true},"blend":)"
      R"({"enabled":true,"rgb":{"equation":"add","src":"one","dst":"one"},"alpha":{"equation":"add","src":"one",)"
      R"("dst":"one"},"constant":[0,0,0,0],"mask":[true,true,true,false]},"transparency":{"mode":"after-lights","blend":{)"
      R"("enabled":true,"rgb":{"equation":"add","src":"src_alpha","dst":"one_minus_src_alpha"},)"
      R"("alpha":{"equation":"add","src":"one","dst":"one_minus_src_alpha"},"constant":[0,0,0,0],)"
      R"("mask":[true,true,true,true]}},"strategy":"deferred-loop",)"
      R"("target":"rgba8","profile":"ideal",)"
      R"("post":{"samples":1,"marker_radius":0,"bloom":{"strength":0,"threshold":1,"radius":8,"passes":1},)"
      R"("tone_map":"none","key":0.18,"white":0,"log_offset":1e-04,"encode":"linear","edge_filter":false,)"
      R"("output":"rgba8"},"view":"lit"})");
}

TEST_CASE("keys present replace, a preset replaces all, whatever their order") {
  Pipeline base;
  base.width = 5;
  CHECK(pipeline_from_json("{}", "p", base) == base);
  base.light_model.shininess = 7.0f;
  CHECK(pipeline_from_json(R"({"light_model": {"shininess": 7}})", "p", base) == base);
  const Pipeline p = pipeline_from_json(R"({"width": 9, "preset": "touchdesigner"})", "p", base);
  CHECK(p.width == 9);
  CHECK(p.light_model == preset_pipeline("touchdesigner")->light_model);
}

TEST_CASE("bad pipelines are refused at their pointer") {
  const char* const cases[][2] = {
      {R"([])", "p.json: found an array (an object)"},
      {R"({"colour": 1})", "p.json: /colour: this key is unknown"},
      {R"({"version": 2})", "p.json: /version: found 2"},
      {R"({"preset": "nonesuch"})",
       "p.json: /preset: found \"nonesuch\" (one of many-lights touchdesigner gl-fixed punctual lecture light-volumes "
       "light-volumes-literal redsdk gltf)"},
      {R"({"width": 0})", "p.json: /width: found 0 (a whole number from 1 to 1048576)"},
      {R"({"width": 1048577})", "p.json: /width: found 1048577"},
      {R"({"width": 1.5})", "p.json: /width: found 1.5"},
      {R"({"width": "800"})", "p.json: /width: found \"800\""},
      {R"({"height": null})", "p.json: /height: found null"},
      {R"({"geometry": {"viewport": {"w": 3}}})", "p.json: /geometry/viewport/w: this key is unknown"},
      {R"({"geometry": {"viewport": {"width": -1}}})", "p.json: /geometry/viewport/width: found -1"},
      {R"({"geometry": {"depth_near": 1.25}})", "p.json: /geometry/depth_near: found 1.25 (a number from 0 to 1)"},
      {R"({"geometry": {"depth_func": "LESS"}})",
       "p.json: /geometry/depth_func: found \"LESS\" (did you mean less? one of never less"},
      {R"({"geometry": {"depth_format": "r32ui"}})",
       "p.json: /geometry/depth_format: found \"r32ui\" (one of d32f d24 d16)"},
      {R"({"geometry": {"polygon_offset_units": 2e18}})", "p.json: /geometry/polygon_offset_units: found 2e+18"},
      {R"({"geometry": {"depth_clamp": 1}})", "p.json: /geometry/depth_clamp: found 1 (true or false)"},
      {R"({"gbuffer": {"position": "rgba32f"}})", "p.json: /gbuffer/position: found \"rgba32f\" (an object)"},
      {R"({"gbuffer": {"position": {"format": "rgba8"}}})", "p.json: /gbuffer/position/format: found \"rgba8\""},
      {R"({"gbuffer": {"albedo": {"format": "d32f"}}})", "p.json: /gbuffer/albedo/format: found \"d32f\""},
      {R"({"gbuffer": {"position_from_depth": true}, "geometry": {"depth_near": 1}})",
       "p.json: position_from_depth with depth_near = depth_far"},
      {R"({"light_model": {"shininess": -1}})", "p.json: /light_model/shininess: found -1"},
      {R"({"light_model": {"specular_color": [1, 1]}})",
       "p.json: /light_model/specular_color: found an array of 2 (an array of 3)"},
      {R"({"light_model": {"specular_color": [1, 1, 2e18]}})", "p.json: /light_model/specular_color/2: found 2e+18"},
      {R"({"strategy": "forward"})",
       "p.json: /strategy: found \"forward\" (one of forward-multipass forward-loop deferred-volumes "
       "deferred-loop)"},
      {R"({"light_volumes": {"slices": 2}})", "p.json: /light_volumes/slices: found 2 (a whole number from 3 to 64)"},
      {R"({"light_volumes": {"point": "ball"}})",
       "p.json: /light_volumes/point: found \"ball\" (one of unbounded range"},
      {R"({"blend": {"rgb": {"src": "GL_ONE"}}})", "p.json: /blend/rgb/src: found \"GL_ONE\" (one of zero one"},
      {R"({"blend": {"mask": [true, true, true]}})", "p.json: /blend/mask: found an array of 3 (an array of 4)"},
      {R"({"blend": {"constant": [0, 0, 0, 2e18]}})", "p.json: /blend/constant/3: found 2e+18"},
      {R"({"transparency": {"mode": "sorted"}})",
       "p.json: /transparency/mode: found \"sorted\" (one of none into-albedo after-lights)"},
      {R"({"transparency": {"blend": {"rgb": {"dst": "alpha"}}}})",
       "p.json: /transparency/blend/rgb/dst: found \"alpha\" (one of zero"},
      {R"({"strategy": "forward-loop", "transparency": {"mode": "into-albedo"}})",
       "p.json: transparency into-albedo with strategy forward-loop, which has no G-buffer (after-lights, or a "
       "deferred"},
      {R"({"transparency": {"mode": "into-albedo"}, "strategy": "forward-multipass"})",
       "p.json: transparency into-albedo with strategy forward-multipass"},
      {R"({"preset": "lecture", "transparency": {"mode": "into-albedo"}})",
       "p.json: transparency into-albedo with strategy forward-loop"},
      {R"({"transparency": {"alpha": 1}})", "p.json: /transparency/alpha: this key is unknown"},
      {R"({"light_model": {"cone": "cosine"}})",
       "p.json: /light_model/cone: found \"cosine\" (one of none smooth_cutoff"},
      {R"({"light_model": {"order": "albedo_last"}})",
       "p.json: /light_model: order albedo_last with a specular colour"},
      {R"({"light_model": {"damping": -1}})", "p.json: /light_model/damping: found -1"},
      {R"({"light_model": {"global_ambient": [0, 0, 2e18]}})", "p.json: /light_model/global_ambient/2: found 2e+18"},
      {R"({"gbuffer": {"specular_format": "rgb16f"}})", "p.json: /gbuffer/specular_format: found \"rgb16f\""},
      {R"({"target": "d32f"})",
       "p.json: /target: found \"d32f\" (one of rgba8 srgb8_a8 rgb10_a2 rgba16 "
       "r11g11b10f rgb16f rgba16f rgba32f)"},
      {R"({"profile": "mesa"})", "p.json: /profile: found \"mesa\" (one of ideal mesa-llvmpipe-22.3)"},
      {R"({"post": {"samples": 9}})", "p.json: /post/samples: found 9 (a whole number from 1 to 8)"},
      {R"({"post": {"bloom": {"radius": 0}}})", "p.json: /post/bloom/radius: found 0"},
      {R"({"post": {"white": 1e-7}})", "p.json: /post: white is between 0 and 1e-6"},
      {R"({"post": {"key": 0}})", "p.json: /post/key: found 0"},
      {R"({"post": {"output": "d32f"}})", "p.json: /post/output: found \"d32f\""},
      {R"({"post": {"fxaa": true}})", "p.json: /post/fxaa: this key is unknown"},
      {R"({"view": "wireframe"})", "p.json: /view: found \"wireframe\" (one of lit albedo"},
      {R"({"target": "rgba8", "target": "rgba8"})", "p.json: /target: this key is given twice"},
  };
  for (const auto& [text, start] : cases) CHECK_STARTS_WITH(pipeline_refusal(text), start);
}

template <typename Change>
std::string invalid_pipeline(const Change& change) {
  Pipeline p;
  change(p);
  return error_of(ErrorKind::usage, [&] { validate(p); });
}

TEST_CASE("pipelines out of range are named by field") {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  CHECK_STARTS_WITH(invalid_pipeline([](Pipeline& p) { p.width = 0; }), "width: 0 is out of range (1 to 1048576");
  CHECK_STARTS_WITH(invalid_pipeline([](Pipeline& p) { p.height = 1048577; }), "height: 1048577");
  CHECK_STARTS_WITH(invalid_pipeline([](Pipeline& p) { p.target = Format::r32ui; }), "target: r32ui");
  CHECK_STARTS_WITH(invalid_pipeline([](Pipeline& p) { p.gbuffer.normal.format = Format::rgba8; }),
                    "gbuffer.normal.format: rgba8");
  CHECK_STARTS_WITH(invalid_pipeline([&](Pipeline& p) { p.light_model.shininess = kNan; }), "light_model.shininess");
  CHECK_STARTS_WITH(invalid_pipeline([&](Pipeline& p) { p.light_model.specular_color.y = INFINITY; }),
                    "light_model.specular_color");
  CHECK_STARTS_WITH(invalid_pipeline([](Pipeline& p) { p.light_model.order = TermOrder::albedo_last; }),
                    "light_model.order");
  CHECK_STARTS_WITH(invalid_pipeline([](Pipeline& p) { p.light_model.cone = Cone(9); }), "light_model.cone");
  CHECK_STARTS_WITH(invalid_pipeline([&](Pipeline& p) { p.light_model.damping = kNan; }), "light_model.damping");
  CHECK_STARTS_WITH(invalid_pipeline([](Pipeline& p) { p.light_model.global_ambient.y = -1.0f; }),
                    "light_model.global_ambient");
  CHECK_STARTS_WITH(invalid_pipeline([](Pipeline& p) { p.gbuffer.specular = Format::rgb16f; }), "gbuffer.specular");
  CHECK_STARTS_WITH(invalid_pipeline([&](Pipeline& p) { p.geometry.clear_depth = kNan; }), "geometry.clear_depth");
  CHECK_STARTS_WITH(invalid_pipeline([](Pipeline& p) { p.geometry.depth_func = DepthFunc(9); }), "geometry.depth_func");
  CHECK_STARTS_WITH(invalid_pipeline([](Pipeline& p) { p.geometry.depth_format = Format::rgba8; }),
                    "geometry.depth_format: rgba8 is out of range (d32f, d24 or d16)");
  CHECK_STARTS_WITH(invalid_pipeline([&](Pipeline& p) { p.geometry.polygon_offset_factor = kNan; }),
                    "geometry.polygon_offset_factor");
  CHECK_STARTS_WITH(invalid_pipeline([](Pipeline& p) { p.geometry.polygon_offset_units = INFINITY; }),
                    "geometry.polygon_offset_units");
  CHECK_STARTS_WITH(invalid_pipeline([](Pipeline& p) {
                      p.gbuffer.position_from_depth = true;
                      p.geometry.depth_near = 1.0f;
                    }),
                    "gbuffer.position_from_depth");
}

TEST_CASE("every profile has every target format") {
  for (const NumericProfile profile : {NumericProfile::ideal, NumericProfile::mesa_llvmpipe_22_3})
    for (const Format target : kTargetFormats) {
      Pipeline p;
      p.profile = profile;
      p.target = target;
      CHECK_NOTHROW(validate(p));
      CHECK(pipeline_from_json(pipeline_json(p), "p", {}) == p);
    }
}

TEST_CASE("light volumes and blending out of range are named by field") {
  CHECK_STARTS_WITH(invalid_pipeline([](Pipeline& p) { p.light_volumes.slices = 65; }), "light_volumes.slices: 65");
  CHECK_STARTS_WITH(invalid_pipeline([](Pipeline& p) { p.light_volumes.stacks = 1; }), "light_volumes.stacks: 1");
  CHECK_STARTS_WITH(invalid_pipeline([](Pipeline& p) { p.light_volumes.spot = LightExtent(5); }),
                    "light_volumes.spot: 5");
  CHECK_STARTS_WITH(invalid_pipeline([](Pipeline& p) { p.blend.alpha.dst = BlendFactor(15); }), "blend: dst: 15");
  CHECK_STARTS_WITH(invalid_pipeline([](Pipeline& p) { p.blend.constant[2] = INFINITY; }), "blend.constant");
  CHECK_STARTS_WITH(invalid_pipeline([](Pipeline& p) { p.strategy = Strategy(4); }), "strategy: 4");
}

TEST_CASE("transparency out of range is named by field, and wants a G-buffer where it blends into one") {
  CHECK_STARTS_WITH(invalid_pipeline([](Pipeline& p) { p.transparency.mode = TransparencyMode(3); }),
                    "transparency.mode: 3");
  CHECK_STARTS_WITH(invalid_pipeline([](Pipeline& p) { p.transparency.blend.rgb.src = BlendFactor(15); }),
                    "transparency.blend: src: 15");
  CHECK_STARTS_WITH(invalid_pipeline([](Pipeline& p) { p.transparency.blend.constant[0] = INFINITY; }),
                    "transparency.blend.constant");
  const auto into_albedo = [](Strategy strategy, NumericProfile profile, Format plane) {
    return [=](Pipeline& p) {
      p.transparency.mode = TransparencyMode::into_albedo;
      p.strategy = strategy;
      p.profile = profile;
      p.gbuffer.albedo.format = plane;
    };
  };
  constexpr NumericProfile kIdeal = NumericProfile::ideal, kMesa = NumericProfile::mesa_llvmpipe_22_3;
  for (const Strategy forward : {Strategy::forward_multipass, Strategy::forward_loop})
    CHECK_STARTS_WITH(invalid_pipeline(into_albedo(forward, kIdeal, Format::rgba8)),
                      "transparency.mode: into-albedo blends into the G-buffer, which forward-");
  for (const Format plane : kAlbedoFormats)
    for (const Strategy deferred : {Strategy::deferred_volumes, Strategy::deferred_loop})
      for (const NumericProfile profile : {kIdeal, kMesa}) {
        Pipeline p;
        into_albedo(deferred, profile, plane)(p);
        CHECK_NOTHROW(validate(p));
      }
}

TEST_CASE("executions out of range are named by field") {
  const auto invalid_run = [](Execution e) { return error_of(ErrorKind::usage, [&] { validate(e); }); };
  CHECK_NOTHROW(validate(Execution{}));
  Execution e;
  e.threads = -1;
  CHECK_STARTS_WITH(invalid_run(e), "threads: -1 is out of range (0 to 1024");
  e = {};
  e.tile = 24;
  CHECK_STARTS_WITH(invalid_run(e), "tile: 24");
  e = {};
  e.simd = "mmx";
  CHECK_STARTS_WITH(invalid_run(e), "simd: 'mmx'");
}

}  // namespace
}  // namespace trueshade
