#pragma once
#include "scenes/files/gltf/extras/scene_extras.h"
#include "scenes/light_fields.h"
#include "scenes/material_fields.h"

// The fields of what `extras.trueshade` holds: keys, values, and what an absent key stands for. `F` is FieldWriter or
// FieldReader; a value is const for the first. So the reader takes just what the writer puts. Fields of geometry are
// those of the document.
namespace trueshade::gltf {

inline constexpr auto kLightTypeNames = [] {
  std::array<std::string_view, std::size(kLightTypes)> names;
  for (size_t i = 0; i < names.size(); ++i) names[i] = kLightTypes[i].name;
  return names;
}();
inline constexpr std::string_view kBetweenNames[] = {"linear", "step", "cubic", "slerp"};
inline constexpr std::string_view kLevelsNames[] = {"one", "filtered", "stored"};
inline constexpr auto kLightPropertyNames = [] {
  std::array<std::string_view, std::size(kLightFields)> names;
  for (size_t i = 0; i < std::size(names); ++i) names[i] = kLightFields[i].name;
  return names;
}();
inline constexpr std::string_view kCameraPropertyNames[] = {"eye", "target", "up", "fov_y", "fov_x"};

inline constexpr auto kLightExtras = [](auto& f, auto& light) {
  const Light absent;
  f.named("type", light.type, absent.type, kLightTypeNames);
  visit_members(light, [&](const LightField& row, auto& value) {
    using Value = std::remove_cvref_t<decltype(value)>;
    f(row.member, value, absent.*std::get<Value Light::*>(row.at));
  });
};

inline constexpr auto kMapFields = [](auto& f, auto& map) {
  const MapExtras absent;
  f("texture", map.texture, kNone);
  f.named("wrap_u", map.slot.sampler.wrap[0], absent.slot.sampler.wrap[0], kWrapNames);
  f.named("wrap_v", map.slot.sampler.wrap[1], absent.slot.sampler.wrap[1], kWrapNames);
  f.named("mag", map.slot.sampler.mag_filter, absent.slot.sampler.mag_filter, kFilterNames);
  f.named("min", map.slot.sampler.min_filter, absent.slot.sampler.min_filter, kFilterNames);
  f.named("mip", map.slot.sampler.mip_filter, absent.slot.sampler.mip_filter, kMipFilterNames);
  f("lod_bias", map.slot.sampler.lod_bias, absent.slot.sampler.lod_bias);
  f("lod_min", map.slot.sampler.lod_min, absent.slot.sampler.lod_min);
  f("lod_max", map.slot.sampler.lod_max, absent.slot.sampler.lod_max);
  f("border", map.slot.sampler.border, absent.slot.sampler.border);
  f("uv_set", map.uv_set, 0u);
};

inline constexpr auto kMaterialExtras = [](auto& f, auto& extras) {
  const Material absent;
  auto& m = extras.material;
  f("name", m.name, absent.name);
  visit_fields(m, [&](const MaterialField& row, auto& value) {
    using Value = std::remove_cvref_t<decltype(value)>;
    f(row.key, value, absent.*std::get<Value Material::*>(row.at));
  });
  f.optional("color_map", extras.color_map, kMapFields);
  f.optional("specular_map", extras.specular_map, kMapFields);
  f.optional("normal_map", extras.normal_map, kMapFields);
  f.optional("metallic_roughness_map", extras.metallic_roughness_map, kMapFields);
  f.optional("emission_map", extras.emission_map, kMapFields);
  f.optional("occlusion_map", extras.occlusion_map, kMapFields);
};

inline constexpr auto kTextureFields = [](auto& f, auto& texture) {
  const TextureExtras absent;
  f("name", texture.name, absent.name);
  f.named("format", texture.format, absent.format, kTextureFormatNames);
  f("width", texture.width, kNone);
  f("height", texture.height, kNone);
  f("image", texture.image, kNone);
  f.named("levels", texture.levels, absent.levels, kLevelsNames);
  f("views", texture.views, absent.views);
};

inline constexpr auto kCameraFields = [](auto& f, auto& camera) {
  const Camera absent;
  f("eye", camera.eye, absent.eye);
  f("target", camera.target, absent.target);
  f("up", camera.up, absent.up);
  f("fov_y_rad", camera.fov_y_rad, absent.fov_y_rad);
  f("fov_x_rad", camera.fov_x_rad, absent.fov_x_rad);
  f("near", camera.near, absent.near);
  f("far", camera.far, absent.far);
  f("clip_from_world", camera.clip_from_world, absent.clip_from_world);
  f("matrix_has_gl_range", camera.matrix_has_gl_range, absent.matrix_has_gl_range);
};

// --- What moves ----------------------------------------------------------------------------------------------------

inline constexpr auto kTrackFields = [](auto& f, auto& track) {
  const Track absent;
  f("times", track.times, absent.times);
  f("values", track.values, absent.values);
  f.named("between", track.between, absent.between, kBetweenNames);
  f("repeats", track.repeats, absent.repeats);
  f("start", track.start, absent.start);
  f("end", track.end, absent.end);
  f("arriving", track.arriving, absent.arriving);
  f("leaving", track.leaving, absent.leaving);
};

inline constexpr auto kPlacementFields = [](auto& f, auto& placement) {
  const Placement absent;
  f("position", placement.position, absent.position);
  f("rotation", placement.rotation, absent.rotation);
  f("scale", placement.scale, absent.scale);
};

inline constexpr auto kMotionFields = [](auto& f, auto& motion) {
  f.object("rest", motion.rest, kPlacementFields);
  f.optional("position", motion.position, kTrackFields);
  f.optional("rotation", motion.rotation, kTrackFields);
  f.optional("scale", motion.scale, kTrackFields);
};

inline constexpr auto kTimelineFields = [](auto& f, auto& t) {
  f("fps", t.fps, Timeline().fps);
  f("stands_at", t.stands_at, std::optional<double>());
  f.list("motions", t.motions, kMotionFields);
  f.list("instances", t.instances, [](auto& g, auto& moving) {
    g("instance", moving.instance, 0u);
    g("motion", moving.motion, 0u);
    g.object("copy", moving.copy, kPlacementFields);
  });
  f.list("materials", t.materials, [](auto& g, auto& motion) {
    g("material", motion.material, 0u);
    g.object("color", motion.color, kTrackFields);
  });
  f.list("lights", t.lights, [](auto& g, auto& motion) {
    g("light", motion.light, 0u);
    g.named("property", motion.property, LightProperty::color, kLightPropertyNames);
    g.object("track", motion.track, kTrackFields);
  });
  f.list("orbits", t.orbits, [](auto& g, auto& orbit) {
    g("light", orbit.light, 0u);
    g("home", orbit.home, glm::vec3(0.0f));
    g("u", orbit.u, glm::vec3(0.0f));
    g("v", orbit.v, glm::vec3(0.0f));
    g("period", orbit.period, 1.0f);
    g("phase", orbit.phase, 0.0f);
  });
  f.list("camera", t.camera, [](auto& g, auto& motion) {
    g.named("property", motion.property, CameraProperty::eye, kCameraPropertyNames);
    g.object("track", motion.track, kTrackFields);
  });
};

/// What hangs on a hierarchy of nodes.
inline constexpr auto kHierarchyFields = [](auto& f, auto& t) {
  f.list("nodes", t.nodes, [](auto& g, auto& node) {
    g("parent", node.parent, kNone);
    g("parent_from_node", node.node.parent_from_node, glm::dmat4x3(1.0));
  });
  f.list("node_motions", t.scene.timeline.node_motions, [](auto& g, auto& moved) {
    g("node", moved.node, 0u);
    g.object("motion", moved.motion, kMotionFields);
  });
  f.list("node_instances", t.scene.timeline.node_instances, [](auto& g, auto& hung) {
    g("instance", hung.instance, 0u);
    g("node", hung.node, 0u);
    g("node_from_object", hung.node_from_object, glm::dmat4x3(1.0));
  });
  f.list("node_lights", t.scene.timeline.node_lights, [](auto& g, auto& hung) {
    g("light", hung.light, 0u);
    g("node", hung.node, 0u);
  });
  f.optional("node_camera", t.scene.timeline.node_camera, [](auto& g, auto& hung) {
    g("node", hung.node, 0u);
    g("clip_from_view", hung.clip_from_view, std::optional<std::array<double, 16>>());
  });
};

inline constexpr auto kSceneFields = [](auto& f, auto& extras) {
  f("version", extras.version, 0u);
  f("clear", extras.scene.clear, glm::vec4(0.0f));
  f("photometric", extras.scene.photometric, false);
  f("lights_of_ours", extras.scene.lights_of_ours, false);
  f("camera_of_ours", extras.scene.camera_of_ours, false);
  f("ground_of_ours", extras.scene.ground_of_ours, false);
  f.object("camera", extras.scene.camera, kCameraFields);
  f.list("lights", extras.scene.lights, kLightExtras);
  f.list("materials", extras.materials, kMaterialExtras);
  f.list("textures", extras.textures, kTextureFields);
  f("mesh_count", extras.mesh_count, 0u);
  f("meshes", extras.meshes, std::vector<uint32_t>());
  f("instances", extras.instances, std::vector<uint32_t>());
  f("colors", extras.colors, std::vector<uint32_t>());
  f("mirrored", extras.mirrored, std::vector<uint32_t>());
  f("uv_sets", extras.uv_sets, std::vector<uint32_t>());
  f.object("timeline", extras.scene.timeline, kTimelineFields);
  f.object("hierarchy", extras, kHierarchyFields);
  f.json("pipeline", extras.scene.pipeline_text);
};

}  // namespace trueshade::gltf
