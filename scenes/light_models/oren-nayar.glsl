// Rough diffuse surfaces, clay and plaster: Oren and Nayar, Generalization of Lambert's Reflectance Model (1994), (30)
//   f = albedo / pi (A + B max(0, cos(phi_i - phi_r)) sin(alpha) tan(beta)),   alpha, beta: the larger and the smaller
//   A = 1 - 0.5 s^2 / (s^2 + 0.33),   B = 0.45 s^2 / (s^2 + 0.09)                of the angles of L and V to N
// s, in radians, is roughness; cos sin tan of these are (L.V - (N.L)(N.V)) / max(N.L, N.V). An ambient light adds
// color * albedo. Reads position, normal, albedo, roughness; lights of all four types; the eye.
const float pi = 3.14159265;

#include "parts/arriving.glsl"

vec3 light(Surface s, Light l, View v) {
  if (l.type == light_type_ambient) return l.color * s.albedo.rgb;
  vec3 to, arrived = arriving(s, l, to), n = normalize(s.normal), eye = normalize(v.eye - s.position);
  float nl = dot(n, to);
  if (!(nl > 0.0)) return vec3(0.0);
  float nv = dot(n, eye), s2 = s.roughness * s.roughness;
  float a = 1.0 - 0.5 * s2 / (s2 + 0.33), b = 0.45 * s2 / (s2 + 0.09);
  float around = max(dot(to, eye) - nl * nv, 0.0) / max(nl, nv);
  return s.albedo.rgb * ((a + b * around) / pi) * arrived * nl;
}
