#include <cmath>
#include <cstdio>
#include <iterator>

#include "core/simd/simd_target.h"
#include "programs/run/code.h"
#include "tests/catch.hpp"
#include "tests/programs/plain_operations.h"
#include "tests/programs/random_words.h"
#include "tests/programs/run_program.h"

namespace trueshade::programs {
namespace {

constexpr uint32_t kSpecialOperands[] = {
    0x00000000u, 0x80000000u, 0x3F800000u, 0xBF800000u, 0x7F800000u, 0xFF800000u, 0x7FC00000u, 0xFFC00000u,
    0x7F800001u, 0x00000001u, 0x80000001u, 0x007FFFFFu, 0x00800000u, 0x7F7FFFFFu, 0xFF7FFFFFu, 0x3F000000u,
    0xBF000000u, 0x3EFFFFFFu, 0x3FC00000u, 0x40200000u, 0xBFC00000u, 0x4B000000u, 0x4B7FFFFFu, 0x4EFFFFFFu,
    0x4F000000u, 0xCF000000u, 0xCF000001u, 0x4F7FFFFFu, 0x4F800000u, 0x46000000u, 0x46000001u, 0x42000000u,
    0x41200000u, 0x3B800000u, 0x3B7FFFFFu, 0x41A00000u, 0x477FF000u, 0x477FEFFFu, 0x33000000u, 0x33000001u,
    0x387FE000u, 0x49742400u, 0x49742401u, 0x3F7FFFFFu, 0x3F800001u, 0x0000001Fu, 0x00000020u, 0xFFFFFFFFu,
    0x7FFFFFFFu, 0x0000012Cu, 0xFFFFFED4u, 0x40490FDBu, 0x3FC90FDBu, 0x43480000u};

/// Bits that an operand of a type may have: specials, small numbers, any.
uint32_t random_bits(Type type, RandomWords& random) {
  if (type == Type::boolean) return random() & 1;
  switch (random() % 4) {
    case 0:
      return kSpecialOperands[random() % std::size(kSpecialOperands)];
    case 1:
      return type == Type::f32 ? bits_of(float(int(random() % 64)) / 4.0f - 8.0f) : random() % 64 - 32;
    case 2:
      return type == Type::f32 ? bits_of(std::ldexp(float(random()) / 0x1p31f - 1.0f, int(random() % 24) - 12))
                               : random();
    default:
      return random();
  }
}

bool is_nan(uint32_t bits) { return (bits & 0x7FFFFFFFu) > 0x7F800000u; }

/// Runs the operation on a batch of random operands; returns the first lane that is not as the plain formula says.
std::string first_fault(Op op, RandomWords& random) {
  const OpInfo& about = info(op);
  alignas(64) static uint32_t registers[4 * kBatchLanes];
  static uint32_t given[3][kBatchLanes];
  for (size_t i = 0; i < 3; ++i)
    for (size_t lane = 0; lane < kBatchLanes; ++lane) {
      given[i][lane] = random_bits(about.operand[i], random);
      registers[i * kBatchLanes + lane] = register_word(about.operand[i], given[i][lane]);
    }
  const Instruction one{op, 3, {{Place::lanes, 0}, {Place::lanes, 1}, {Place::lanes, 2}}};
  const uint32_t blocks[kBatchBlocks] = {};
  run_code({&one, 1, reinterpret_cast<float*>(registers), nullptr, nullptr, nullptr, blocks, blocks, kBatchBlocks});
  for (size_t lane = 0; lane < kBatchLanes; ++lane) {
    const uint32_t a = given[0][lane], b = given[1][lane], c = given[2][lane];
    const uint32_t wanted = plain(op, a, b, c), made = registers[3 * kBatchLanes + lane];
    if (made == register_word(about.result, wanted)) continue;
    if (about.result == Type::f32 && is_nan(made) && is_nan(wanted)) continue;
    char text[160];
    std::snprintf(text, sizeof(text), "%s of %08X %08X %08X is %08X, not %08X", std::string(about.name).c_str(), a, b,
                  c, made, wanted);
    return text;
  }
  return {};
}

}  // namespace

TEST_CASE("Every operation has the bits of its plain formula, on every SIMD target") {
  for (const std::string_view target : simd_targets()) {
    const SimdScope scope(target);
    RandomWords random(7);
    for (int op = int(Op::f_add); op < kOpCount; ++op)
      for (int round = 0; round < 40; ++round) {
        const std::string fault = first_fault(Op(op), random);
        INFO(target);
        REQUIRE(fault == "");
      }
  }
}

TEST_CASE("Operands are read where they lie: registers, planes, constants and lights") {
  alignas(64) float registers[4 * kBatchLanes], plane[2 * kBatchLanes];
  for (size_t i = 0; i < kBatchLanes; ++i) registers[i] = float(i);
  for (size_t i = 0; i < 2 * kBatchLanes; ++i) plane[i] = 1000.0f + float(i);
  const float constants[] = {0.5f, 7.0f}, lights[] = {10.0f, 20.0f, 30.0f};
  const float *const planes[] = {nullptr, plane}, *const light_values[] = {nullptr, nullptr, lights};
  uint32_t first[kBatchBlocks], light[kBatchBlocks];
  for (uint32_t k = 0; k < kBatchBlocks; ++k)
    first[k] = uint32_t((kBatchBlocks - 1 - k) * kBlockLanes), light[k] = k % 3;
  const auto at = [&](Source source, size_t lane) {
    const size_t block = lane / kBlockLanes;
    return source.place == Place::lanes      ? float(lane)
           : source.place == Place::plane    ? plane[first[block] + lane % kBlockLanes]
           : source.place == Place::constant ? constants[source.slot]
                                             : lights[light[block]];
  };
  const Source sources[] = {{Place::lanes, 0}, {Place::plane, 1}, {Place::constant, 1}, {Place::light, 2}};
  for (const std::string_view target : simd_targets()) {
    const SimdScope scope(target);
    for (const Source& a : sources)
      for (const Source& b : sources) {
        const Instruction code[] = {{Op::f_sub, 2, {a, b, {}}}, {Op::input, 3, {b, {}, {}}}};
        run_code({code, 2, registers, planes, constants, light_values, first, light, kBatchBlocks});
        for (size_t lane = 0; lane < kBatchLanes; ++lane) {
          REQUIRE(registers[2 * kBatchLanes + lane] == at(a, lane) - at(b, lane));
          REQUIRE(registers[3 * kBatchLanes + lane] == at(b, lane));
        }
      }
  }
}

TEST_CASE("Constants are folded with the interpreter's bits") {
  RandomWords random(3);
  for (int op = int(Op::f_add); op < kOpCount; ++op)
    for (int round = 0; round < 100; ++round) {
      const OpInfo& about = info(Op(op));
      const uint32_t a = random_bits(about.operand[0], random), b = random_bits(about.operand[1], random),
                     c = random_bits(about.operand[2], random);
      const uint32_t folded = applied(Op(op), about.result, a, b, c), wanted = plain(Op(op), a, b, c);
      INFO(about.name);
      CHECK((folded == wanted || (about.result == Type::f32 && is_nan(folded) && is_nan(wanted))));
    }
}

}  // namespace trueshade::programs
