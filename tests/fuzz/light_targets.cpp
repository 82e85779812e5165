// Light programs from bytes: SPIR-V, GLSL, or nodes at once. Each is read, interpreted, run as machine code, and
// bounded by the judge.
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "judge/bounds/program_bounds.h"
#include "programs/building/node_builder.h"
#include "programs/front/light_program.h"
#include "programs/run/fast/machine_stages.h"
#include "tests/fuzz/promises.h"
#include "tests/fuzz/targets.h"
#include "tests/programs/run_program.h"

namespace trueshade::fuzz {

namespace {

/// glslang in this process, which is watched.
constexpr programs::ProgramLimits kSmall{3000, 64, 30'000, 100'000, 10'000, 20, 0};

/// The surface and the light that every program sees, by the names of their fields; other fields are 0.
struct Given {
  const char* name;
  float value;
};
constexpr Given kGiven[] = {{"surface.position.x", 0.3f}, {"surface.position.y", -0.2f}, {"surface.position.z", 0.5f},
                            {"surface.normal.x", 0.6f},   {"surface.normal.y", 0.0f},    {"surface.normal.z", 0.8f},
                            {"surface.albedo.x", 0.9f},   {"surface.albedo.y", 0.5f},    {"surface.albedo.z", 0.25f},
                            {"surface.albedo.w", 1.0f},   {"surface.metallic", 0.5f},    {"surface.roughness", 0.4f},
                            {"light.position.x", 2.0f},   {"light.position.y", 1.5f},    {"light.position.z", 3.0f},
                            {"light.color.x", 1.0f},      {"light.color.y", 0.75f},      {"light.color.z", 0.5f},
                            {"light.range", 9.0f},        {"light.direction.z", -1.0f},  {"light.attenuation.x", 1.0f}};

float given(std::string_view name) {
  for (const Given& g : kGiven)
    if (g.name == name) return g.value;
  return 0;
}

oracle::ShadedSurface surface() {
  oracle::ShadedSurface s;
  const auto vector = [](const std::string& name, auto& out) {
    for (size_t k = 0; k < out.size(); ++k) out[k] = {double(given(name + "." + "xyzw"[k])), 0};
  };
  vector("surface.position", s.position), vector("surface.normal", s.normal), vector("surface.albedo", s.albedo);
  s.specular = {oracle::Bounded{0.5, 0}, oracle::Bounded{double(0.4f), 0}, oracle::Bounded{}};
  s.ambient_share = {};
  return s;
}

Scene scene() {
  Scene scene;
  Light light;
  light.position = {given("light.position.x"), given("light.position.y"), given("light.position.z")};
  light.color = {given("light.color.x"), given("light.color.y"), given("light.color.z")};
  light.range = given("light.range"), light.cone_rad = 0.0f;
  scene.lights.push_back(light);
  scene.camera.eye = {};
  return scene;
}

/// Of a program that reads other fields than kGiven's nothing is promised but that it ends.
bool reads_given_alone(const programs::Program& program) {
  for (const programs::ProgramInput& input : program.inputs) {
    bool known = input.name.starts_with("parameters.") || input.name.starts_with("sum.");
    for (const Given& g : kGiven) known = known || g.name == input.name;
    if (!known) return false;
  }
  return true;
}

/// What our own executor makes of the program is something that a driver may make of it.
void check_bounds(const programs::Program& program) {
  Pipeline pipeline;
  pipeline.light_program.file = "s.spv";
  programs::Numbers numbers;
  for (const programs::ProgramInput& input : program.inputs) {
    if (input.name.starts_with("parameters."))
      pipeline.light_program.parameters.push_back(
          {input.name.substr(11, input.name.find_first_of(".[", 11) - 11), {0, 0, 0, 0}});
    numbers[input.name] = std::bit_cast<uint32_t>(given(input.name));
  }
  static const Scene lit = scene();
  const oracle::ProgramBounds bounds(lit, pipeline, {}, program);
  oracle::ProgramBounds::Registers registers;
  oracle::ProgramBounds::Block block;
  const oracle::ShadedSurface seen = surface();
  const oracle::ShadedSurface* const surfaces[] = {&seen};
  const uint32_t lights[] = {0};
  const oracle::LitRange alone = bounds.at(seen, lights, registers);
  oracle::LitRange together[1];
  bounds.at(surfaces, lights, block, together);
  const programs::Numbers made = programs::run_once(program, numbers);
  {
    const programs::MachineCodeScope interpreted(false);
    for (const auto& [name, bits] : programs::run_once(program, numbers)) {
      const float a = programs::float_of(bits), b = programs::float_of(made.at(name));
      promise(bits == made.at(name) || (a != a && b != b),
              "machine code of a light program has the interpreter's bits");
    }
  }
  if (!reads_given_alone(program) || program.defines_start) return;
  for (const oracle::LitRange* range : {&alone, static_cast<const oracle::LitRange*>(together)}) {
    if (range->undefined || range->branches.size() > 4) continue;
    for (size_t k = 0; k < 3; ++k) {
      const auto value = double(programs::float_of(made.at(std::string("light.") + "xyz"[k])));
      bool inside = false;
      for (size_t set = 0; set < size_t(1) << range->branches.size(); ++set) {
        double middle = range->color[k].value;
        for (size_t i = 0; i < range->branches.size(); ++i)
          if ((set >> i & 1) != 0) middle += range->branches[i].change[k];
        inside = inside || std::fabs(value - middle) <= range->color[k].error || value == middle;
      }
      promise(inside, "what the executor makes of a light program lies within the judge's bounds");
    }
  }
}

}  // namespace

void run_light_spv(Bytes bytes) {
  read([&] {
    std::vector<uint32_t> words((bytes.size() + 3) / 4);
    if (!bytes.empty()) std::memcpy(words.data(), bytes.data(), bytes.size());
    check_bounds(programs::program_from_spirv("s.spv", std::move(words), kSmall));
  });
}

void run_light_glsl(Bytes bytes) {
  read([&] { check_bounds(programs::program_from_glsl("s.glsl", std::string(text_of(bytes)), kSmall)); });
}

namespace {

/// Nodes that bytes say: an operation, then how far back its operands are among the nodes of their types.
class NodesOfBytes {
 public:
  explicit NodesOfBytes(Bytes bytes) : rest_(bytes), builder_("nodes", 4 * kMostNodes) {
    for (const Given& g : kGiven) {
      const auto rate =
          std::string_view(g.name).starts_with("light.") ? programs::Rate::light : programs::Rate::surface;
      add(builder_.input(g.name, programs::Type::f32, rate));
    }
    add(builder_.integer(1)), add(builder_.truth(true));
    for (size_t count = 0; !rest_.empty() && count < kMostNodes; ++count) add(next_node());
  }

