#pragma once
#include <random>

#include "scenes/pipeline/pipeline.h"
#include "scenes/scene.h"
#include "tests/raster/window_scene.h"

namespace trueshade::testing {

using Random = std::mt19937_64;
/// Bits of `random` in [low, high); a formula of our own, so that every library draws the same numbers.
double between(Random& random, double low, double high);

/// Meshes of random triangles and small grids, drawn by turned, scaled and mirrored instances.
Scene random_scene(Random& random);
Pipeline random_pipeline(Random& random);

/// Gives every material of a scene a colour map, some a normal map, some an alpha cutoff; any format, wrap and filter.
void add_maps(Random& random, Scene& scene);

/// Gives meshes all further sets of texture coordinates, and the maps of materials sets of their own.
void add_uv_sets(Random& random, Scene& scene);

/// Takes some sets away again: maps read 0 there.
void drop_uv_sets(Random& random, Scene& scene);

/// Gives some meshes tangents, of any direction and length.
void add_tangents(Random& random, Scene& scene);

/// Makes some materials double-sided and some instances mirrored.
void add_faces(Random& random, Scene& scene);

}  // namespace trueshade::testing
