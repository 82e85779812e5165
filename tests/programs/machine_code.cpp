// Stages of programs as machine code (programs/run/fast): each operation by its plain formula, values that no register
// is left for, and what becomes of memory. Where the build has no encoder or the machine neither AVX-512 nor AVX2,
// nothing is checked. Random programs run as machine code in random_programs.cpp and agreement.cpp.
#include <sys/mman.h>

#include <fstream>

#include "core/simd/simd_target.h"
#include "programs/building/node_builder.h"
#include "programs/run/fast/machine_stages.h"
#include "tests/catch.hpp"
#include "tests/filtered_process.h"
#include "tests/programs/plain_operations.h"
#include "tests/programs/random_words.h"
#include "tests/programs/run_program.h"

namespace trueshade::programs {
namespace {

constexpr size_t kMachinePixels = 3 * kBlockLanes;

/// The targets that have machine code here.
std::vector<std::string_view> machine_targets() {
  std::vector<std::string_view> out;
  for (const std::string_view target : simd_targets()) {
    const SimdScope scope(target);
    const Executable executable = executable_of(program_of_light("return l.color * s.position;"));
    if (executable.machine->function(executable, Rate::pair) != nullptr) out.push_back(target);
  }
  return out;
}

constexpr uint32_t kSpecialInputs[] = {0x00000000u, 0x80000000u, 0x3F800000u, 0xBF800000u, 0x7F800000u, 0xFF800000u,
                                       0x7FC00000u, 0x7F800001u, 0x00000001u, 0x80000001u, 0x007FFFFFu, 0x00800000u,
                                       0x7F7FFFFFu, 0xFF7FFFFFu, 0x3F000000u, 0xBF000000u, 0x40200000u, 0x4B7FFFFFu,
                                       0x4F000000u, 0xCF000000u, 0x4F800000u, 0x41200000u, 0xFFFFFFFFu, 0x0000001Fu,
                                       0x00000020u, 0x49742401u, 0x42000000u, 0x33000001u, 0x477FF000u, 0x3F7FFFFFu};

uint32_t random_bits(RandomWords& random) {
  const uint32_t kind = random() % 4;
  if (kind == 0) return random();
  if (kind == 1) return bits_of(float(int(random() % 4096) - 2048) / 256.0f);
  if (kind == 2) return random() % 64 - 32;
  return kSpecialInputs[random() % std::size(kSpecialInputs)];
}

/// A value of any type as a float of the same bits, so that it can be an output; booleans are 0 and 1.
NodeId as_float(NodeBuilder& builder, NodeId id) {
  const Type type = builder.node(id).type;
  if (type == Type::f32) return id;
  if (type == Type::boolean) return builder.select(id, builder.number(1.0f), builder.number(0.0f));
  return builder.make(Op::f_from_bits, id);
}

/// A program whose start.x is the node; its inputs are a0, a1 ... of surfaces.
Program program_of(NodeBuilder& builder, NodeId result) {
  Program program = builder.program();
  program.output.fill(builder.number(0.0f));
  program = builder.program();
  program.output.fill(result);
  for (int i = kLightOutput; i < kStartOutput; ++i) program.output[size_t(i)] = result;
  set_rates(program);
  program = without_dead_nodes(program);
  set_rates(program);
  return program;
}

/// start.x at kMachinePixels surfaces.
std::vector<uint32_t> started(const Executable& executable, const std::vector<std::vector<LaneBlock>>& planes) {
  Registers registers(executable);
  ConstantValues constants(executable);
  LaneValues lights(executable.at(Rate::light), kBlockLanes), surfaces(executable.at(Rate::surface), kMachinePixels);
  const auto& inputs = executable.at(Rate::surface).inputs;
  for (size_t i = 0; i < inputs.size(); ++i) {
    const std::string& name = executable.program.inputs[inputs[i]].name;
    surfaces.set_input(i, planes[size_t(std::stoi(name.substr(1)))][0].lane);
  }
  std::vector<LaneBlock> start[3];
  for (auto& blocks : start) blocks.resize(kMachinePixels / kBlockLanes);
  float* const start_planes[3] = {start[0][0].lane, start[1][0].lane, start[2][0].lane};
  run_constants(executable, constants, registers);
  run_lights(executable, constants, lights, registers);
  run_surfaces(executable, constants, surfaces, start_planes, registers);
  std::vector<uint32_t> out;
  for (size_t i = 0; i < kMachinePixels; ++i) out.push_back(bits_of(start_planes[0][i]));
  return out;
}

std::vector<std::vector<LaneBlock>> random_planes(size_t count, RandomWords& random) {
  std::vector<std::vector<LaneBlock>> planes(count, std::vector<LaneBlock>(kMachinePixels / kBlockLanes));
  for (auto& plane : planes)
    for (LaneBlock& block : plane)
      for (float& lane : block.lane) lane = float_of(random_bits(random));
  return planes;
}

/// An operation of inputs, of which booleans are "a < 0" of an integer.
Executable executable_of_op(Op op) {
  NodeBuilder builder("one", 1000);
  NodeId operand[3] = {kNoNode, kNoNode, kNoNode};
  for (int k = 0; k < info(op).operands; ++k) {
    const Type type = op == Op::select ? (k == 0 ? Type::boolean : Type::f32) : info(op).operand[k];
    operand[k] = builder.input("a" + std::to_string(k), type == Type::boolean ? Type::i32 : type, Rate::surface);
    if (type == Type::boolean) operand[k] = builder.make(Op::i_lt, operand[k], builder.constant(Type::i32, 0));
  }
  const NodeId result = op == Op::select ? builder.select(operand[0], operand[1], operand[2])
                                         : builder.make(op, operand[0], operand[1], operand[2]);
  return executable_of(program_of(builder, as_float(builder, result)));
}

uint32_t expected_of(Op op, const uint32_t given[3]) {
  uint32_t operand[3] = {};
  for (int k = 0; k < info(op).operands; ++k)
    operand[k] = info(op).operand[k] == Type::boolean ? given[k] >> 31 : given[k];
  const uint32_t bits = plain(op, operand[0], operand[1], operand[2]);
  return info(op).result == Type::boolean ? bits_of(bits != 0 ? 1.0f : 0.0f) : bits;
}

/// 0 where the program's light is as it must be; `code` says whether machine code must have made it.
int wrong_light(bool code) {
  const Executable executable = executable_of(program_of_light("return l.color * s.position;"));
  if ((executable.machine->function(executable, Rate::pair) != nullptr) != code) return 1;
  const std::map<std::string, float> inputs{{"light.color.y", 3.0f}, {"surface.position.y", 0.25f}};
  return light_of(executable.program, inputs)[1] == 0.75f ? 0 : 2;
}

}  // namespace

TEST_CASE("Machine code of every operation has the bits of its plain formula") {
  for (const std::string_view target : machine_targets()) {
    const SimdScope scope(target);
    RandomWords random(11);
    for (int op = int(Op::f_add); op < kOpCount; ++op) {
      const Executable executable = executable_of_op(Op(op));
      INFO(target << ", " << info(Op(op)).name);
      if (!executable.at(Rate::surface).code.empty())
        REQUIRE(executable.machine->function(executable, Rate::surface) != nullptr);
      for (int round = 0; round < 60; ++round) {
        const auto planes = random_planes(3, random);
        const std::vector<uint32_t> made = started(executable, planes);
        for (size_t i = 0; i < kMachinePixels; ++i) {
          uint32_t given[3];
          for (size_t k = 0; k < 3; ++k) given[k] = bits_of(planes[k][i / kBlockLanes].lane[i % kBlockLanes]);
          INFO(std::hex << given[0] << " " << given[1] << " " << given[2]);
          REQUIRE(equal_or_nan(made[i], expected_of(Op(op), given)));
        }
      }
    }
  }
}

TEST_CASE("Machine code gives functions numbers of the text, of the frame and of lights as lanes") {
  const char* const bodies[] = {
      "return pow(vec3(1.7, abs(s.position.y), 0.3), vec3(s.normal.x, l.spot_exponent, l.range));",
      "return atan(vec3(2.5, l.range, s.position.x), vec3(s.position.x, s.position.y, l.spot_exponent));",
      "return vec3(pow(l.range, abs(s.position.x)), fma(l.range, s.position.x, 0.7), pow(v.time + 2.0, "
      "s.position.y));"};
  for (const std::string_view target : machine_targets())
    for (const char* body : bodies) {
      const SimdScope scope(target);
      const Program program = program_of_light(body);
      RandomWords random(3);
      for (int round = 0; round < 50; ++round) {
        std::map<std::string, float> inputs;
        for (const ProgramInput& input : program.inputs) inputs[input.name] = float(random() % 4096) / 512.0f - 2.0f;
        const std::vector<float> made = light_of(program, inputs);
        const MachineCodeScope interpreted(false);
        const std::vector<float> wanted = light_of(program, inputs);
        INFO(target << ": " << body);
        for (size_t c = 0; c < 3; ++c) REQUIRE(equal_or_nan(bits_of(made[c]), bits_of(wanted[c])));
      }
    }
}

TEST_CASE("Machine code chooses between booleans that were put away, by one that was") {
  for (const std::string_view target : machine_targets()) {
    const SimdScope scope(target);
    NodeBuilder builder("choice", 1000);
    NodeId a[6], truth[3];
    for (int k = 0; k < 6; ++k) a[k] = builder.input("a" + std::to_string(k), Type::f32, Rate::surface);
    for (int k = 0; k < 3; ++k) truth[k] = builder.make(Op::f_lt, a[k], a[k + 3]);
    const NodeId called = builder.make(Op::sin, a[0]);  // puts all away
    const NodeId truths = builder.make(Op::b_and, builder.make(Op::f_lt, called, a[1]), truth[2]);
    const NodeId chosen = builder.select(truth[0], truth[1], truths);
    const NodeId again =
        builder.select(chosen, builder.make(Op::b_not, truth[2]), builder.make(Op::b_or, truth[0], truths));
    const NodeId both = builder.make(Op::f_add, as_float(builder, chosen),
                                     builder.make(Op::f_mul, as_float(builder, again), builder.number(2.0f)));
    const Executable executable = executable_of(program_of(builder, both));
    RandomWords random(31);
    for (int round = 0; round < 50; ++round) {
      const auto planes = random_planes(6, random);
      const std::vector<uint32_t> made = started(executable, planes);
      const MachineCodeScope interpreted(false);
      const std::vector<uint32_t> wanted = started(executable, planes);
      INFO(target);
      for (size_t i = 0; i < kMachinePixels; ++i) REQUIRE(made[i] == wanted[i]);
    }
  }
}

TEST_CASE("Powers of integers that the text says have the bits of pow") {
  for (const std::string_view target : machine_targets())
    for (const int power : {0, 1, 2, 3, 5, 16, 31, 100, 8192}) {
      const SimdScope scope(target);
      NodeBuilder builder("power", 1000);
      const NodeId x = builder.input("a0", Type::f32, Rate::surface);
      const Executable executable =
          executable_of(program_of(builder, builder.make(Op::pow, x, builder.number(float(power)))));
      RandomWords random(5);
      const auto planes = random_planes(1, random);
      const std::vector<uint32_t> made = started(executable, planes);
      for (size_t i = 0; i < kMachinePixels; ++i) {
        const uint32_t given = bits_of(planes[0][i / kBlockLanes].lane[i % kBlockLanes]);
        INFO(target << ", " << float_of(given) << " to the " << power);
        REQUIRE(equal_or_nan(made[i], plain(Op::pow, given, bits_of(float(power)), 0)));
      }
    }
}

TEST_CASE("Values that no register is left for come back from the frame, booleans and across calls too") {
  constexpr int kValues = 90;
  for (const std::string_view target : machine_targets())
    for (const bool calls : {false, true}) {
      const SimdScope scope(target);
      NodeBuilder builder("many", 10'000);
      std::vector<NodeId> floats, truths;
      for (int k = 0; k < kValues; ++k) {
        const NodeId a = builder.input("a" + std::to_string(k % 8), Type::f32, Rate::surface);
        const NodeId b = builder.input("a" + std::to_string(k / 8 % 8), Type::f32, Rate::surface);
        floats.push_back(builder.make(Op::f_add, builder.make(Op::f_mul, a, builder.number(float(k) + 0.5f)), b));
        truths.push_back(builder.make(Op::f_lt, a, floats.back()));
      }
      NodeId sum = builder.number(0.0f);
      if (calls) sum = builder.make(Op::sin, floats.front());
      for (int k = 0; k < kValues; ++k) {
        const NodeId chosen = builder.select(truths[size_t(k * 7 % kValues)], floats[size_t(k)], sum);
        sum = builder.make(Op::f_sub, chosen, sum);
        if (calls && k % 30 == 29) sum = builder.make(Op::cos, sum);
      }
      const Executable executable = executable_of(program_of(builder, sum));
      REQUIRE(executable.at(Rate::surface).registers > 64);
      RandomWords random(9);
      for (int round = 0; round < 20; ++round) {
        const auto planes = random_planes(8, random);
        REQUIRE(executable.machine->function(executable, Rate::surface) != nullptr);
        const std::vector<uint32_t> made = started(executable, planes);
        const MachineCodeScope interpreted(false);
        REQUIRE(executable.machine->function(executable, Rate::surface) == nullptr);
        const std::vector<uint32_t> wanted = started(executable, planes);
        INFO(target << ", calls " << calls);
        for (size_t i = 0; i < kMachinePixels; ++i) REQUIRE(equal_or_nan(made[i], wanted[i]));
      }
    }
}

TEST_CASE("No page is writable and executable at once, and machine code lies in one that is not writable") {
  if (machine_targets().empty()) return;
  const int ended = testing::in_filtered_process(SECCOMP_RET_KILL_PROCESS, PROT_WRITE | PROT_EXEC, [] {
    const Executable executable = executable_of(program_of_light("return l.color * s.position;"));
    const auto at = reinterpret_cast<uintptr_t>(executable.machine->function(executable, Rate::pair));
    std::ifstream maps("/proc/self/maps");
    bool found = false;
    for (std::string line; std::getline(maps, line);) {
      const size_t dash = line.find('-'), space = line.find(' ');
      const bool has_code = std::stoull(line.substr(0, dash), nullptr, 16) <= at &&
                            at < std::stoull(line.substr(dash + 1, space - dash - 1), nullptr, 16);
      if (line.compare(space + 1, 3, "rwx") == 0 || line.compare(space + 1, 3, "-wx") == 0) return 3;
      if (has_code && line.compare(space + 1, 3, "r-x") != 0) return 4;
      found = found || has_code;
    }
    return found ? wrong_light(true) : 5;
  });
  CHECK(ended == 0);
}

TEST_CASE("The filter of the test above ends a process that asks for both at once") {
  CHECK(testing::in_filtered_process(SECCOMP_RET_KILL_PROCESS, PROT_WRITE | PROT_EXEC, [] {
          mmap(nullptr, 4096, PROT_READ | PROT_WRITE | PROT_EXEC, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
          return 0;
        }) == -1);
}

TEST_CASE("Where the system refuses executable memory, programs are interpreted") {
  CHECK(testing::in_filtered_process(SECCOMP_RET_ERRNO | EACCES, PROT_EXEC, [] { return wrong_light(false); }) == 0);
}

}  // namespace trueshade::programs
