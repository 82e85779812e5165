// core/ and the values of a pipeline.
#include "core/array.h"
#include "core/blend_state.h"
#include "core/error.h"
#include "core/expansion.h"
#include "core/half.h"
#include "core/memory_cap.h"
#include "core/numeric_profile.h"
#include "core/sha256.h"
#include "core/simd/simd_target.h"
#include "core/threads/parallel_for.h"
#include "scenes/pipeline/pipeline.h"
#include "scenes/pipeline/presets.h"
#include "scenes/scene_limits.h"
#include "shading/output/extent.h"
#include "tests/fp_modes/rows.h"

namespace trueshade {
namespace {

constexpr float kDenormal = 1e-40f;

Image floats() {
  Image image(2, 1, Format::rgba32f);
  const float texels[8] = {0.1f, kDenormal, 1e38f, -0.3f, 3.0f, 1e-45f, 0.0f, 1.0f};
  std::memcpy(image.texels.data(), texels, sizeof texels);
  return image;
}

void put_values(Bytes& out, Format format) {
  Image image(1, 1, format);
  const FormatInfo layout = info(format);
  for (int channel = 0; channel < layout.channels; ++channel) {
    image.set_code(0, 0, channel, 3);  // a denormal of every float format, a third or less of every other
    out.put(image.code(0, 0, channel));
    out.put(image.value(0, 0, channel));
  }
  out.put(*image.texel(0, 0));
  out.put(image.row_bytes());
}

void call_formats(Bytes& out) {
  for (const Format format : kFormats) {
    const FormatInfo layout = info(format);
    out.put(layout.packed());
    out.put(layout.bytes_per_texel());
    out.put(layout.srgb_channel(0));
    out.put(layout.small_float());
    if (layout.number_class == NumberClass::unorm) out.put(layout.largest_code(0));
    out.put(format_from_name(layout.name).has_value());
  }
}

void call_halves(Bytes& out) {
  for (const HalfRound round : {HalfRound::toward_zero, HalfRound::nearest})
    for (const float value : {0.1f, -0.1f, 3e-8f, 1e-7f, 65519.0f, 1e30f, kDenormal})
      out.put(half_from_float(value, round));
  for (const int half : {0x0001, 0x03ff, 0x3555, 0x7bff, 0xfc00}) out.put(float_from_half(uint16_t(half)));
}

void call_loops(Bytes& out) {
  const LoopTimes log;
  wake_threads(2);
  volatile float three = 3.0f, tiny = kDenormal;
  float third[4] = {}, half_of_tiny[4] = {};
  parallel_for(4, 2, [&](int i) {
    third[i] = 1.0f / three;
    half_of_tiny[i] = tiny * 0.5f;
  });
  out.put(third);
  out.put(half_of_tiny);
  out.put(log.loops().size());
  out.put(thread_count(3));
  out.put(thread_count(0));
  out.put_error([] { parallel_for(4, 2, [](int) { throw Error(ErrorKind::io, "here", "a reason", "a remedy"); }); });
}

void call_names(Bytes& out) {
  out.put(profile_name(NumericProfile::ideal));
  out.put(profile_from_name("mesa-llvmpipe-22.3").has_value());
  out.put(view_from_name("overdraw").has_value());
}

void call_sha(Bytes& out) {
  Sha256 sha;
  sha.update("abc", 3);
  Sha256 other;
  out.put(int(other.resume(sha.progress())));
  out.put(sha.progress());
  out.put(sha.hex());
  out.put(other.hex());
  out.put(sha256_of("abc"));
}

void call_extents(Bytes& out) {
  Extent extent;
  extent.add({0.1, 0.3});
  extent.add({-1e-320, 0.2});
  out.put(extent.least);
  out.put(extent.most);
}

void call_light_program(Bytes& out) {
  Pipeline p;
  p.light_program.file = "lights.glsl";
  p.light_program.parameters.push_back({"gain", {0.1f, 1e-40f}});
  out.put(int(p.light_program.used()));
  out.put(int(is_spirv("vec3 light")));
  out.put(pipeline_json(p));
  out.put_error([&] { require_no_light_program(p, "a test"); });
}

void call_regions(Bytes& out) {
  Pipeline p;
  p.width = 65537;
  const PictureRegion part{3, 5, 70, 9}, outside{3, 5, 70000, 9};
  out.put(int(part.whole()));
  out.put(drawn_region(p, part).width);
  out.put(drawn_pixels(p, {}));
  out.put_error([&] { validate_region(p, outside); });
  out.put_error([&] { validate_drawn_size(p, {}); });
}

void call_simd(Bytes& out) {
  for (const std::string_view name : simd_targets()) {
    const SimdScope scope(name);
    out.put(name);
  }
  for (const std::string_view name : built_simd_targets()) out.put(name);
  out.put_error([] { const SimdScope scope("abacus"); });
}

/// A pipeline with numbers that no float holds exactly.
Pipeline tenths() {
  return pipeline_from_json(
      R"({"light_model": {"damping": 0.1, "shininess": 20.3, "specular_color": [0.1, 0.7, 1e-40]},
          "geometry": {"depth_far": 0.7, "polygon_offset_units": -1.7}, "blend": {"constant": [0.1, 0.2, 0.3, 0.4]},
          "post": {"tone_map": "reinhard", "key": 0.17, "marker_radius": 1e-40}, "width": 3e2, "height": 12})",
      "text", *preset_pipeline("lecture"));
}

