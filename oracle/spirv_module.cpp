#include "oracle/spirv_module.h"

#include <stdexcept>

#include "oracle/spirv_opcodes.h"

namespace trueshade::oracle {

namespace {

using Kind = SpirvType::Kind;

std::runtime_error unknown(const std::string& what) { return std::runtime_error("SPIR-V: " + what); }

/// Which of the two leading operands an opcode has.
enum class Leading { none, result, type_and_result };

Leading leading(uint32_t opcode) {
  using namespace spirv;
  switch (opcode) {
    case OpNop:
    case OpSourceContinued:
    case OpSource:
    case OpSourceExtension:
    case OpName:
    case OpMemberName:
    case OpLine:
    case OpExtension:
    case OpMemoryModel:
    case OpEntryPoint:
    case OpExecutionMode:
    case OpCapability:
    case OpFunctionEnd:
    case OpStore:
    case OpCopyMemory:
    case OpDecorate:
    case OpMemberDecorate:
    case OpLoopMerge:
    case OpSelectionMerge:
    case OpBranch:
    case OpBranchConditional:
    case OpSwitch:
    case OpReturn:
    case OpReturnValue:
    case OpUnreachable:
    case OpNoLine:
    case OpModuleProcessed:
      return Leading::none;
    case OpString:
    case OpExtInstImport:
    case OpTypeVoid:
    case OpTypeBool:
    case OpTypeInt:
    case OpTypeFloat:
    case OpTypeVector:
    case OpTypeMatrix:
    case OpTypeArray:
    case OpTypeStruct:
    case OpTypePointer:
    case OpTypeFunction:
    case OpLabel:
      return Leading::result;
    case OpUndef:
    case OpExtInst:
    case OpFunction:
    case OpFunctionParameter:
    case OpFunctionCall:
    case OpVariable:
    case OpLoad:
    case OpAccessChain:
    case OpInBoundsAccessChain:
    case OpBitcast:
    case OpPhi:
    case OpCopyLogical:
      return Leading::type_and_result;
    default:
      break;
  }
  const bool constant = (opcode >= OpConstantTrue && opcode <= OpConstantComposite) || opcode == OpConstantNull ||
                        (opcode >= OpSpecConstantTrue && opcode <= OpSpecConstantComposite);
  const bool composite = opcode >= OpVectorExtractDynamic && opcode <= OpTranspose;
  const bool arithmetic = (opcode >= OpConvertFToU && opcode <= OpConvertUToF) ||
                          (opcode >= OpSNegate && opcode <= OpSMulExtended) || (opcode >= OpAny && opcode <= OpIsInf);
  const bool logic = (opcode >= OpLogicalEqual && opcode <= OpFUnordGreaterThanEqual) ||
                     (opcode >= OpShiftRightLogical && opcode <= OpBitCount);
  if (constant || composite || arithmetic || logic) return Leading::type_and_result;
  throw unknown("opcode " + std::to_string(opcode) + " is none of a light program's");
}

SpirvInstruction instruction(std::span<const uint32_t> words) {
  SpirvInstruction made;
  made.opcode = words[0] & 0xFFFF;
  const Leading has = leading(made.opcode);
  size_t at = 1;
  if (has == Leading::type_and_result) made.type = words[at++];
  if (has != Leading::none) made.result = words[at++];
  made.operands.assign(words.begin() + std::ptrdiff_t(at), words.end());
  return made;
}

/// The text that starts at a word, four characters a word, the lowest byte first, up to a 0.
std::string text_at(const std::vector<uint32_t>& operands, size_t at) {
  std::string text;
  for (; at < operands.size(); ++at)
    for (int shift = 0; shift < 32; shift += 8) {
      const char c = char(operands[at] >> shift & 0xFF);
      if (c == 0) return text;
      text += c;
    }
  return text;
}

void read_type(SpirvModule& module, const SpirvInstruction& i) {
  using namespace spirv;
  SpirvType type;
  switch (i.opcode) {
    case OpTypeVoid:
      break;
    case OpTypeFunction:
      type.kind = Kind::function;
      break;
    case OpTypeBool:
      type.kind = Kind::boolean, type.scalars = 1;
      break;
    case OpTypeInt:
    case OpTypeFloat:
      if (i.operands[0] != 32) throw unknown("only numbers of 32 bits are known");
      type.kind = i.opcode == OpTypeInt ? Kind::integer : Kind::real, type.scalars = 1;
      type.is_signed = i.opcode == OpTypeInt && i.operands[1] != 0;
      break;
    case OpTypeVector:
    case OpTypeMatrix:
      type.kind = i.opcode == OpTypeVector ? Kind::vector : Kind::matrix;
      type.element = i.operands[0], type.count = i.operands[1];
      type.scalars = type.count * module.type(type.element).scalars;
      break;
    case OpTypeArray:
      type.kind = Kind::array, type.element = i.operands[0];
      type.count = module.constants.at(i.operands[1]).scalars[0];
      type.scalars = type.count * module.type(type.element).scalars;
      break;
    case OpTypeStruct:
      type.kind = Kind::structure, type.members = i.operands;
      for (const uint32_t member : type.members) type.scalars += module.type(member).scalars;
      break;
    case OpTypePointer:
      type.kind = Kind::pointer, type.element = i.operands[1], type.scalars = 2;
      break;
    default:
      return;
  }
  module.types[i.result] = type;
}

void read_constant(SpirvModule& module, const SpirvInstruction& i) {
  using namespace spirv;
  SpirvValue value{i.type, {}};
  switch (i.opcode) {
    case OpConstantTrue:
    case OpSpecConstantTrue:
      value.scalars = {1};
      break;
    case OpConstantFalse:
    case OpSpecConstantFalse:
      value.scalars = {0};
      break;
    case OpConstant:
    case OpSpecConstant:
      value.scalars = {i.operands[0]};
      break;
    case OpConstantComposite:
    case OpSpecConstantComposite:
      for (const uint32_t part : i.operands) {
        const std::vector<uint32_t>& more = module.constants.at(part).scalars;
        value.scalars.insert(value.scalars.end(), more.begin(), more.end());
      }
      break;
    case OpConstantNull:
    case OpUndef:
      value.scalars.assign(module.type(i.type).scalars, 0);
      break;
    default:
      return;
  }
  module.constants[i.result] = value;
}

constexpr uint32_t kBufferBlock = 3;  ///< a decoration

/// All that stands before the first function.
void read_declaration(SpirvModule& module, const SpirvInstruction& i) {
  using namespace spirv;
  read_type(module, i);
  read_constant(module, i);
  if (i.opcode == OpName) module.names[i.operands[0]] = text_at(i.operands, 1);
  if (i.opcode == OpMemberName) module.member_names[i.operands[0]][i.operands[1]] = text_at(i.operands, 2);
  if (i.opcode == OpExtInstImport) module.extension_sets[i.result] = text_at(i.operands, 0);
  if (i.opcode == OpEntryPoint) module.entry_point = i.operands[1];
  if (i.opcode == OpVariable) module.variables.push_back(i);
  if (i.opcode == OpDecorate && i.operands[1] == kBufferBlock) module.buffer_blocks.insert(i.operands[0]);
}

}  // namespace

const SpirvType& SpirvModule::type(uint32_t id) const {
  const auto found = types.find(id);
  if (found == types.end()) throw unknown("no type has the id " + std::to_string(id));
  return found->second;
}

uint32_t SpirvModule::part_type(const SpirvType& aggregate, uint32_t index) {
  return aggregate.kind == Kind::structure ? aggregate.members.at(index) : aggregate.element;
}

size_t SpirvModule::offset(const SpirvType& aggregate, uint32_t index) const {
  if (aggregate.kind != Kind::structure) return index * type(aggregate.element).scalars;
  size_t offset = 0;
  for (uint32_t before = 0; before < index; ++before) offset += type(aggregate.members[before]).scalars;
  return offset;
}

SpirvModule spirv_module(std::span<const uint32_t> words) {
  if (words.size() < 5 || words[0] != 0x07230203) throw unknown("the words do not start a module");
  SpirvModule module;
  module.bound = words[3];
  SpirvFunction* function = nullptr;
  for (size_t at = 5; at < words.size();) {
    const size_t length = words[at] >> 16;
    if (length == 0 || at + length > words.size()) throw unknown("an instruction's length is wrong");
    const SpirvInstruction i = instruction(words.subspan(at, length));
    at += length;
    if (i.opcode == spirv::OpFunction) {
      function = &module.functions[i.result];
    } else if (i.opcode == spirv::OpFunctionEnd) {
      function = nullptr;
    } else if (function == nullptr) {
      read_declaration(module, i);
    } else if (i.opcode == spirv::OpFunctionParameter) {
      function->parameters.push_back(i.result);
    } else {
      if (i.opcode == spirv::OpLabel) function->label_places[i.result] = function->body.size();
      function->body.push_back(i);
    }
  }
  if (function != nullptr) throw unknown("the module ends within a function");
  if (module.entry_point == 0) throw unknown("the module has no entry point");
  return module;
}

}  // namespace trueshade::oracle
