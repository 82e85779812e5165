// Microfacets after Beckmann: Cook and Torrance, A Reflectance Model for Computer Graphics (1982)
//   f = c_diff / pi + F D G / (4 (N.L)(N.V)),   G = min(1, 2 (N.H)(N.V) / V.H, 2 (N.H)(N.L) / V.H)
//   D = exp(-tan^2 / m^2) / (pi m^2 (N.H)^4),  tan of the angle between N and H,   m = roughness^2
//   F = (g - c)^2 / (2 (g + c)^2) (1 + ((c (g + c) - 1) / (c (g - c) + 1))^2),  c = V.H,  g^2 = i^2 + c^2 - 1,
//     the index i = (1 + sqrt(F0)) / (1 - sqrt(F0)),  F0 = mix(0.04, albedo, metallic) at most 0.99
// The paper has pi for the 4; 4 and the pi of D are those of Walter et al., Microfacet Models for Refraction (2007), 5.
// c_diff = albedo (1 - metallic). N.V and V.H are at least 0.0001, N.H 0.001, m 0.01. From m = 0.71 on, D is brightest
// around N and not at it: a ring, which is Beckmann's. An ambient light adds color * albedo.
// Reads position, normal, albedo, metallic, roughness; lights of all four types; the eye.
const float pi = 3.14159265;

#include "parts/arriving.glsl"

vec3 fresnel(vec3 f0, float c) {
  vec3 root = sqrt(min(f0, 0.99)), i = (1.0 + root) / (1.0 - root), g = sqrt(max(i * i + (c * c - 1.0), 0.0));
  vec3 a = (g - c) / (g + c), b = (c * (g + c) - 1.0) / (c * (g - c) + 1.0);
  return 0.5 * a * a * (1.0 + b * b);
}

vec3 light(Surface s, Light l, View v) {
  if (l.type == light_type_ambient) return l.color * s.albedo.rgb;
  vec3 to, arrived = arriving(s, l, to), n = normalize(s.normal), eye = normalize(v.eye - s.position);
  float nl = dot(n, to);
  if (!(nl > 0.0)) return vec3(0.0);
  vec3 h = normalize(to + eye), across = cross(n, h);
  float nh = max(dot(n, h), 0.001), nv = max(dot(n, eye), 0.0001), vh = clamp(dot(eye, h), 0.0001, 1.0);
  float m = max(s.roughness * s.roughness, 0.01), nh2 = nh * nh, tan2 = dot(across, across) / nh2;
  float d = exp(-tan2 / (m * m)) / (pi * m * m * nh2 * nh2);
  float g = min(1.0, 2.0 * nh * min(nv, nl) / vh);
  vec3 diffuse = s.albedo.rgb * ((1.0 - s.metallic) / pi);
  vec3 f = fresnel(mix(vec3(0.04), s.albedo.rgb, s.metallic), vh);
  return (diffuse * nl + f * (d * g / (4.0 * nv))) * arrived;
}