void call_pipeline(Bytes& out) {
  const Pipeline p = tenths();
  const LightModel& model = p.light_model;
  for (const float number : {model.damping, model.shininess, model.specular_color[0], model.specular_color[2],
                             p.geometry.depth_far, p.geometry.polygon_offset_units, p.blend.constant[1], p.post.key})
    out.put(number);
  out.put(pipeline_json(p));
  validate(p);
  validate(Execution{});
  out.put(name_of(p.strategy));
  out.put(blends_lights(p.strategy));
  out.put(is_forward(p.strategy));
  out.put(surface_planes(p).half_round);
  out.put(made_unit_at_vertex(UnitNormals::both));
  out.put(made_unit_at_fragment(UnitNormals::both));
  out.put_error([] { pipeline_from_json(R"({"width": 0.1})", "text", Pipeline{}); });
  out.put_error([] { pipeline_from_json(R"({"post": {"key": 1e400}})", "text", Pipeline{}); });
}

void call_refusals(Bytes& out) {
  out.put_error([] {
    Pipeline p;
    p.light_model.damping = -0.1f;  // the error prints it
    validate(p);
  });
  out.put_error([] {
    Pipeline p;
    p.post.key = kDenormal;
    validate(p);
  });
  out.put_error([] {
    Execution execution;
    execution.tile = 7;
    validate(execution);
  });
}

void call_post_chain(Bytes& out) {
  PostChain post;
  out.put(post.active());
  post.marker_radius = kDenormal;
  out.put(post.active());
}

void call_light_model(Bytes& out) {
  for (const Preset& preset : presets()) {
    out.put(preset.name);
    out.put(preset.pipeline.light_model.shininess);
    out.put(reads_specular_plane(preset.pipeline.light_model));
    out.put(maps_metals(preset.pipeline.light_model));
    out.put(takes_gloss(preset.pipeline.light_model));
    out.put(shows_unlit(preset.pipeline.light_model));
    out.put(preset_pipeline(preset.name)->light_model.specular_color.x);
  }
  Scene scene;
  scene.photometric = true;
  out.put(default_pipeline(scene).light_model.shininess);
  out.put(draws_light_programs());
  out.put(draws_by_its_preset(default_pipeline(scene)));
}

