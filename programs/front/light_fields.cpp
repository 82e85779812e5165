#include "programs/front/light_fields.h"

#include <array>

namespace trueshade::programs {
namespace {

/// Fields of the interface. `shape`: the components of a vector, 0 for a scalar; `count`: of an array or of columns.
struct Field {
  std::string_view name;
  Type type = Type::f32;
  int shape = 0, count = 0;
};

constexpr Field kFields[] = {
    {"surface.position", Type::f32, 3},
    {"surface.normal", Type::f32, 3},
    {"surface.albedo", Type::f32, 4},
    {"surface.specular", Type::f32, 3},
    {"surface.shininess"},
    {"surface.metallic"},
    {"surface.roughness"},
    {"surface.occlusion"},
    {"surface.emission", Type::f32, 3},
    {"surface.uv", Type::f32, 2},
    {"surface.uv1", Type::f32, 2},
    {"surface.tangent", Type::f32, 4},
    {"surface.object", Type::u32},
    {"surface.material", Type::u32},
    {"surface.pixel_x", Type::u32},
    {"surface.pixel_y", Type::u32},
    {"surface.user", Type::f32, 4, 4},
    {"light.type", Type::u32},
    {"light.index", Type::u32},
    {"light.position", Type::f32, 3},
    {"light.range"},
    {"light.direction", Type::f32, 3},
    {"light.color", Type::f32, 3},
    {"light.attenuation", Type::f32, 3},
    {"light.ambient", Type::f32, 3},
    {"light.cone"},
    {"light.penumbra"},
    {"light.cos_inner"},
    {"light.cos_outer"},
    {"light.cone_scale"},
    {"light.cone_offset"},
    {"light.spot_exponent"},
    {"light.penumbra_slope"},
    {"light.cutoff_slope"},
    {"light.right", Type::f32, 3},
    {"light.up", Type::f32, 3},
    {"light.shadow", Type::i32},
    {"light.cookie", Type::i32},
    {"light.user", Type::f32, 4, 4},
    {"view.eye", Type::f32, 3},
    {"view.axis", Type::f32, 3},
    {"view.view", Type::f32, 4, 4},
    {"view.projection", Type::f32, 4, 4},
    {"view.view_projection", Type::f32, 4, 4},
    {"view.size", Type::f32, 2},
    {"view.time"},
    {"view.frame", Type::u32},
    {"sum", Type::f32, 3},
};

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
  for (const Field& field : kFields)
    if (name.starts_with(field.name) && is_scalar_of(field, name.substr(field.name.size()))) return field.type;
  return std::nullopt;
}

}  // namespace trueshade::programs
