#include "tests/programs/oracle/program_inputs.h"

#include <bit>
#include <cmath>
#include <limits>

namespace trueshade::testing {

namespace {

using Words = std::vector<uint32_t>;

const std::vector<ProgramInput> kInputs = [] {
  std::vector<ProgramInput> all;
  const auto add = [&](const char* prefix, std::initializer_list<ProgramInput> members) {
    for (const ProgramInput& member : members)
      all.push_back(member), all.back().name = prefix + member.name;
  };
  add("TsSurface.ts_surface.", {{"position", 'f', 3, "position"},
                                {"normal", 'f', 3, "unit"},
                                {"albedo", 'f', 4, "share"},
                                {"specular", 'f', 3, "share"},
                                {"shininess", 'f', 1, "exponent"},
                                {"metallic", 'f', 1, "share"},
                                {"roughness", 'f', 1, "share"},
                                {"occlusion", 'f', 1, "share"},
                                {"emission", 'f', 3, "share"},
                                {"uv", 'f', 2, "share"},
                                {"uv1", 'f', 2, "share"},
                                {"tangent", 'f', 4, "unit"},
                                {"object", 'u', 1, "count"},
                                {"material", 'u', 1, "count"},
                                {"pixel_x", 'u', 1, "count"},
                                {"pixel_y", 'u', 1, "count"},
                                {"user", 'f', 16, "position", 4}});
  add("TsLight.ts_light.",
      {{"type", 'u', 1, "count"},        {"index", 'u', 1, "count"},          {"position", 'f', 3, "position"},
       {"range", 'f', 1, "length"},      {"direction", 'f', 3, "unit"},       {"color", 'f', 3, "share"},
       {"attenuation", 'f', 3, "share"}, {"ambient", 'f', 3, "share"},        {"cone", 'f', 1, "share"},
       {"penumbra", 'f', 1, "share"},    {"cos_inner", 'f', 1, "share"},      {"cos_outer", 'f', 1, "share"},
       {"cone_scale", 'f', 1, "length"}, {"cone_offset", 'f', 1, "position"}, {"spot_exponent", 'f', 1, "exponent"},
       {"penumbra_slope", 'f', 1, "length"}, {"cutoff_slope", 'f', 1, "length"},
       {"right", 'f', 3, "position"},    {"up", 'f', 3, "position"},          {"shadow", 'i', 1, "index"},
       {"cookie", 'i', 1, "index"},      {"user", 'f', 16, "position", 4}});
  add("TsView.ts_view.", {{"eye", 'f', 3, "position"},
                          {"axis", 'f', 3, "unit"},
                          {"view", 'f', 16, "matrix", 0, 4},
                          {"projection", 'f', 16, "matrix", 0, 4},
                          {"view_projection", 'f', 16, "matrix", 0, 4},
                          {"size", 'f', 2, "pixels"},
                          {"time", 'f', 1, "length"},
                          {"frame", 'u', 1, "count"}});
  add("TsSum.", {{"ts_sum", 'f', 3, "share"}});
  return all;
}();

uint32_t bits_of(double value) { return std::bit_cast<uint32_t>(float(value)); }

/// Of a plain scene, by what the member is.
Words plain_value(Pcg32& random, const std::string& kind, int scalars) {
  Words words;
  double squares = 0;
  std::vector<double> direction;
  for (int i = 0; i < scalars; ++i) {
    direction.push_back(random.between(-1, 1));
    if (i < 3) squares += direction.back() * direction.back();
  }
  for (int i = 0; i < scalars; ++i) {
    if (kind == "position") words.push_back(bits_of(random.between(-10, 10)));
    if (kind == "unit") words.push_back(bits_of(i == 3 ? 1 : direction[size_t(i)] / std::sqrt(squares)));
    if (kind == "share") words.push_back(bits_of(random.real()));
    if (kind == "length") words.push_back(bits_of(random.between(0.5, 20)));
    if (kind == "pixels") words.push_back(bits_of(1 + random.below(1920)));
    if (kind == "exponent") words.push_back(bits_of(random.below(2) == 0 ? random.below(256) : random.between(0, 64)));
    if (kind == "matrix") words.push_back(bits_of((i % 5 == 0 ? 1 : 0) + direction[size_t(i)] / 2));
    if (kind == "count") words.push_back(random.below(8) == 0 ? random.below(2000) : random.below(8));
    if (kind == "index") words.push_back(random.below(5) - 1);
  }
  return words;
}

uint32_t odd_value(Pcg32& random, char base) {
  constexpr float kInf = std::numeric_limits<float>::infinity(), kNaN = std::numeric_limits<float>::quiet_NaN();
  constexpr float kFloats[] = {0.0f,       -0.0f,     kInf,       -kInf,     kNaN,        0x1p-149f,
                               -0x1p-149f, 0x1p-130f, -0x1p-127f, 0x1p-126f, 1e38f,       -0x1.fffffep127f,
                               1e-30f,     -1e-30f,   1.0f,       -1.0f,     0.99999994f, 1.0000001f,
                               0x1p24f,    1e6f,      -1e6f,      1e9f,      0.5f,        -2.5f};
  constexpr uint32_t kIntegers[] = {0,          1,          2,          31,         32,    0xFFFFFFFF,
                                    0x80000000, 0x7FFFFFFF, 0x7F800001, 0xFFC00000, 0xFFFF};
  if (base == 'f') return std::bit_cast<uint32_t>(kFloats[random.below(std::size(kFloats))]);
  return kIntegers[random.below(std::size(kIntegers))];
}

Words value_of(Pcg32& random, InputsLike like, const ProgramInput& input) {
  Words words = plain_value(random, input.kind, input.scalars);
  if (like == InputsLike::plain) return words;
  if (like == InputsLike::mixed && random.below(4) != 0) return words;
  for (uint32_t& word : words) {
    if (like == InputsLike::any_bits) word = random.next();
    if (random.below(3) == 0) word = odd_value(random, input.base);
  }
  return words;
}

}  // namespace

std::span<const ProgramInput> interface_inputs() { return kInputs; }

std::map<std::string, std::vector<uint32_t>> random_inputs(Pcg32& random, InputsLike like,
                                                           std::span<const ProgramInput> more) {
  std::map<std::string, Words> values;
  for (const ProgramInput& input : kInputs) values[input.name] = value_of(random, like, input);
  for (const ProgramInput& input : more) values[input.name] = value_of(random, like, input);
  return values;
}

}  // namespace trueshade::testing
