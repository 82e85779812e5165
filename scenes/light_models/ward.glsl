// Isotropic glossy surfaces by a Gaussian: Ward, Measuring and Modeling Anisotropic Reflection (1992), equation 4
//   f = c_diff / pi + F0 exp(-tan^2 / a^2) / (4 pi a^2 sqrt((N.L)(N.V))),  tan of the angle between N and H
// a = roughness^2, at least 0.01; c_diff = albedo (1 - metallic) and F0 = mix(0.04, albedo, metallic) are the paper's
// rho_d and rho_s. N.V is at least 0.0001, N.H 0.001. An ambient light adds color * albedo.
// Reads position, normal, albedo, metallic, roughness; lights of all four types; the eye.
const float pi = 3.14159265;

#include "parts/arriving.glsl"

vec3 light(Surface s, Light l, View v) {
  if (l.type == light_type_ambient) return l.color * s.albedo.rgb;
  vec3 to, arrived = arriving(s, l, to), n = normalize(s.normal), eye = normalize(v.eye - s.position);
  float nl = dot(n, to);
  if (!(nl > 0.0)) return vec3(0.0);
  vec3 h = normalize(to + eye), across = cross(n, h);
  float nh = max(dot(n, h), 0.001), nv = max(dot(n, eye), 0.0001), a = max(s.roughness * s.roughness, 0.01), a2 = a * a;
  float gloss = exp(-dot(across, across) / (nh * nh * a2)) / (4.0 * pi * a2);
  vec3 diffuse = s.albedo.rgb * ((1.0 - s.metallic) / pi), f0 = mix(vec3(0.04), s.albedo.rgb, s.metallic);
  return (diffuse * nl + f0 * (gloss * sqrt(nl / nv))) * arrived;
}
