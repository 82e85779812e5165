#include "tests/shading/blend_pixels.h"

#include <algorithm>

#include "core/fp_env.h"
#include "core/simd/simd_target.h"

namespace trueshade::testing {

PixelPlanes::PixelPlanes(size_t pixels) : count((pixels + 15) / 16 * 16) {
  for (auto& p : plane) {
    p = hwy::AllocateAligned<float>(count);
    std::fill_n(p.get(), count, 0.0f);
  }
}

void PixelPlanes::set(size_t i, const Rgba& pixel) {
  for (size_t c = 0; c < 4; ++c) plane[c][i] = pixel[c];
}

Rgba PixelPlanes::at(size_t i) const { return {plane[0][i], plane[1][i], plane[2][i], plane[3][i]}; }

std::array<const float*, 4> PixelPlanes::read() const {
  return {plane[0].get(), plane[1].get(), plane[2].get(), plane[3].get()};
}

std::array<float*, 4> PixelPlanes::write() { return {plane[0].get(), plane[1].get(), plane[2].get(), plane[3].get()}; }

void blend(const BlendState& state, const BlendTarget& target, const PixelPlanes& source, PixelPlanes& stored,
           std::string_view simd) {
  const FpScope fp;
  const SimdScope scope(simd);
  blend_pixels(state, target, source.read().data(), stored.write().data(), source.count);
}

Rgba blend(const BlendState& state, const BlendTarget& target, const Rgba& source, const Rgba& stored,
           std::string_view simd) {
  PixelPlanes s(1), d(1);
  s.set(0, source);
  d.set(0, stored);
  blend(state, target, s, d, simd);
  return d.at(0);
}

BlendState blending(BlendTerm term, const Rgba& constant) {
  return {true, term, term, constant, {true, true, true, true}};
}

const std::array<NamedMode, 9>& usual_modes() {
  using enum BlendFactor;
  using enum BlendEquation;
  static constexpr std::array<NamedMode, 9> kModes{{
      {"add one one", {add, one, one}},
      {"add src_alpha one_minus_src_alpha", {add, src_alpha, one_minus_src_alpha}},
      {"add src_alpha one", {add, src_alpha, one}},
      {"add one one_minus_src_alpha", {add, one, one_minus_src_alpha}},
      {"add dst_color zero", {add, dst_color, zero}},
      {"add one_minus_dst_color one", {add, one_minus_dst_color, one}},
      {"add src_color src_alpha", {add, src_color, src_alpha}},
      {"subtract src_alpha dst_color", {subtract, src_alpha, dst_color}},
      {"reverse_subtract src_alpha one", {reverse_subtract, src_alpha, one}},
  }};
  return kModes;
}

std::string text_of(const BlendState& state) {
  std::string text;
  for (const BlendTerm* term : {&state.rgb, &state.alpha})
    text += std::string(kBlendEquationNames[size_t(term->equation)]) + " " +
            std::string(kBlendFactorNames[size_t(term->src)]) + " " +
            std::string(kBlendFactorNames[size_t(term->dst)]) + (term == &state.rgb ? "; alpha " : "");
  return text;
}

}  // namespace trueshade::testing
