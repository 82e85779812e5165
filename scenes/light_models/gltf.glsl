// glTF's metals and plastics, GGX: glTF 2.0 (2021), appendix B, under KHR_lights_punctual
//   f = (1 - F) c_diff / pi + F D V
//   D = a^2 / (pi ((N.H)^2 (a^2 - 1) + 1)^2),   V = g(N.L) g(N.V),  g(x) = 1 / (x + sqrt(a^2 + (1 - a^2) x^2))
//   F = F0 + (1 - F0) (1 - V.H)^5,   F0 = mix(0.04, albedo, metallic),   c_diff = albedo (1 - metallic)
// V is the separable form of Smith's, as the specification has it. a = roughness^2, here at least 0.001. An ambient
// light adds color * albedo * occlusion: c_diff, and F0 of metals, which have no c_diff. The sum starts from emission.
// Reads position, normal, albedo, metallic, roughness, emission, occlusion; lights of all four types; the eye.
const float pi = 3.14159265;

#include "parts/arriving.glsl"

float masked(float x, float a2) { return 1.0 / (x + sqrt(a2 + (1.0 - a2) * x * x)); }

vec3 start(Surface s, View v) { return s.emission; }

vec3 light(Surface s, Light l, View v) {
  if (l.type == light_type_ambient) return l.color * s.albedo.rgb * s.occlusion;
  vec3 to, arrived = arriving(s, l, to), n = normalize(s.normal), eye = normalize(v.eye - s.position);
  float nl = dot(n, to);
  if (!(nl > 0.0)) return vec3(0.0);
  vec3 h = normalize(to + eye), across = cross(n, h);
  float nh = max(dot(n, h), 0.0), a = max(s.roughness * s.roughness, 0.001), a2 = a * a;
  // |N x H|^2 is 1 - (N.H)^2 without its cancellation; the sum is never below a^2.
  float q = max(a2 * nh * nh + dot(across, across), a2), d = nh > 0.0 ? a2 / (pi * q * q) : 0.0;
  vec3 f0 = mix(vec3(0.04), s.albedo.rgb, s.metallic);
  vec3 f = f0 + (1.0 - f0) * pow(1.0 - min(abs(dot(eye, h)), 1.0), 5.0);
  vec3 diffuse = s.albedo.rgb * ((1.0 - s.metallic) / pi);
  float mirror = d * masked(nl, a2) * masked(abs(dot(n, eye)), a2);
  return ((1.0 - f) * diffuse + f * mirror) * arrived * nl;
}
