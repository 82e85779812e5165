#include "oracle/spirv_interpreter.h"

#include <algorithm>
#include <stdexcept>

#include "oracle/spirv_opcodes.h"
#include "oracle/spirv_operations.h"

namespace trueshade::oracle {

namespace {

using Kind = SpirvType::Kind;
using SpirvWords = std::vector<uint32_t>;

constexpr uint32_t kUniform = 2, kStorageBuffer = 12;  ///< storage classes

/// One run of one module.
class SpirvRun {
 public:
  SpirvRun(const SpirvModule& module, uint64_t most_steps) : module_(module), steps_left_(most_steps) {}

  SpirvScalars run(const SpirvScalars& inputs) {
    globals_.resize(module_.bound);
    for (const SpirvInstruction& variable : module_.variables) {
      globals_[variable.result] = variable_of(variable, globals_);
      if (is_block(variable)) read_block(variable, inputs);
    }
    call(module_.entry_point, {});
    SpirvScalars outputs;
    for (const SpirvInstruction& variable : module_.variables)
      if (is_block(variable)) write_block(variable, outputs);
    return outputs;
  }

 private:
  using Values = std::vector<SpirvValue>;

  static bool is_block(const SpirvInstruction& variable) {
    return variable.operands[0] == kUniform || variable.operands[0] == kStorageBuffer;
  }

  bool is_storage(const SpirvInstruction& variable) const {
    return variable.operands[0] == kStorageBuffer ||
           module_.buffer_blocks.contains(module_.type(variable.type).element);
  }

  /// A pointer to a new cell of memory.
  SpirvValue variable_of(const SpirvInstruction& variable, const Values& values) {
    SpirvWords cell(module_.type(module_.type(variable.type).element).scalars, 0);
    if (variable.operands.size() > 1) cell = value(values, variable.operands[1]).scalars;
    memory_.push_back(cell);
    return {variable.type, {uint32_t(memory_.size() - 1), 0}};
  }

  std::string name_of(const SpirvType& type, uint32_t type_id, uint32_t part) const {
    if (type.kind != Kind::structure) return "[" + std::to_string(part) + "]";
    return "." + module_.member_names.at(type_id).at(part);
  }

  /// Fills the scalars of a type, from `cell[at]` on, with the input of that name, or with those of its members.
  /// False where a part has none.
  bool fill(const SpirvScalars& inputs, const std::string& name, uint32_t type_id, SpirvWords& cell, size_t at) {
    const SpirvType& type = module_.type(type_id);
    if (const auto given = inputs.find(name); given != inputs.end()) {
      if (given->second.size() != type.scalars) throw std::runtime_error("input " + name + " is of another length");
      std::copy(given->second.begin(), given->second.end(), cell.begin() + std::ptrdiff_t(at));
      return true;
    }
    if (type.kind != Kind::structure && type.kind != Kind::array) return false;
    const size_t parts = type.kind == Kind::structure ? type.members.size() : type.count;
    for (uint32_t part = 0; part < parts; ++part)
      if (!fill(inputs, name + name_of(type, type_id, part), SpirvModule::part_type(type, part), cell,
                at + module_.offset(type, part)))
        return false;
    return true;
  }

  void read_block(const SpirvInstruction& variable, const SpirvScalars& inputs) {
    const uint32_t block = module_.type(variable.type).element;
    SpirvWords& cell = memory_[globals_[variable.result].scalars[0]];
    const std::string& name = module_.names.at(block);
    if (!fill(inputs, name, block, cell, 0) && !is_storage(variable))
      throw std::runtime_error("block " + name + " lacks an input");
  }

  void write_block(const SpirvInstruction& variable, SpirvScalars& outputs) {
    if (!is_storage(variable)) return;
    const uint32_t block = module_.type(variable.type).element;
    const SpirvType& type = module_.type(block);
    const SpirvWords& cell = memory_[globals_[variable.result].scalars[0]];
    for (uint32_t member = 0; member < type.members.size(); ++member) {
      const auto from = cell.begin() + std::ptrdiff_t(module_.offset(type, member));
      outputs[module_.names.at(block) + name_of(type, block, member)] =
          SpirvWords(from, from + std::ptrdiff_t(module_.type(type.members[member]).scalars));
    }
  }

  const SpirvValue& value(const Values& values, uint32_t id) const {
    if (values[id].type != 0) return values[id];
    if (globals_[id].type != 0) return globals_[id];
    const auto constant = module_.constants.find(id);
    if (constant == module_.constants.end()) throw std::runtime_error("SPIR-V: an id has no value");
    return constant->second;
  }

