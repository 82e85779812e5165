// Diffuse light that wraps around, skin and wax: Green, Real-Time Approximations to Subsurface Scattering (2004), 16.2
//   albedo / pi * max(0, (N.L + wrap) / (1 + wrap)), in place of Lambert's N.L; the source is in GPU Gems
// The parameter wrap: 0 is Lambert, 1 lights up to the far side. An ambient light adds color * albedo.
// Reads position, normal, albedo; lights of all four types.
layout(std140) uniform Parameters {
  float wrap;  // 0 to 1, usually 0.5
};
const float pi = 3.14159265;

#include "parts/arriving.glsl"

vec3 light(Surface s, Light l, View v) {
  if (l.type == light_type_ambient) return l.color * s.albedo.rgb;
  vec3 to, arrived = arriving(s, l, to), n = normalize(s.normal);
  float w = clamp(wrap, 0.0, 1.0), wrapped = dot(to, to) > 0.0 && dot(n, n) > 0.0 ? (dot(n, to) + w) / (1.0 + w) : 0.0;
  return s.albedo.rgb * (max(wrapped, 0.0) / pi) * arrived;
}
