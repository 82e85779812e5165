#pragma once
// Wrong renderers of what surfaces hand to the lights: maps, normals in fixed point, extents of lights.
#include "tests/judge/mutants/mutants.h"

namespace trueshade::oracle {

/// Texture coordinates, made of positions, for meshes that have none; mirrored on every other mesh.
void add_texture_coordinates(Scene& scene);

/// Bumps and gloss for every surface: normal and specular maps, nearest and filtered, on meshes whose texture
/// coordinates run left on every other one; the specular colour the material's, where the light model lets it be.
void add_bumps(Scene& scene, Pipeline& pipeline);

/// Maps of metal and roughness, emission and occlusion for every surface, some of them unlit, under ambient light and a
/// light model that reads all of these.
void add_metal(Scene& scene, Pipeline& pipeline);

/// Half the lamps spots; points end at their range, spots do not, and nothing else ends either; of deferred-volumes
/// points are drawn as boxes and spots end at their range.
void mix_extents(Scene& scene, Pipeline& pipeline);

/// Thirty-one of them, each with a base.
std::span<const Mutant> surface_mutants();

}  // namespace trueshade::oracle
