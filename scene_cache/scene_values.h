#pragma once
#include "raster/clusters/clusters.h"
#include "scene_cache/origin.h"
#include "scenes/scene.h"

// The members of what a scene is made of, for TableWriter and TableReader. Each function names all members, and does
// not compile where a struct has one more.
namespace trueshade {

template <class Visit, class... Members>
void each_of(Visit& visit, Members&... members) {
  (visit(members), ...);
}

template <class T, class Of>
concept Same = std::is_same_v<std::remove_const_t<T>, Of>;

void each_member(auto& visit, Same<Material> auto& value) {
  auto& [name, base_color, specular_color, shininess, emission, metallic, roughness, color_map, specular_map,
         normal_map, normal_scale, alpha_cutoff, transparent, metallic_roughness_map, emission_map, occlusion_map,
         occlusion_strength, unlit, double_sided] = value;
  each_of(visit, name, base_color, specular_color, shininess, emission, metallic, roughness, color_map, specular_map,
          normal_map, normal_scale, alpha_cutoff, transparent, metallic_roughness_map, emission_map, occlusion_map,
          occlusion_strength, unlit, double_sided);
}

void each_member(auto& visit, Same<TextureLevel> auto& value) {
  auto& [width, height, bytes] = value;
  each_of(visit, width, height, bytes);
}

void each_member(auto& visit, Same<Texture> auto& value) {
  auto& [name, format, levels] = value;
  each_of(visit, name, format, levels);
}

void each_member(auto& visit, Same<Mesh> auto& value) {
  auto& [name, position, normal, uv, more_uv, color, tangent, indices, pose] = value;
  each_of(visit, name, position, normal, uv, more_uv, color, tangent, indices, pose);
}

void each_member(auto& visit, Same<ClusterBoxes> auto& value) {
  auto& [center, half_size] = value;
  each_of(visit, center, half_size);
}

void each_member(auto& visit, Same<ClusteredMesh> auto& value) {
  auto& [clusters, boxes, position, surface, surface_lines, vertex, corner, pose] = value;
  each_of(visit, clusters, boxes, position, surface, surface_lines, vertex, corner, pose);
}

// What moves.

void each_member(auto& visit, Same<Track> auto& value) {
  auto& [times, values, between, repeats, start, end, arriving, leaving] = value;
  each_of(visit, times, values, between, repeats, start, end, arriving, leaving);
}

void each_member(auto& visit, Same<ObjectMotion> auto& value) {
  auto& [rest, position, rotation, scale] = value;
  each_of(visit, rest, position, rotation, scale);
}

void each_member(auto& visit, Same<NodeMotion> auto& value) {
  auto& [node, motion] = value;
  each_of(visit, node, motion);
}

void each_member(auto& visit, Same<MaterialMotion> auto& value) {
  auto& [material, color] = value;
  each_of(visit, material, color);
}

void each_member(auto& visit, Same<LightMotion> auto& value) {
  auto& [light, property, track] = value;
  each_of(visit, light, property, track);
}

void each_member(auto& visit, Same<CameraMotion> auto& value) {
  auto& [property, track] = value;
  each_of(visit, property, track);
}

void each_member(auto& visit, Same<Skin> auto& value) {
  auto& [joints, joint_from_mesh] = value;
  each_of(visit, joints, joint_from_mesh);
}

void each_member(auto& visit, Same<MorphTarget> auto& value) {
  auto& [position, normal, tangent] = value;
  each_of(visit, position, normal, tangent);
}

void each_member(auto& visit, Same<RestShape> auto& value) {
  auto& [position, normal, tangent, flat_normals, targets, influences, joints, weights] = value;
  each_of(visit, position, normal, tangent, flat_normals, targets, influences, joints, weights);
}

void each_member(auto& visit, Same<WeightTrack> auto& value) {
  auto& [count, times, values, arriving, leaving, between] = value;
  each_of(visit, count, times, values, arriving, leaving, between);
}

void each_member(auto& visit, Same<PosedMesh> auto& value) {
  auto& [mesh, shape, skin, weights, motion] = value;
  each_of(visit, mesh, shape, skin, weights, motion);
}

void each_member(auto& visit, Same<Timeline> auto& value) {
  auto& [fps, stands_at, motions, instances, materials, lights, orbits, camera, nodes, node_motions, node_instances,
         node_lights, node_camera, skins, shapes, posed] = value;
  each_of(visit, fps, stands_at, motions, instances, materials, lights, orbits, camera, nodes, node_motions,
          node_instances, node_lights, node_camera, skins, shapes, posed);
}

void each_member(auto& visit, Same<SceneCamera> auto& value) {
  auto& [name, node, fov_y_rad] = value;
  each_of(visit, name, node, fov_y_rad);
}

void each_member(auto& visit, Same<SceneAnimation> auto& value) {
  auto& [name, seconds] = value;
  each_of(visit, name, seconds);
}

void each_member(auto& visit, Same<SceneExtension> auto& value) {
  auto& [name, required, is_read] = value;
  each_of(visit, name, required, is_read);
}

/// All but the meshes, which are stored first, one by one, and the digests, which the file's maker stores.
void each_member(auto& visit, Same<Scene> auto& value) {
  auto& [spec, meshes, materials, textures, instances, lights, camera, clear, pipeline_text, timeline, time,
         photometric, lights_of_ours, is_model, camera_of_ours, seen_from_inside, ground_of_ours, cameras, animations, extensions,
         digests, notes, passed_over] = value;
  each_of(visit, spec, materials, textures, instances, lights, camera, clear, pipeline_text, timeline, time,
          photometric, lights_of_ours, is_model, camera_of_ours, seen_from_inside, ground_of_ours, cameras, animations, extensions, notes,
          passed_over);
}

void each_member(auto& visit, Same<FileState> auto& value) {
  auto& [path, is_there, bytes, inode, changed_ns, modified_ns] = value;
  each_of(visit, path, is_there, bytes, inode, changed_ns, modified_ns);
}

void each_member(auto& visit, Same<SceneOrigin> auto& value) {
  auto& [spec, limits, files, program] = value;
  each_of(visit, spec, limits, files, program);
}

void each_member(auto& visit, Same<SceneDigests> auto& value) {
  auto& [meshes, textures] = value;
  each_of(visit, meshes, textures);
}

}  // namespace trueshade
