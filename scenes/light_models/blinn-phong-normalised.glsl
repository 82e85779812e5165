// Blinn-Phong that keeps its energy: Akenine-Moeller, Haines, Hoffman, Real-Time Rendering (3rd edition, 2008), 7.6
//   f = albedo / pi + specular (n + 8) / (8 pi) (N.H)^n,   n = shininess
// (n + 8) / (8 pi) is near the exact factor, so that a mirror's glint grows brighter as it grows smaller.
// An ambient light adds color * albedo. Reads position, normal, albedo, specular, shininess; lights of all four types;
// the eye.
const float pi = 3.14159265;

#include "parts/arriving.glsl"

vec3 light(Surface s, Light l, View v) {
  if (l.type == light_type_ambient) return l.color * s.albedo.rgb;
  vec3 to, arrived = arriving(s, l, to), n = normalize(s.normal), eye = normalize(v.eye - s.position);
  float nl = dot(n, to);
  if (!(nl > 0.0)) return vec3(0.0);
  float nh = clamp(dot(n, normalize(to + eye)), 0.0, 1.0);
  float shine = (s.shininess + 8.0) / (8.0 * pi) * pow(nh, s.shininess);
  return (s.albedo.rgb / pi + s.specular * shine) * arrived * nl;
}
