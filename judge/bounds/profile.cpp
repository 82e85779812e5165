#include "judge/bounds/profile.h"

namespace trueshade::oracle {

namespace {

/// D3D11.3 functional spec: 3.4.1 and 15.16 (snapping, planes from snapped vertices), 3.2.2 (half toward zero), 3.2.3
/// (unorm within 0.6), 3.1 (+ - * within half an ulp... of any order; division and roots within 1).
Profile d3d_class() {
  Profile p;
  p.name = "d3d-class";
  p.subpixel_bits = 8;
  p.snap = SnapRule::nearest_0_6;
  p.fill = FillRule::unstated;  // top-left in memory: which way memory lies in a GL window is the driver's secret
  p.plane_origin = PlaneOrigin::snapped;
  p.unorm_reach = p.srgb_reach = 0.6;
  p.half = HalfStore::toward_zero;
  p.most_depth_unit = 1;  // 15.10
  p.max_norm_slope = true;
  // 7.18.16: at least 8 fractional bits of weights and levels. 3.2.3: sRGB within half a code; decoded, then filtered.
  p.sampling = {0x1p-8, 0x1p-8, 0x1p-8, 1, 0.5, false, false, true, 0x1p-8};
  p.fetch_error = 1.25 * 0x1p-23;
  p.arithmetic.roundoff = 0x1p-24;
  return p;
}

/// Vulkan 1.3's specification: "Precision and Operation of SPIR-V Instructions" (+ - * rounded either way, division 2.5
/// ulp, inversesqrt 2 ulp, exp2 3 + 2|x| ulp, log2 3 ulp or 2^-21, sqrt and pow by these), which are GLSL's numbers;
/// "Fixed-Point Data Conversions" (either neighbour of a code, an integer exactly); "Texel Input Operations" (sRGB is
/// decoded before it is filtered). Rasterization promises no more than OpenGL's: subPixelPrecisionBits of 4 and more.
Profile vulkan() {
  Profile p;
  p.name = "vulkan";
  p.sampling.decodes_late = false;
  return p;
}

/// WGSL's "Floating Point Accuracy", as its conformance suite (gpuweb/cts, webgpu/util/floating_point.ts) accepts it:
/// from either neighbour of the real result, so an ulp beyond the table's 2.5 of division and 2 of inverseSqrt; sqrt is
/// 1 / inverseSqrt. WebGPU states neither subpixel bits nor the precision of stores, of blending and of textures. It
/// runs on Vulkan, D3D12 and Metal, so of these it promises what the least of them does, Vulkan.
Profile webgpu() {
  Profile p = vulkan();
  p.name = "webgpu";
  p.arithmetic.divide = 3.5 * 0x1p-23;
  p.arithmetic.inverse_sqrt = 3 * 0x1p-23;
  p.arithmetic.square_root = 6.6 * 0x1p-23;
  p.arithmetic.wgsl = true;
  return p;
}

/// docs/gl_rules.md sections 1 to 6: 24.8 to nearest even, planes from unsnapped positions, clipping at the viewport.
Profile llvmpipe() {
  Profile p;
  p.name = "mesa-llvmpipe-22.3";
  p.subpixel_bits = 8;
  p.snap = SnapRule::nearest;
  p.fill = FillRule::left_low;
  p.plane_origin = PlaneOrigin::unsnapped;
  p.unorm_reach = 0.5;
  p.srgb_reach = 0.67;  // 0.6608 in 4.7 million values (tests/judge/srgb_targets.cpp)
  p.half = HalfStore::toward_zero;
  p.blend = BlendRule::mesa_codes;
  p.least_depth_unit = 2;
  p.max_norm_slope = true;
  // RGBA8 with 8-bit weights and results, other formats in floats; rho the longer gradient.
  p.sampling = {0x1p-8, 0, 0x1p-8, 1, 0x1p-10, false, true, false, 0.045};
  p.fetch_error = 1.25 * 0x1p-23;
  p.arithmetic.roundoff = 0x1p-24;
  return p;
}

/// docs/arithmetic.md: only what that page leaves to f32 evaluation is left open here.
Profile ideal() {
  Profile p;
  p.name = "ideal";
  p.subpixel_bits = 8;
  p.snap = SnapRule::nearest;
  p.fill = FillRule::left_low;
  p.plane_origin = PlaneOrigin::snapped;
  p.exact_vertices = p.exact_planes = true;
  p.clips_to_view = false;
  p.blend = BlendRule::float_once;
  p.unorm_reach = p.srgb_reach = 0.5;
  p.half = HalfStore::toward_zero;
  p.most_depth_unit = 1;
  p.max_norm_slope = true;
  p.fetch_error = 0x1p-24;
  p.sampling = {0, 0, 0, 0, 0, false, false, false, 1e-6, 0x1p-24};
  // 1 / sqrt is two roundings; the others one, each to nearest.
  p.arithmetic = {0x1p-24, 0x1p-24, 2 * 0x1p-24, 0x1p-24, true};
  return p;
}

}  // namespace

std::optional<Profile> profile_named(std::string_view name) {
  if (name == "unknown") return Profile{};
  for (const Profile& profile : {vulkan(), webgpu(), d3d_class(), llvmpipe(), ideal()})
    if (name == profile.name) return profile;
  return std::nullopt;
}

std::string text(const StoreRule& rule) {
  std::string codes = rule.intel_estimates    ? "codes as llvmpipe's on Intel"
                      : rule.mesa_codes       ? "codes as llvmpipe's"
                      : rule.code_reach > 0.5 ? "codes within 0.6"
                                              : "codes to nearest";
  if (rule.sums_in_floats) codes += ", sums kept in floats";
  return codes + ", halves " +
         (rule.half == HalfStore::nearest          ? "to nearest"
          : rule.half == HalfStore::through_halves ? "to nearest, smaller floats by them"
                                                   : "toward zero");
}

const char* text(SnapRule rule) {
  switch (rule) {
    case SnapRule::nearest:
      return "nearest";
    case SnapRule::nearest_0_6:
      return "nearest within 0.6";
    case SnapRule::toward_zero:
      return "toward zero";
    case SnapRule::unstated:
      return "unstated";
  }
  return "";
}

const char* text(PlaneOrigin origin) {
  switch (origin) {
    case PlaneOrigin::snapped:
      return "snapped";
    case PlaneOrigin::unsnapped:
      return "unsnapped";
    case PlaneOrigin::either:
      return "either";
  }
  return "";
}

const char* text(HalfStore store) {
  switch (store) {
    case HalfStore::toward_zero:
      return "toward zero";
    case HalfStore::nearest:
      return "nearest";
    case HalfStore::through_halves:
      return "through halves";
    case HalfStore::either:
      return "either";
  }
  return "";
}

}  // namespace trueshade::oracle
