#include "judge/diagnosis/plain_program.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <set>
#include <string_view>

#include "programs/front/light_program.h"

namespace trueshade::oracle {

namespace {

using programs::NodeId;
using programs::Op;
using programs::ProgramNode;
using programs::Rate;

/// A constant as a number, by its type.
double constant_of(const ProgramNode& node) {
  if (node.type == programs::Type::f32) return double(std::bit_cast<float>(node.bits));
  return node.type == programs::Type::i32 ? double(int32_t(node.bits)) : double(node.bits);
}

/// The surface as captured_surface.h has it, without errors.
ShadedSurface shaded(const PlainSurface& p) {
  ShadedSurface s;
  for (size_t k = 0; k < 3; ++k) {
    s.position[k].value = p.position[k], s.normal[k].value = p.normal[k];
    s.specular[k].value = p.specular[k], s.emission[k].value = p.emission[k];
  }
  for (size_t k = 0; k < 4; ++k) s.albedo[k].value = p.albedo[k];
  s.shininess = p.shininess, s.ambient_share.value = p.ambient_share;
  for (size_t k = 0; k < 2; ++k) s.uv[k].value = p.uv[k];
  s.object = p.object, s.material = p.material, s.pixel = p.pixel;
  return s;
}

}  // namespace

PlainProgram::PlainProgram(const Scene& scene, const Pipeline& pipeline)
    : PlainProgram(scene, pipeline, *programs::kept_program(pipeline.light_program.file, pipeline.light_program.text)) {
}

PlainProgram::PlainProgram(const Scene& scene, const Pipeline& pipeline, programs::Program program)
    : program_(std::move(program)), first_(program_.nodes.size(), 0) {
  for (NodeId id = 0; id < program_.nodes.size(); ++id) {
    const ProgramNode& node = program_.nodes[id];
    const std::string name = node.op == Op::input ? program_.inputs[node.bits].name : "";
    if (node.op == Op::constant) {
      first_[id] = constant_of(node);
    } else if (node.op == Op::input && node.rate == Rate::surface) {
      surface_inputs_.emplace_back(id, surface_field(name));
    } else if (node.op == Op::input && node.rate == Rate::light) {
      light_inputs_.emplace_back(id, light_field(name));
    } else if (node.op == Op::input && node.rate == Rate::sum) {
      sum_inputs_.emplace_back(id, component_of(name));
    } else if (node.op == Op::input && name.starts_with("view.eye")) {
      eye_inputs_.emplace_back(id, component_of(name));
    } else if (node.op == Op::input) {
      first_[id] = frame_field(name, scene, pipeline).value;
    } else {
      std::vector<NodeId>* const lists[] = {&of_frame_, &of_light_, &of_surface_, &of_light_, &of_sum_};
      lists[size_t(node.rate)]->push_back(id);
    }
  }
  of_type_.fill(of_light_);
  std::set<LightType> types;
  for (const Light& light : scene.lights) types.insert(light.type);
  for (const LightType type : types) find_needed(type);
}

/// Drops from of_type_[type] the nodes that light() does not need of such a light.
void PlainProgram::find_needed(LightType type) {
  std::vector<bool> known(program_.nodes.size()), needed(program_.nodes.size());
  Values values = first_;
  for (NodeId id = 0; id < known.size(); ++id) {
    const ProgramNode& node = program_.nodes[id];
    if (node.op == Op::input) {
      known[id] = program_.inputs[node.bits].name == "light.type";
      values[id] = double(type);
    } else if (const auto operands = node.operands(); node.op == Op::constant || !operands.empty()) {
      known[id] = std::all_of(operands.begin(), operands.end(), [&](NodeId operand) { return bool(known[operand]); });
      if (known[id] && node.op != Op::constant) values[id] = computed(node, values);
    }
  }
  for (int output = programs::kLightOutput; output < programs::kLightOutput + 3; ++output)
    needed[program_.output[size_t(output)]] = true;
  for (NodeId id = NodeId(needed.size()); id-- > 0;) {
    const ProgramNode& node = program_.nodes[id];
    if (!needed[id] || node.op == Op::input || node.op == Op::constant) continue;
    const bool is_decided = node.op == Op::select && known[node.operand[0]];
    const size_t taken = is_decided && values[node.operand[0]] != 0 ? 1 : 2;
    for (size_t k = 0; k < node.operands().size(); ++k)
      if (!is_decided || k == 0 || k == taken) needed[node.operand[k]] = true;
  }
  std::erase_if(of_type_[size_t(type)], [&](NodeId id) { return !needed[id]; });
}

/// The value of a node, whose operands have theirs.
double PlainProgram::computed(const ProgramNode& node, const Values& values) const {
  const auto at = [&](size_t k) { return values[node.operand[k]]; };
  switch (node.op) {
    case Op::f_add:
      return at(0) + at(1);
    case Op::f_sub:
      return at(0) - at(1);
    case Op::f_mul:
      return at(0) * at(1);
    case Op::f_div:
      return at(0) / at(1);
    case Op::f_sqrt:
      return std::sqrt(at(0));
    case Op::f_inverse_sqrt:
      return 1 / std::sqrt(at(0));
    case Op::f_neg:
      return -at(0);
    case Op::f_min:
      return at(0) < at(1) ? at(0) : at(1);
    case Op::f_max:
      return at(0) > at(1) ? at(0) : at(1);
    case Op::f_lt:
      return at(0) < at(1) ? 1 : 0;
    case Op::f_le:
      return at(0) <= at(1) ? 1 : 0;
    case Op::select:
      return at(0) != 0 ? at(1) : at(2);
    case Op::pow:
      return std::pow(at(0), at(1));
    default: {
      Interval x[3];
      for (size_t k = 0; k < node.operands().size(); ++k) x[k] = Interval::of(at(k));
      return IntervalArithmetic({})(node, x[0], x[1], x[2]).value;
    }
  }
}

void PlainProgram::run(const std::vector<NodeId>& nodes, Values& values) const {
  for (const NodeId id : nodes) values[id] = computed(program_.nodes[id], values);
}

void PlainProgram::look_at(const PlainSurface& surface, const Camera& camera, Values& values) const {
  look_at(shaded(surface), camera, values);
}

void PlainProgram::look_at(const ShadedSurface& seen, const Camera& camera, Values& values) const {
  values = first_;
  for (const auto& [id, c] : eye_inputs_) values[id] = double(camera.eye[int(c)]);
  run(of_frame_, values);
  for (const auto& [id, field] : surface_inputs_) values[id] = field.at(seen).value;
  run(of_surface_, values);
}

Triple3 PlainProgram::term(const Light& light, uint32_t index, Values& values) const {
  for (const auto& [id, field] : light_inputs_) values[id] = field.at(light, index).value;
  run(of_type_[size_t(light.type)], values);
  return three(programs::kLightOutput, values);
}

std::array<double, 4> PlainProgram::finish(const Triple3& sum, Values& values) const {
  for (const auto& [id, c] : sum_inputs_) values[id] = sum[c];
  run(of_sum_, values);
  std::array<double, 4> out;
  for (size_t k = 0; k < 4; ++k) out[k] = values[program_.output[size_t(programs::kFinishOutput) + k]];
  return out;
}

Triple3 PlainProgram::three(int output, const Values& values) const {
  Triple3 out;
  for (size_t k = 0; k < 3; ++k) out[k] = values[program_.output[size_t(output) + k]];
  return out;
}

}  // namespace trueshade::oracle