  SpirvWords call(uint32_t id, const Values& arguments) {
    if (++depth_ > 1000) throw std::runtime_error("SPIR-V: calls are too deep");
    const SpirvFunction& function = module_.functions.at(id);
    const size_t memory_before = memory_.size();
    Values values(module_.bound);
    for (size_t i = 0; i < arguments.size(); ++i) values[function.parameters[i]] = arguments[i];
    SpirvWords result = run_body(function, values);
    memory_.resize(memory_before);
    --depth_;
    return result;
  }

  SpirvWords run_body(const SpirvFunction& function, Values& values) {
    using namespace spirv;
    uint32_t block = 0, block_before = 0;
    for (size_t pc = 0;;) {
      if (steps_left_-- == 0) throw std::runtime_error("SPIR-V: the program does not end");
      const SpirvInstruction& i = function.body[pc++];
      uint32_t target = 0;
      switch (i.opcode) {
        case OpLabel:
          block_before = block, block = i.result;
          run_phis(function, pc, block_before, values);
          break;
        case OpBranch:
          target = i.operands[0];
          break;
        case OpBranchConditional:
          target = value(values, i.operands[0]).scalars[0] != 0 ? i.operands[1] : i.operands[2];
          break;
        case OpSwitch:
          target = switch_target(i, value(values, i.operands[0]).scalars[0]);
          break;
        case OpReturn:
          return {};
        case OpReturnValue:
          return value(values, i.operands[0]).scalars;
        case OpUnreachable:
          throw std::runtime_error("SPIR-V: what is unreachable was reached");
        default:
          run_instruction(i, values);
      }
      if (target != 0) pc = function.label_places.at(target);
    }
  }

  static uint32_t switch_target(const SpirvInstruction& i, uint32_t selector) {
    for (size_t at = 2; at + 1 < i.operands.size(); at += 2)
      if (i.operands[at] == selector) return i.operands[at + 1];
    return i.operands[1];
  }

  /// All the phis that start a block, as at once.
  void run_phis(const SpirvFunction& function, size_t& pc, uint32_t block_before, Values& values) {
    std::vector<std::pair<uint32_t, SpirvValue>> chosen;
    for (; function.body[pc].opcode == spirv::OpPhi || function.body[pc].opcode == spirv::OpLine ||
           function.body[pc].opcode == spirv::OpNoLine;
         ++pc) {
      const SpirvInstruction& phi = function.body[pc];
      if (phi.opcode != spirv::OpPhi) continue;
      for (size_t at = 0; at + 1 < phi.operands.size(); at += 2)
        if (phi.operands[at + 1] == block_before) chosen.emplace_back(phi.result, value(values, phi.operands[at]));
    }
    for (const auto& [id, phi_value] : chosen) values[id] = phi_value;
  }

  SpirvWords load(const SpirvValue& pointer) const {
    const size_t scalars = module_.type(module_.type(pointer.type).element).scalars;
    const auto from = memory_[pointer.scalars[0]].begin() + std::ptrdiff_t(pointer.scalars[1]);
    return SpirvWords(from, from + std::ptrdiff_t(scalars));
  }

  void store(const SpirvValue& pointer, const SpirvWords& scalars) {
    std::copy(scalars.begin(), scalars.end(), memory_[pointer.scalars[0]].begin() + std::ptrdiff_t(pointer.scalars[1]));
  }

  /// An index is an unsigned number, and one beyond the last part is the last.
  static uint32_t index_within(const SpirvType& type, uint32_t index) {
    return type.kind == Kind::structure ? index : std::min(index, type.count - 1);
  }

  SpirvValue access(const SpirvInstruction& i, const Values& values) const {
    SpirvValue pointer = value(values, i.operands[0]);
    uint32_t type_id = module_.type(pointer.type).element;
    for (size_t at = 1; at < i.operands.size(); ++at) {
      const SpirvType& type = module_.type(type_id);
      const uint32_t index = index_within(type, value(values, i.operands[at]).scalars[0]);
      pointer.scalars[1] += uint32_t(module_.offset(type, index));
      type_id = SpirvModule::part_type(type, index);
    }
    pointer.type = i.type;
    return pointer;
  }

  /// Where the part that literal indices name starts in a composite, and the id of its type.
  std::pair<size_t, uint32_t> part(uint32_t type_id, const SpirvWords& operands, size_t first) const {
    size_t offset = 0;
    for (size_t at = first; at < operands.size(); ++at) {
      const SpirvType& type = module_.type(type_id);
      offset += module_.offset(type, operands[at]);
      type_id = SpirvModule::part_type(type, operands[at]);
    }
    return {offset, type_id};
  }

