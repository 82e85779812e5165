#pragma once

namespace trueshade::programs {

/// The names outside functions that shaders of gl/emit have before a light program's text, which may take none of them.
inline constexpr const char* kDriverNames =
    "float world_position, world_normal, color, base, texcoord, along_u, along_v, vertex_tangent, tangent_side, ids, "
    "alpha_cutoff, double_sided, "
    "normal_scale, materials, lights, light_count, drawn_light, records, tiles, tile_size, columns, tile_lights, eye, view_axis, clip_from_world, "
    "view_from_world, clip_from_view, moment, picture_place, position_plane, normal_plane, albedo_plane, uv_plane, "
    "specular_plane, emission_plane, object_plane, material_plane, depth_plane, "
    "world_from_clip, ndc_from_window, ndc_origin, depth_to_ndc, target, color_map, specular_map, normal_map, "
    "metallic_roughness_map, emission_map, occlusion_map, color_texcoord, specular_texcoord, normal_texcoord, "
    "metallic_roughness_texcoord, emission_texcoord, occlusion_texcoord;\n"
    "float unit_normal(vec3 n) { return 0.0; }\nfloat bent_normal(vec3 n, vec3 t) { return 0.0; }\n"
    "float texel_of(int i) { return 0.0; }\n"
    "Light ts_light_of(int i) { Light l; return l; }\nView ts_view() { View v; return v; }\n"
    "mat4 ts_matrix_of(vec4 rows[4]) { return mat4(0); }\n"
    "vec3 ts_added(Surface s, Light l, View v) { return vec3(0); }\n"
    "void ts_keep() {}\nvoid ts_fresh() {}\n";

}  // namespace trueshade::programs