void call_arrays(Bytes& out) {
  const auto numbers = std::make_shared<const std::vector<float>>(std::vector<float>{1.5f, -0.0f, 3.25f});
  const Array<float> shown(*numbers, numbers);
  Array<float> owned = shown;
  owned.reserve(8);
  owned.push_back(owned.back()), owned.pop_back(), owned.resize(4);
  owned.insert(owned.begin() + 1, {7.0f, 8.0f});
  out.put(owned.capacity() >= 8);
  for (const Array<float>& array : {shown, owned}) {
    out.put(array.owned());
    out.put(array.size());
    for (const float number : array) out.put(number);
    out.put(array.front());
    out.put(*(array.data() + 1));
  }
  owned.assign(2, 0.5f);
  out.put(owned == shown);
  owned.clear();
  out.put(owned.empty() && owned.begin() == owned.end());
}

void call_memory(Bytes& out) {
  set_memory_cap(0);
  out.put(available_memory());
  out.put(memory_cap());
  out.put(resident_memory() > 0);
  out.put(resident_memory_with_files() > 0);
  out.put(least_group_limit("/nowhere", "/a", "memory.max"));
  require_memory(1, "here", "a byte");
}

constexpr Row kValueRows[] = {
    {"core/error.h", "Error kind without_zeros",
     [](Bytes& out) { out.put(Error(ErrorKind::io, "here", "a reason", "a remedy").kind()); }},
    {"core/expansion.h", "is_expanded",
     [](Bytes& out) { out.put(is_expanded(uint64_t(65) << 20, 1 << 19, kMostExpansion)); }},
    {"core/memory_cap.h",
     "available_memory memory_cap set_memory_cap resident_memory resident_memory_with_files require_memory "
     "least_group_limit",
     call_memory},
    {"core/array.h",
     "Array owned size empty data begin end front back capacity reserve resize assign push_back pop_back clear insert "
     "vector see",
     call_arrays},
    {"scenes/scene_limits.h", "within_limit", [](Bytes& out) { out.put(within_limit(7, "bytes", "--max-file")); }},
    {"core/format.h", "info format_from_name packed bytes_per_texel srgb_channel largest_code small_float",
     call_formats},
    {"core/half.h", "half_from_float float_from_half", call_halves},
    {"core/threads/parallel_for.h", "parallel_for thread_count wake_threads LoopTimes loops TaskRef", call_loops},
    {"core/image.h", "Image code set_code value texel row_bytes",
     [](Bytes& out) {
       for (const Format format : kFormats) put_values(out, format);
     }},
    {"core/image.h", "image_hash", [](Bytes& out) { out.put(image_hash(floats())); }},
    {"core/numeric_profile.h", "profile_name profile_from_name", call_names},
    {"core/sha256.h", "Sha256 update hex progress resume sha256_of", call_sha},
    {"core/simd/simd_target.h", "simd_targets built_simd_targets SimdScope", call_simd},
    {"scenes/pipeline/image_view.h", "view_from_name", call_names},
    {"scenes/pipeline/light_model.h", "reads_specular_plane takes_gloss shows_unlit maps_metals", call_light_model},
    {"scenes/pipeline/light_program.h", "used is_spirv", call_light_program},
    {"scenes/pipeline/presets.h", "presets preset_pipeline default_pipeline draws_light_programs draws_by_its_preset",
     call_light_model},
    {"scenes/pipeline/pipeline.h",
     "pipeline_from_json pipeline_json validate name_of blends_lights is_forward surface_planes "
     "made_unit_at_vertex made_unit_at_fragment",
     call_pipeline},
    {"scenes/pipeline/pipeline.h", "validate", call_refusals},
    {"scenes/pipeline/pipeline.h", "require_no_light_program", call_light_program},
    {"scenes/pipeline/pipeline.h", "whole drawn_region drawn_pixels validate_region validate_drawn_size", call_regions},
    {"scenes/pipeline/post_chain.h", "active", call_post_chain},
    {"shading/output/extent.h", "add", call_extents},
};

}  // namespace

std::span<const Row> rows_of_values() { return kValueRows; }

}  // namespace trueshade
