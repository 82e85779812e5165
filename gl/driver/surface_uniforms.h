#pragma once
#include <span>

#include "gl/emit/glsl.h"
#include "gl/driver/objects.h"
#include "scenes/scene.h"

namespace trueshade::oracle {

/// Gives a program with surface_uniforms_text() what it reads: the planes, in texture units from 0 on, the eye, and
/// what rebuilds a position from depth. Returns the first unit that is still free.
///   shift_x, shift_y: by how many pixels the picture is moved
int bind_surface(GLuint program, std::span<const GlslPlane> planes, std::span<const GlTexture> textures, GLuint depth,
                 const Scene& scene, const Pipeline& pipeline, int shift_x, int shift_y);

/// Sets the uniform clip_from_world, as rows, of a program that draws lights' geometry.
void set_clip_rows(GLuint program, const Scene& scene, const Pipeline& pipeline);

}  // namespace trueshade::oracle