  programs::Program program() {
    programs::Program& out = builder_.program();
    const std::vector<programs::NodeId>& numbers = of_type_[size_t(programs::Type::f32)];
    for (size_t k = 0; k < 3; ++k) {
      out.output[programs::kLightOutput + k] = numbers[numbers.size() - 1 - k];
      out.output[programs::kStartOutput + k] = builder_.number(0.0f);
      out.output[programs::kFinishOutput + k] =
          builder_.input(std::string("sum.") + "xyz"[k], programs::Type::f32, programs::Rate::sum);
    }
    out.output[programs::kReachesOutput] = builder_.word(1);
    out.output[programs::kFinishOutput + 3] = builder_.number(1.0f);
    programs::Program made = programs::without_dead_nodes(out);
    programs::set_rates(made);
    promise(programs::fault_of_outputs(made).empty(), "light() of nodes reads no sum");
    return made;
  }

 private:
  static constexpr size_t kMostNodes = 400;

  uint8_t byte() {
    if (rest_.empty()) return 0;
    const uint8_t first = rest_[0];
    rest_ = rest_.subspan(1);
    return first;
  }
  void add(programs::NodeId id) {
    programs::Type type = builder_.node(id).type;
    if (type == programs::Type::u32) type = programs::Type::i32;  // one is as good as the other
    of_type_[size_t(type)].push_back(id);
  }
  programs::NodeId one_of(programs::Type type) {
    if (type == programs::Type::u32) type = programs::Type::i32;
    const std::vector<programs::NodeId>& all = of_type_[size_t(type)];
    return all[all.size() - 1 - byte() % all.size()];
  }
  programs::NodeId next_node() {
    const auto op = programs::Op(byte() % programs::kOpCount);
    if (op == programs::Op::constant || op == programs::Op::input) {
      uint32_t bits = 0;
      for (int k = 0; k < 4; ++k) bits = bits << 8 | byte();
      return builder_.constant(op == programs::Op::constant ? programs::Type::f32 : programs::Type::i32, bits);
    }
    if (op == programs::Op::select) {
      const auto type = programs::Type(byte() % 2);
      const programs::NodeId condition = one_of(programs::Type::boolean), a = one_of(type);
      return builder_.select(condition, a, one_of(type));
    }
    const programs::OpInfo& of = programs::info(op);
    programs::NodeId operand[3] = {programs::kNoNode, programs::kNoNode, programs::kNoNode};
    for (int k = 0; k < of.operands; ++k) operand[k] = one_of(of.operand[k]);
    return builder_.make(op, operand[0], operand[1], operand[2]);
  }

  Bytes rest_;
  programs::NodeBuilder builder_;
  std::vector<programs::NodeId> of_type_[4];
};

}  // namespace

void run_light_nodes(Bytes bytes) {
  read([&] { check_bounds(NodesOfBytes(bytes).program()); });
}

}  // namespace trueshade::fuzz
