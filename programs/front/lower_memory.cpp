#include "programs/front/light_fields.h"
#include "programs/front/lowering.h"

namespace trueshade::programs {
namespace {

using Kind = SpirvType::Kind;

/// Names and types of the scalars of a type, below a prefix.
class ScalarNames {
 public:
  ScalarNames(const SpirvModule& module, Rate rate, std::vector<ProgramInput>& out,
              std::vector<std::string>* declared = nullptr)
      : m_(module), rate_(rate), out_(out), declared_(declared) {}

  void add(uint32_t id, const std::string& prefix) {  // as deep as kMostDepth
    const SpirvType& type = m_.type(id);
    switch (type.kind) {
      case Kind::structure:
        for (uint32_t i = 0; i < type.count; ++i) add(type.members[i], prefix + "." + member(id, i));
        return;
      case Kind::array:
      case Kind::matrix:
        for (uint32_t i = 0; i < type.count; ++i) add(type.element, prefix + "[" + std::to_string(i) + "]");
        return;
      case Kind::vector:
        declare(prefix, m_.type(type.element).kind, type.count);
        for (uint32_t i = 0; i < type.count; ++i)
          out_.push_back({prefix + "." + "xyzw"[i], scalar(m_.type(type.element).kind), rate_});
        return;
      default:
        declare(prefix, type.kind, 1);
        out_.push_back({prefix, scalar(type.kind), rate_});
    }
  }

  std::string member(uint32_t structure, uint32_t i) const {
    const auto names = m_.member_names.find(structure);
    if (names != m_.member_names.end())
      if (const auto name = names->second.find(i); name != names->second.end()) return name->second;
    refuse("has a block with a member that has no name", "keep the names of debugging (OpMemberName)");
  }

 private:
  /// Notes a scalar or a vector of the block of parameters by its name there.
  void declare(const std::string& prefix, Kind kind, uint32_t count) {
    if (declared_ == nullptr) return;
    const std::string letter = kind == Kind::i32 ? "i" : kind == Kind::u32 ? "u" : "";
    const char* const alone = kind == Kind::i32 ? "int" : kind == Kind::u32 ? "uint" : "float";
    const std::string type = count == 1 ? alone : letter + "vec" + std::to_string(count);
    declared_->push_back(type + ' ' + prefix.substr(prefix.find('.') + 1));
  }

  static Type scalar(Kind kind) {
    if (kind == Kind::boolean) refuse_damage("a boolean in a block");
    return kind == Kind::f32 ? Type::f32 : kind == Kind::i32 ? Type::i32 : Type::u32;
  }

