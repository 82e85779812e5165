// Cloth: Estevez and Kulla, Production Friendly Microfacet Sheen BRDF (2017), without its softer terminator
//   f = albedo ((1 - sheen) / pi + sheen D V),   D = (2 + 1/r) sin^(1/r) / (2 pi),  sin of the angle between N and H
//   V = 1 / (4 (N.L)(N.V) (1 + L(N.L) + L(N.V))), at most 1 as in KHR_materials_sheen
//   L(x) = exp(l(x)) where x < 0.5, else exp(2 l(0.5) - l(1 - x)),   l(x) = a / (1 + b x^c) + d x + e
// a to e lie between the paper's for r = 0 and 1, by (1 - r)^2. r is roughness, at least 0.07; the parameter sheen
// is the share of fibres that stand up. An ambient light adds color * albedo.
// Reads position, normal, albedo, roughness; lights of all four types; the eye.
layout(std140) uniform Parameters {
  float sheen;  // 0 to 1, usually 0.5
};
const float pi = 3.14159265;

#include "parts/arriving.glsl"

float fitted(float x, float t) {
  float a = mix(21.5473, 25.3245, t), b = mix(3.82987, 3.32435, t), c = mix(0.19823, 0.16801, t);
  return a / (1.0 + b * pow(x, c)) + mix(-1.97760, -1.27393, t) * x + mix(-4.32054, -4.85967, t);
}
float masking(float x, float t) {
  return exp(x < 0.5 ? fitted(x, t) : 2.0 * fitted(0.5, t) - fitted(1.0 - x, t));
}

vec3 light(Surface s, Light l, View v) {
  if (l.type == light_type_ambient) return l.color * s.albedo.rgb;
  vec3 to, arrived = arriving(s, l, to), n = normalize(s.normal), eye = normalize(v.eye - s.position);
  float nl = min(dot(n, to), 1.0);
  if (!(nl > 0.0)) return vec3(0.0);
  vec3 across = cross(n, normalize(to + eye));
  float nv = clamp(dot(n, eye), 0.0001, 1.0), r = clamp(s.roughness, 0.07, 1.0), t = (1.0 - r) * (1.0 - r);
  float d = (2.0 + 1.0 / r) * pow(min(dot(across, across), 1.0), 0.5 / r) / (2.0 * pi);
  float visible = min(1.0 / (4.0 * nl * nv * (1.0 + masking(nl, t) + masking(nv, t))), 1.0);
  return s.albedo.rgb * mix(1.0 / pi, d * visible, clamp(sheen, 0.0, 1.0)) * arrived * nl;
}