  SpirvWords shuffle(const SpirvInstruction& i, const Values& values) const {
    SpirvWords both = value(values, i.operands[0]).scalars;
    const SpirvWords& second = value(values, i.operands[1]).scalars;
    both.insert(both.end(), second.begin(), second.end());
    SpirvWords chosen;
    for (size_t at = 2; at < i.operands.size(); ++at)
      chosen.push_back(i.operands[at] == 0xFFFFFFFF ? 0 : both.at(i.operands[at]));
    return chosen;
  }

  /// The values of operands from the one at `first` on.
  Values operands_of(const SpirvInstruction& i, const Values& values, size_t first) const {
    Values operands;
    for (size_t at = first; at < i.operands.size(); ++at) operands.push_back(value(values, i.operands[at]));
    return operands;
  }

  SpirvWords extended(const SpirvInstruction& i, const Values& values) {
    if (module_.extension_sets.at(i.operands[0]) != "GLSL.std.450")
      throw std::runtime_error("SPIR-V: only GLSL.std.450 is known");
    const uint32_t function = i.operands[1];
    const Values operands = operands_of(i, values, 2);
    SpirvWords result = glsl_function(function, operands);
    if (function != spirv::Modf && function != spirv::Frexp) return result;
    const auto half = std::ptrdiff_t(result.size() / 2);  // the second half goes through a pointer
    store(operands[1], SpirvWords(result.begin() + half, result.end()));
    result.resize(size_t(half));
    return result;
  }

  void run_instruction(const SpirvInstruction& i, Values& values) {
    using namespace spirv;
    switch (i.opcode) {
      case OpLine:
      case OpNoLine:
      case OpNop:
      case OpLoopMerge:
      case OpSelectionMerge:
        return;
      case OpStore:
        store(value(values, i.operands[0]), value(values, i.operands[1]).scalars);
        return;
      case OpCopyMemory:
        store(value(values, i.operands[0]), load(value(values, i.operands[1])));
        return;
      case OpVariable:
        values[i.result] = variable_of(i, values);
        return;
      case OpAccessChain:
      case OpInBoundsAccessChain:
        values[i.result] = access(i, values);
        return;
      default:
        values[i.result] = {i.type, result_of(i, values)};
    }
  }

  SpirvWords result_of(const SpirvInstruction& i, Values& values) {
    using namespace spirv;
    switch (i.opcode) {
      case OpFunctionCall:
        return call(i.operands[0], operands_of(i, values, 1));
      case OpExtInst:
        return extended(i, values);
      case OpLoad:
        return load(value(values, i.operands[0]));
      case OpUndef:
        return SpirvWords(module_.type(i.type).scalars, 0);
      case OpCopyObject:
      case OpCopyLogical:
        return value(values, i.operands[0]).scalars;
      case OpVectorShuffle:
        return shuffle(i, values);
      case OpCompositeConstruct: {
        SpirvWords all;
        for (const SpirvValue& one : operands_of(i, values, 0))
          all.insert(all.end(), one.scalars.begin(), one.scalars.end());
        return all;
      }
      case OpCompositeExtract: {
        const SpirvValue& composite = value(values, i.operands[0]);
        const auto [offset, type_id] = part(composite.type, i.operands, 1);
        const auto from = composite.scalars.begin() + std::ptrdiff_t(offset);
        return SpirvWords(from, from + std::ptrdiff_t(module_.type(type_id).scalars));
      }
      case OpCompositeInsert: {
        SpirvValue composite = value(values, i.operands[1]);
        const SpirvWords& object = value(values, i.operands[0]).scalars;
        const size_t offset = part(composite.type, i.operands, 2).first;
        std::copy(object.begin(), object.end(), composite.scalars.begin() + std::ptrdiff_t(offset));
        return composite.scalars;
      }
      case OpVectorExtractDynamic: {
        const SpirvValue& vector = value(values, i.operands[0]);
        return {vector.scalars[index_within(module_.type(vector.type), value(values, i.operands[1]).scalars[0])]};
      }
      case OpVectorInsertDynamic: {
        SpirvValue vector = value(values, i.operands[0]);
        const uint32_t index = index_within(module_.type(vector.type), value(values, i.operands[2]).scalars[0]);
        vector.scalars[index] = value(values, i.operands[1]).scalars[0];
        return vector.scalars;
      }
      default:
        return spirv_operation(module_, i, operands_of(i, values, 0));
    }
  }

  const SpirvModule& module_;
  uint64_t steps_left_;
  int depth_ = 0;
  std::vector<SpirvWords> memory_;  ///< a cell a variable
  Values globals_;                  ///< pointers to variables outside functions
};

}  // namespace

SpirvScalars run_spirv(const SpirvModule& module, const SpirvScalars& inputs, uint64_t most_steps) {
  return SpirvRun(module, most_steps).run(inputs);
}

}  // namespace trueshade::oracle
