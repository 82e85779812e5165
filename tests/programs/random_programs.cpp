#include <algorithm>
#include <array>

#include "core/simd/simd_target.h"
#include "programs/building/node_builder.h"
#include "programs/building/specialised.h"
#include "programs/run/fast/machine_stages.h"
#include "tests/catch.hpp"
#include "tests/programs/plain_operations.h"
#include "tests/programs/random_words.h"
#include "tests/programs/run_program.h"

namespace trueshade::programs {
namespace {

constexpr size_t kProgramPixels = 5 * kBlockLanes, kProgramLights = 3;

/// Nodes of every type and rate, made of each other at random.
class RandomProgram {
 public:
  explicit RandomProgram(uint32_t seed) : random_(seed), builder_("random", 100'000) {
    for (int rate = 0; rate < kRateCount; ++rate)
      for (const Type type : {Type::f32, Type::i32, Type::u32})
        for (int k = 0; k < (type == Type::f32 ? 4 : 1) && Rate(rate) != Rate::pair; ++k)
          add_input(Rate(rate), type, k);
    for (int k = 0; k < 4; ++k) ids_.push_back(builder_.number(float(k) * 0.75f - 1.0f));
    ids_.push_back(builder_.truth(true));
    for (int k = 0; k < 120; ++k) add_operation();
  }

  /// The program whose outputs are nodes at random; those before `finish` read no sum, those after the pair's no light.
  Program made() {
    Program program = builder_.program();
    set_rates(program);
    for (int i = 0; i < kOutputCount; ++i) program.output[size_t(i)] = output(program, i);
    program = without_dead_nodes(program);
    set_rates(program);
    return program;
  }

 private:
  void add_input(Rate rate, Type type, int k) {
    const std::string name = rate == Rate::sum
                                 ? std::string("sum.") + "xyz"[k % 3]
                                 : std::string(name_of(rate)) + std::to_string(int(type)) + std::to_string(k);
    if (rate != Rate::sum || (type == Type::f32 && k < 3)) ids_.push_back(builder_.input(name, type, rate));
  }

  /// A node of the type, as an integer of any sign; late ones are likelier.
  NodeId any(Type type) {
    for (;;) {
      const size_t last = ids_.size() - 1,
                   back = std::min(last, size_t(random_() % 2 == 0 ? random_() % 12 : random_()) % ids_.size());
      const Type found = builder_.node(ids_[last - back]).type;
      const bool integers = (type == Type::i32 || type == Type::u32) && (found == Type::i32 || found == Type::u32);
      if (found == type || integers) return ids_[last - back];
    }
  }

  void add_operation() {
    const auto op = random_() % 3 != 0 ? Op(int(Op::f_add) + int(random_() % 4))
                                       : Op(int(Op::f_add) + int(random_() % (kOpCount - 2)));
    if (op == Op::select) {
      const Type type = Type(random_() % 4);
      const NodeId a = any(type);
      NodeId b = any(type);
      while (builder_.node(b).type != builder_.node(a).type) b = any(builder_.node(a).type);
      ids_.push_back(builder_.select(any(Type::boolean), a, b));
      return;
    }
    NodeId operand[3] = {kNoNode, kNoNode, kNoNode};
    for (int i = 0; i < info(op).operands; ++i) operand[i] = any(info(op).operand[i]);
    ids_.push_back(builder_.make(op, operand[0], operand[1], operand[2]));
  }

  NodeId output(const Program& program, int i) {
    Program probe = program;
    for (;;) {
      const NodeId id = any(i == kReachesOutput ? Type::u32 : Type::f32);
      probe.output.fill(ids_.front());
      probe.output[size_t(i)] = id;
      if (fault_of_outputs(probe).empty()) return id;
    }
  }