  const SpirvModule& m_;
  const Rate rate_;
  std::vector<ProgramInput>& out_;
  std::vector<std::string>* const declared_;
};

struct Block {
  std::string_view name, prefix;
  Rate rate;
};
constexpr Block kKnownBlocks[] = {{"TsSurface", "surface", Rate::surface},
                                  {"TsLight", "light", Rate::light},
                                  {"TsView", "view", Rate::constant},
                                  {"TsSum", "sum", Rate::sum}};

}  // namespace

/// Names the scalars of a uniform block; a block of another name has the parameters.
void Lowering::declare_input(Variable& variable, uint32_t block) {
  std::string name = m_.name(block);
  if (name.starts_with("type.")) name.erase(0, 5);  // as DXC names the type of a block
  const SpirvType& type = m_.type(block);
  if (type.kind != Kind::structure) refuse("has a uniform that is no block", "put it into one");
  variable.is_read_only = true;
  for (const Block& known : kKnownBlocks) {
    if (name != known.name) continue;
    if (type.count != 1) refuse("has a block " + name + " of more than one member", "leave it the one");
    ScalarNames(m_, known.rate, variable.input).add(type.members[0], std::string(known.prefix));
    return;
  }
  for (const Variable& other : variables_)
    if (!other.input.empty() && other.input[0].name.starts_with("parameters."))
      refuse("has two blocks of parameters", "put them into one");
  ScalarNames(m_, Rate::constant, variable.input, &b_.program().parameters).add(block, "parameters");
}

void Lowering::variable(const SpirvInstruction& one, bool is_global) {
  const SpirvType& pointer = m_.type(one.word(0));
  const auto storage = SpirvStorage(one.word(2));
  if (pointer.kind != Kind::pointer || pointer.storage != storage) refuse_damage("a variable that is no pointer");
  Variable made;
  made.type = pointer.element;
  if (!is_global) made.frame = frames_.size() - 1, made.call = frame().call;
  if (m_.type(made.type).scalars == 0) refuse("has a variable that holds no values", "take it out");
  const std::string block = m_.name(made.type);
  const bool is_block = storage == SpirvStorage::uniform || storage == SpirvStorage::storage_buffer;
  if (is_block && (block == "TsResult" || block == "type.TsResult"))
    made.is_result = true;
  else if (storage == SpirvStorage::uniform)
    declare_input(made, made.type);
  else if (storage != (is_global ? SpirvStorage::private_ : SpirvStorage::function))
    refuse("has the variable '" + m_.name(one.word(1)) + "' of a kind that a light program cannot have",
           "take it from the surface, the light, the view or the parameters");
  if (made.input.empty()) made.scalars = one.size() > 3 ? value(one.word(3)).scalars : zeros(made.type);
  if (made.input.empty() && made.scalars.size() != m_.type(made.type).scalars)
    refuse_damage("a variable starts as another type");
  work(made.scalars.size());
  Value& place = values_[m_.checked(one.word(1))];
  place.type = one.word(0);
  place.scalars.clear();
  place.pointer = {variables_.size(), 0, {}};
  variables_.push_back(std::move(made));
}

const Pointer& Lowering::pointer_of(uint32_t id) const {
  const Value& place = value(id);
  if (m_.type(place.type).kind != Kind::pointer) refuse_damage("a value is used as a pointer");
  return place.pointer;
}

void Lowering::access_chain(const SpirvInstruction& one) {
  Pointer to = pointer_of(one.word(2));
  uint32_t at = m_.type(value(one.word(2)).type).element;
  for (size_t i = 3; i < one.size(); ++i) {
    const SpirvType& type = m_.type(at);
    const NodeId index = operand(one, i, Kind::i32, 1)[0];
    const bool known = b_.is_constant(index);
    const uint32_t bits = b_.node(index).bits;
    if (type.kind == Kind::structure) {
      if (!known || bits >= type.count) refuse_damage("a structure has no such member");
      to.offset += type.first[bits];
      at = type.members[bits];
    } else if (type.kind == Kind::array || type.kind == Kind::vector || type.kind == Kind::matrix) {
      const uint32_t stride = m_.type(type.element).scalars;
      if (known)
        to.offset += std::min(bits, type.count - 1) * stride;
      else
        to.dynamic.push_back({index, type.count, stride});
      at = type.element;
    } else {
      refuse_damage("an index into a scalar");
    }
  }
  const SpirvType& result = m_.type(one.word(0));
  if (result.kind != Kind::pointer || result.element != at) refuse_damage("a pointer to another type");
  Value& place = values_[m_.checked(one.word(1))];
  place.type = one.word(0);
  place.scalars.clear();
  place.pointer = std::move(to);
}

/// A variable of a call that has not ended.
Lowering::Variable& Lowering::variable_at(const Pointer& pointer) {
  Variable& variable = variables_[pointer.variable];
  if (variable.frame >= frames_.size() || frames_[variable.frame].call != variable.call)
    refuse_damage("a pointer to a variable of a call that has ended");
  return variable;
}

Scalars Lowering::load(const Pointer& pointer, uint32_t type) {
  const Variable& variable = variable_at(pointer);
  return load_at(variable, pointer, 0, pointer.offset, m_.type(type).scalars);
}

Scalars Lowering::load_at(const Variable& variable, const Pointer& pointer, size_t level, uint32_t offset,
                          uint32_t count) {
  work(count);
  if (level < pointer.dynamic.size()) {
    const DynamicIndex& dynamic = pointer.dynamic[level];
    Scalars out;
    for (uint32_t k = dynamic.count; k-- > 0;) {
      const Scalars element = load_at(variable, pointer, level + 1, offset + k * dynamic.stride, count);
      if (out.empty()) {
        out = element;  // the last, and all beyond it
        continue;
      }
      const NodeId here = b_.make(Op::i_eq, dynamic.index, b_.word(k));
      for (size_t i = 0; i < count; ++i) out[i] = b_.select(here, element[i], out[i]);
    }
    return out;
  }
  Scalars out;
  const size_t size = variable.input.empty() ? variable.scalars.size() : variable.input.size();
  if (offset > size || count > size - offset) refuse_damage("a load beyond a variable");
  for (size_t i = offset; i < offset + count; ++i) {
    if (variable.input.empty()) {
      out.push_back(b_.under(frame().mask, variable.scalars[i]));
      continue;
    }
    const ProgramInput& input = variable.input[i];
    const bool is_parameter = input.name.starts_with("parameters.");
    if (!is_parameter && type_of_field(input.name) != input.type)
      refuse("reads " + input.name + ", which light programs are not given", "see programs/light_interface.glsl");
    out.push_back(b_.input(input.name, input.type, input.rate));
  }
  return out;
}

/// The mask of the block as the variable's own function sees it, where lanes that have returned from it do not matter.
NodeId Lowering::mask_for(const Variable& variable) {
  NodeId mask = frame().mask;
  for (size_t k = frames_.size() - 1; k > variable.frame; --k) mask = b_.both(frames_[k].call_mask, mask);
  return b_.mask_under(frames_[variable.frame].present, mask);
}

void Lowering::store(const Pointer& pointer, const Scalars& value) {
  Variable& variable = variable_at(pointer);
  if (variable.is_read_only) refuse_damage("a store into a uniform block");
  store_at(variable, pointer, 0, pointer.offset, value, mask_for(variable));
}

void Lowering::store_at(Variable& variable, const Pointer& pointer, size_t level, uint32_t offset, const Scalars& value,
                        NodeId mask) {
  work(value.size());
  if (level < pointer.dynamic.size()) {
    const DynamicIndex& dynamic = pointer.dynamic[level];
    for (uint32_t k = 0; k < dynamic.count; ++k) {
      const NodeId here = k + 1 < dynamic.count ? b_.make(Op::i_eq, dynamic.index, b_.word(k))
                                                : b_.negation(b_.make(Op::u_lt, dynamic.index, b_.word(k)));
      store_at(variable, pointer, level + 1, offset + k * dynamic.stride, value, b_.both(mask, here));
    }
    return;
  }
  if (offset > variable.scalars.size() || value.size() > variable.scalars.size() - offset)
    refuse_damage("a store beyond a variable");
  for (size_t i = 0; i < value.size(); ++i)
    variable.scalars[offset + i] = b_.select(mask, value[i], variable.scalars[offset + i]);
}

void Lowering::set_outputs() {
  const Variable* result = nullptr;
  for (const Variable& variable : variables_)
    if (variable.is_result) result = &variable;
  if (result == nullptr) refuse("has no block TsResult", "store light, reaches, start and finish in one");
  std::vector<ProgramInput> names;
  ScalarNames(m_, Rate::constant, names).add(result->type, "");
  for (int i = 0; i < kOutputCount; ++i) {
    const std::string name = std::string(".").append(name_of_output(i));
    const Type type = i == kReachesOutput ? Type::u32 : Type::f32;
    size_t k = 0;
    while (k < names.size() && names[k].name != name) ++k;
    if (k == names.size() || names[k].type != type)
      refuse("has a block TsResult without " + name.substr(1), "see programs/light_interface.glsl");
    b_.program().output[size_t(i)] = result->scalars[k];
  }
}

}  // namespace trueshade::programs
