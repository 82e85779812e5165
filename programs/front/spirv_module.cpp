#include "programs/front/spirv_module.h"

#include <spirv-tools/libspirv.h>

#include <algorithm>
#include <utility>

#include "core/printable_text.h"

namespace trueshade::programs {

void refuse(std::string reason, std::string remedy) { throw Refusal{std::move(reason), std::move(remedy)}; }
void refuse_damage(std::string reason) { refuse("the SPIR-V is damaged: " + std::move(reason), "compile it again"); }

std::string name_of_opcode(uint32_t opcode) {
  const char* name = spvOpcodeString(opcode);
  return name == nullptr || std::string(name) == "unknown" ? "instruction " + std::to_string(opcode)
                                                           : "Op" + std::string(name);
}

uint32_t SpirvInstruction::word(size_t i) const {
  if (i >= operands.size()) refuse_damage(name_of_opcode(opcode) + " ends early");
  return operands[i];
}

std::string SpirvInstruction::text(size_t first) const {
  std::string out;
  for (size_t i = first; i < operands.size(); ++i)
    for (int shift = 0; shift < 32; shift += 8) {
      const char c = char(operands[i] >> shift & 255);
      if (c == 0) return printable(out, Lines::one);
      out += c;
    }
  return printable(out, Lines::one);
}

uint32_t SpirvModule::checked(uint32_t id) const {
  if (id == 0 || id >= bound) refuse_damage("id " + std::to_string(id) + " is out of bounds");
  return id;
}

const SpirvType& SpirvModule::type(uint32_t id) const {
  const auto found = types.find(id);
  if (found == types.end()) refuse_damage("id " + std::to_string(id) + " is no type");
  return found->second;
}

std::string SpirvModule::name(uint32_t id) const {
  const auto found = names.find(id);
  return found == names.end() ? "" : found->second;
}

namespace {

/// Reads a module's instructions in order.
class ModuleReader {
 public:
  explicit ModuleReader(std::vector<uint32_t> words) { m_.words = std::move(words); }

  SpirvModule read() {
    read_header();
    split();
    m_.precise.resize(m_.bound);
    for (at_ = 0; at_ < m_.instructions.size(); ++at_) {
      const SpirvInstruction& one = m_.instructions[at_];
      if (function_ != nullptr)
        in_function(one);
      else
        outside(one);
    }
    if (function_ != nullptr) refuse_damage("a function does not end");
    if (m_.entry_function == 0) refuse("has no entry point for a compute shader", "name one, with the model GLCompute");
    return std::move(m_);
  }

 private:
  void read_header() {
    if (m_.words.size() < 5 || m_.words[0] != kSpirvMagic) refuse("is no SPIR-V", "give GLSL as .glsl, SPIR-V as .spv");
    m_.bound = m_.words[3];
    if (m_.bound == 0 || m_.bound > m_.words.size() + 1024) refuse_damage("its bound of ids says more than it has");
  }

  void split() {
    uint32_t line = 0;
    for (size_t i = 5; i < m_.words.size();) {
      const uint32_t count = m_.words[i] >> 16, opcode = m_.words[i] & 0xFFFF;
      if (count == 0 || count > m_.words.size() - i) refuse_damage("an instruction has no end");
      const SpirvInstruction one{opcode, std::span(m_.words).subspan(i + 1, count - 1)};
      i += count;
      if (one.op() == SpirvOp::kLine) line = one.word(1);
      if (one.op() == SpirvOp::kNoLine || one.op() == SpirvOp::kFunctionEnd) line = 0;
      if (one.op() == SpirvOp::kLine || one.op() == SpirvOp::kNoLine || one.op() == SpirvOp::kNop) continue;
      m_.instructions.push_back(one);
      m_.line.push_back(line);
    }
  }

