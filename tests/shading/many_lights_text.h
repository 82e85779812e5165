#pragma once

namespace trueshade::testing {

// The preset many-lights as a light program, for lights of every type: docs/arithmetic.md section 8, linear_range,
// clamped, blinn_phong of an even shininess, masked, factored.
inline constexpr const char* kManyLights = R"glsl(
vec3 light(Surface s, Light l, View v) {
  vec3 N = normalize(s.normal), V = normalize(v.eye - s.position), D = l.position - s.position;
  float d2 = dot(D, D), d = sqrt(d2), r = d2 > 0.0 ? 1.0 / d : 0.0, a = dot(N, D);
  float f = 1.0 - d / l.range;
  if (l.type == light_type_ambient) return s.albedo.rgb * l.color;
  vec3 L = D * r;
  if (l.type == light_type_directional) L = -l.direction, a = dot(N, L), r = 1.0, f = 1.0;
  if (!(a > 0.0) || !(f > 0.0)) return vec3(0);
  vec3 H = L + V;
  float h2 = dot(H, H), t = max(dot(N, H), 0.0), x = h2 > 0.0 ? min((t * t) / h2, 1.0) : 0.0;
  return (s.albedo.rgb * (a * r) + vec3(0.25 * pow(x, 16.0))) * (l.color * f);
}
bool reaches(Surface s, Light l, View v) {
  return l.type != light_type_ambient && light(s, l, v) != vec3(0);
}
)glsl";

}  // namespace trueshade::testing