  RandomWords random_;
  NodeBuilder builder_;
  std::vector<NodeId> ids_;
};

/// Values of every input for every pixel or light, by the number of the input.
using Values = std::vector<std::vector<uint32_t>>;

Values random_values(const Program& program, RandomWords& random) {
  Values out;
  for (const ProgramInput& input : program.inputs) {
    out.emplace_back();
    for (size_t i = 0; i < kProgramPixels; ++i)
      out.back().push_back(input.type == Type::f32 ? bits_of(float(int(random() % 4096) - 2048) / 512.0f)
                                                   : random() % 64 - 16);
  }
  return out;
}

/// Every node at one pixel and light, one after the other.
std::vector<uint32_t> plain_nodes(const Program& program, const Values& values, size_t pixel, size_t light) {
  std::vector<uint32_t> out;
  for (const ProgramNode& node : program.nodes) {
    uint32_t operand[3] = {};
    for (size_t i = 0; i < node.operands().size(); ++i) operand[i] = out[node.operand[i]];
    const Rate rate = node.rate;
    out.push_back(node.op == Op::constant ? node.bits
                  : node.op == Op::input  ? values[node.bits][rate == Rate::constant ? 0
                                                              : rate == Rate::light  ? light
                                                                                     : pixel]
                                          : plain(node.op, operand[0], operand[1], operand[2]));
  }
  return out;
}

/// A program's values as the interpreter takes them.
struct Run {
  const Executable executable;
  const Values& values;
  std::vector<std::vector<LaneBlock>> planes;
  Registers registers{executable};
  ConstantValues constants{executable};
  LaneValues lights{executable.at(Rate::light), kProgramLights}, surfaces{executable.at(Rate::surface), kProgramPixels};

  Run(const Program& program, const Values& given)
      : executable(executable_of(program, Wanted::light_and_reaches)), values(given) {
    for (const auto& plane : given) {
      planes.emplace_back(kProgramPixels / kBlockLanes);
      for (size_t i = 0; i < kProgramPixels; ++i)
        planes.back()[i / kBlockLanes].lane[i % kBlockLanes] = float_of(plane[i]);
    }
    const auto& constant_inputs = executable.at(Rate::constant).inputs;
    for (size_t i = 0; i < constant_inputs.size(); ++i) constants.set_input(i, given[constant_inputs[i]][0]);
    for (size_t i = 0; i < executable.at(Rate::light).inputs.size(); ++i)
      lights.set_input(i, planes[executable.at(Rate::light).inputs[i]][0].lane);
    for (size_t i = 0; i < executable.at(Rate::surface).inputs.size(); ++i)
      surfaces.set_input(i, planes[executable.at(Rate::surface).inputs[i]][0].lane);
    run_constants(executable, constants, registers);
    run_lights(executable, constants, lights, registers);
  }