  void outside(const SpirvInstruction& one) {
    switch (one.op()) {
      case SpirvOp::kSourceContinued:
      case SpirvOp::kSource:
      case SpirvOp::kSourceExtension:
      case SpirvOp::kString:
      case SpirvOp::kExtension:
      case SpirvOp::kExecutionMode:
      case SpirvOp::kExecutionModeId:
      case SpirvOp::kModuleProcessed:
      case SpirvOp::kMemberDecorate:
      case SpirvOp::kDecorateId:
      case SpirvOp::kDecorateString:
      case SpirvOp::kMemberDecorateString:
      case SpirvOp::kCapability:  // what it allows is refused where it stands
        return;
      case SpirvOp::kName:
        m_.names[m_.checked(one.word(0))] = one.text(1);
        return;
      case SpirvOp::kMemberName:
        m_.member_names[m_.checked(one.word(0))][one.word(1)] = one.text(2);
        return;
      case SpirvOp::kDecorate:
        if (one.word(1) == kDecorationNoContraction) m_.precise[m_.checked(one.word(0))] = true;
        return;
      case SpirvOp::kExtInstImport:
        if (one.text(1) == "GLSL.std.450") {
          m_.glsl_functions = m_.checked(one.word(0));
          return;
        }
        if (one.text(1).starts_with("NonSemantic.")) return;
        refuse("imports the instructions " + one.text(1), "use those of GLSL.std.450");
      case SpirvOp::kMemoryModel:
        if (one.word(0) != 0) refuse("has physical addresses", "use logical ones");
        return;
      case SpirvOp::kEntryPoint:
        if (one.word(0) != kModelGlCompute || m_.entry_function != 0)
          refuse("has an entry point besides that of a compute shader", "leave it one");
        m_.entry_function = m_.checked(one.word(1));
        return;
      case SpirvOp::kExtInst:  // non-semantic ones stand outside functions
        return;
      case SpirvOp::kFunction:
        begin_function(one);
        return;
      default:
        declaration(one);
    }
  }

  void declaration(const SpirvInstruction& one) {
    switch (one.op()) {
      case SpirvOp::kTypeVoid:
      case SpirvOp::kTypeBool:
      case SpirvOp::kTypeInt:
      case SpirvOp::kTypeFloat:
      case SpirvOp::kTypeVector:
      case SpirvOp::kTypeMatrix:
      case SpirvOp::kTypeArray:
      case SpirvOp::kTypeStruct:
      case SpirvOp::kTypePointer:
      case SpirvOp::kTypeFunction:
        return declare_type(m_, one, integers_);
      case SpirvOp::kConstant:
      case SpirvOp::kSpecConstant:
        integers_[m_.checked(one.word(1))] = one.word(2);
        [[fallthrough]];
      case SpirvOp::kConstantTrue:
      case SpirvOp::kConstantFalse:
      case SpirvOp::kConstantComposite:
      case SpirvOp::kConstantNull:
      case SpirvOp::kSpecConstantTrue:
      case SpirvOp::kSpecConstantFalse:
      case SpirvOp::kSpecConstantComposite:
      case SpirvOp::kUndef:
      case SpirvOp::kVariable:
        m_.globals.push_back(at_);
        return;
      default:
        refuse("has " + name_of_opcode(one.opcode) + ", which a light program cannot have", "write it without");
    }
  }

  void begin_function(const SpirvInstruction& one) {
    SpirvFunction function;
    function.result_type = m_.checked(one.word(0));
    function.id = m_.checked(one.word(1));
    function.type = m_.checked(one.word(3));
    if (m_.functions.contains(function.id)) refuse_damage("a function is defined twice");
    function_ = &(m_.functions[function.id] = function);
  }

  void in_function(const SpirvInstruction& one) {
    auto& blocks = function_->blocks;
    switch (one.op()) {
      case SpirvOp::kFunctionParameter:
        function_->parameters.push_back(m_.checked(one.word(1)));
        return;
      case SpirvOp::kFunctionEnd:
        if (open_) refuse_damage("a block does not end");
        function_ = nullptr;
        return;
      case SpirvOp::kLabel:
        if (open_) refuse_damage("a block does not end");
        blocks.push_back({m_.checked(one.word(0)), at_ + 1, at_ + 1, 0, 0});
        open_ = true;
        return;
      default:
        if (!open_) refuse_damage("an instruction stands outside a block");
        in_block(blocks.back(), one);
    }
  }

  void in_block(SpirvBlock& block, const SpirvInstruction& one) {
    block.end = at_ + 1;
    switch (one.op()) {
      case SpirvOp::kSelectionMerge:
        block.merge = m_.checked(one.word(0));
        return;
      case SpirvOp::kLoopMerge:
        block.merge = m_.checked(one.word(0));
        block.continue_label = m_.checked(one.word(1));
        return;
      case SpirvOp::kBranch:
      case SpirvOp::kBranchConditional:
      case SpirvOp::kSwitch:
      case SpirvOp::kReturn:
      case SpirvOp::kReturnValue:
      case SpirvOp::kUnreachable:
        open_ = false;
        return;
      case SpirvOp::kKill:
        refuse("discards the pixel", "return 0 where the light adds nothing");
      default:
        return;
    }
  }

  SpirvModule m_;
  std::map<uint32_t, uint32_t> integers_;
  size_t at_ = 0;
  SpirvFunction* function_ = nullptr;
  bool open_ = false;  // inside a block
};

}  // namespace

SpirvModule spirv_module(std::vector<uint32_t> words) { return ModuleReader(std::move(words)).read(); }

}  // namespace trueshade::programs
