#include "programs/front/light_fields.h"

#include <sstream>
#include <string>
#include <vector>

#include "programs/front/light_interface_text.h"

namespace trueshade::programs {
namespace {

/// A member of a struct of the interface. `shape`: the components of a vector, 0 for a scalar; `count`: of an array or
/// of columns, 0 for neither.
struct Field {
  std::string name;  ///< light.user
  Type type = Type::f32;
  int shape = 0, count = 0;
};

/// Of a type's name what a member of it has.
Field of_type(std::string_view type) {
  if (type == "int") return {{}, Type::i32};
  if (type == "uint") return {{}, Type::u32};
  if (type == "mat4") return {{}, Type::f32, 4, 4};
  return {{}, Type::f32, type.starts_with("vec") ? type[3] - '0' : 0};
}

/// The members of the interface's structs, as its text declares them: "  vec2 uv, uv1;" or "  vec4 user[4];" a line, in
/// "struct Light {", whose members are named `light.` here.
std::vector<Field> interface_fields() {
  std::vector<Field> fields{{"sum", Type::f32, 3}};
  std::istringstream text(kLightInterface);
  std::string prefix;
  for (std::string line; std::getline(text, line);) {
    std::istringstream words(line.substr(0, line.find("//")));
    std::string word;
    if (!(words >> word)) continue;
    if (word == "struct" && words >> prefix) {
      prefix[0] = char(prefix[0] - 'A' + 'a');
      prefix += '.';
    } else if (word == "};") {
      prefix.clear();
    } else if (!prefix.empty()) {
      Field field = of_type(word);
      for (std::string name; words >> name;) {
        name.pop_back();  // the comma or the semicolon behind it
        const size_t bracket = name.find('[');
        if (bracket != std::string::npos) field.count = name[bracket + 1] - '0';
        field.name = prefix + name.substr(0, bracket);
        fields.push_back(field);
      }
    }
  }
  return fields;
}

/// Whether what follows a field's name is one of its scalars: "[2].w", ".x" or nothing.
bool is_scalar_of(const Field& field, std::string_view rest) {
  if (field.count > 0) {
    if (rest.size() < 3 || rest[0] != '[' || rest[1] < '0' || rest[1] >= '0' + field.count || rest[2] != ']')
      return false;
    rest.remove_prefix(3);
  }
  if (field.shape == 0) return rest.empty();
  return rest.size() == 2 && rest[0] == '.' &&
         std::string_view("xyzw").substr(0, size_t(field.shape)).find(rest[1]) != std::string_view::npos;
}

}  // namespace

std::optional<Type> type_of_field(std::string_view name) {
  static const std::vector<Field> fields = interface_fields();
  for (const Field& field : fields)
    if (name.starts_with(field.name) && is_scalar_of(field, name.substr(field.name.size()))) return field.type;
  return std::nullopt;
}

}  // namespace trueshade::programs