  const float* plane_of_sum(int c) const {
    for (size_t i = 0; i < executable.program.inputs.size(); ++i)
      if (executable.program.inputs[i].name == std::string("sum.") + "xyz"[c]) return planes[i][0].lane;
    return nullptr;
  }
};

void check_program(const Program& program, RandomWords& random) {
  const Values values = random_values(program, random);
  Run run(program, values);
  std::vector<LaneBlock> start[3], finish[4];
  float *start_planes[3], *finish_planes[4];
  for (int c = 0; c < 3; ++c) start[c].resize(kProgramPixels / kBlockLanes), start_planes[c] = start[c][0].lane;
  for (int c = 0; c < 4; ++c) finish[c].resize(kProgramPixels / kBlockLanes), finish_planes[c] = finish[c][0].lane;
  const float* const sum[3] = {run.plane_of_sum(0), run.plane_of_sum(1), run.plane_of_sum(2)};
  run_surfaces(run.executable, run.constants, run.surfaces, start_planes, run.registers);
  PairBlock pairs[7];
  for (PairBlock& pair : pairs) pair = {uint32_t(random() % 5 * kBlockLanes), random() % uint32_t(kProgramLights)};
  const PairResults out = run_pairs(run.executable, run.constants, run.lights, run.surfaces, pairs, run.registers);
  for (size_t lane = 0; lane < std::size(pairs) * kBlockLanes; ++lane) {
    const PairBlock& pair = pairs[lane / kBlockLanes];
    const auto wanted = plain_nodes(program, values, pair.first_pixel + lane % kBlockLanes, pair.light);
    for (int i = 0; i < kStartOutput; ++i) {
      const float* const made = i == kReachesOutput ? out.reaches : out.light[i];
      REQUIRE(equal_or_nan(bits_of(made[lane]), wanted[program.output[size_t(i)]]));
    }
  }
  run_finish(run.executable, run.constants, run.surfaces, sum, finish_planes, run.registers);
  for (size_t pixel = 0; pixel < kProgramPixels; ++pixel) {
    const auto wanted = plain_nodes(program, values, pixel, 0);
    for (int c = 0; c < 3; ++c)
      REQUIRE(equal_or_nan(bits_of(start_planes[c][pixel]), wanted[program.output[size_t(kStartOutput + c)]]));
    for (int c = 0; c < 4; ++c)
      REQUIRE(equal_or_nan(bits_of(finish_planes[c][pixel]), wanted[program.output[size_t(kFinishOutput + c)]]));
  }
}

}  // namespace

TEST_CASE("Random programs of all operations and rates have the bits of their nodes, one after the other") {
  for (uint32_t seed = 0; seed < 150; ++seed) {
    const Program program = RandomProgram(seed).made();
    for (const std::string_view target : simd_targets())
      for (const bool machine_code : {true, false}) {
        const SimdScope scope(target);
        const MachineCodeScope way(machine_code);
        RandomWords random(seed);
        INFO("seed " << seed << " on " << target << ", machine code " << machine_code << "\n" << text_of(program));
        check_program(program, random);
      }
  }
}

TEST_CASE("A program of known inputs has the bits of the program under these inputs") {
  for (uint32_t seed = 0; seed < 150; ++seed) {
    const Program program = RandomProgram(seed).made();
    RandomWords random(seed);
    Numbers inputs;
    KnownInputs known;
    for (const ProgramInput& input : program.inputs) {
      inputs[input.name] = input.type == Type::f32 ? bits_of(float(random() % 512) / 64.0f - 4.0f) : random() % 64;
      if (random() % 2 == 0 && input.rate != Rate::sum) known[input.name] = {inputs[input.name]};
    }
    const Program less = specialised(program, known);
    CHECK(less.nodes.size() <= program.nodes.size());
    CHECK(less.inputs.size() + known.size() <= program.inputs.size());
    Numbers wanted = run_once(program, inputs), made = run_once(less, inputs);
    INFO("seed " << seed);
    for (const auto& [name, bits] : wanted) CHECK(equal_or_nan(made[name], bits));
  }
}

TEST_CASE("A program for some types of light has no branch for others, and the bits of the program") {
  const Program program = program_of_light(
      "float x = s.uv.x, y = x + 9.0;\n"
      "if (l.type == light_type_ambient) y = x * 2.0;\n"
      "if (light_type_directional == l.type) y = x * 3.0;\n"
      "if (l.type == light_type_point) y = x * 4.0;\n"
      "return vec3(y);");
  const auto choices = [](const Program& p) {
    return std::count_if(p.nodes.begin(), p.nodes.end(), [](const ProgramNode& n) { return n.op == Op::select; });
  };
  const long counting = 1;  // that of `reaches`, which is light() != 0 here
  CHECK(choices(program) - counting == 3);
  for (const auto& [types, left] : std::vector<std::pair<std::vector<uint32_t>, int>>{
           {{0, 1, 2, 3}, 3}, {{1, 2}, 2}, {{0, 3}, 1}, {{3}, 0}, {{2}, 0}}) {
    const Program less = specialised(program, {{"light.type", types}});
    CHECK(choices(less) - counting == left);
    for (const uint32_t k : types) {
      Numbers inputs{{"light.type", k}, {"surface.uv.x", bits_of(0.75f)}};
      CHECK(run_once(less, inputs) == run_once(program, inputs));
    }
  }
}

}  // namespace trueshade::programs
