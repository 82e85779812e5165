#pragma once
#include <span>

#include "gl/emit/glsl.h"
#include "gl/driver/objects.h"
#include "scenes/scene.h"

namespace trueshade::oracle {

/// Hands surface_uniforms_text() its planes, from texture unit 0 on, the eye, and what rebuilds a position from depth.
/// `shift_x`, `shift_y`: how far the picture is moved. Returns the first unit that is free.
int bind_surface(GLuint program, std::span<const GlslPlane> planes, std::span<const GlTexture> textures, GLuint depth,
                 const Scene& scene, const Pipeline& pipeline, int shift_x, int shift_y);

/// Sets clip_from_world, rows, of a program that draws light geometry.
void set_clip_rows(GLuint program, const Scene& scene, const Pipeline& pipeline);

}  // namespace trueshade::oracle
