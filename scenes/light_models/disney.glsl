// Disney's diffuse and GTR2: Burley, Physically-Based Shading at Disney (2012), 5.3 to 5.6, without its further lobes
//   f = fd c_diff / pi + F D V,   D = a^2 / (pi ((N.H)^2 (a^2 - 1) + 1)^2),   a = r^2,   r = roughness
//   fd = e(N.L) e(N.V),  e(x) = 1 + (f90 - 1) (1 - x)^5,  f90 = 0.5 + 2 r (L.H)^2
//   F = F0 + (1 - F0) (1 - L.H)^5,   F0 = mix(0.08 * 0.5, albedo, metallic): the paper's specular is 0.5
//   V = g(N.L) g(N.V),  g(x) = 1 / (x + sqrt(b^2 + x^2 - b^2 x^2)),  b = (0.5 + r / 2)^2
// N.V is at least 0.0001, a at least 0.001 as there; D is 0 where N.H is. An ambient light adds color * albedo.
// Reads position, normal, albedo, metallic, roughness; lights of all four types; the eye.
const float pi = 3.14159265;

#include "parts/arriving.glsl"

float edge(float f90, float x) { return 1.0 + (f90 - 1.0) * pow(1.0 - x, 5.0); }
float masked(float x, float b2) { return 1.0 / (x + sqrt(b2 + x * x - b2 * x * x)); }

vec3 light(Surface s, Light l, View v) {
  if (l.type == light_type_ambient) return l.color * s.albedo.rgb;
  vec3 to, arrived = arriving(s, l, to), n = normalize(s.normal), eye = normalize(v.eye - s.position);
  float nl = min(dot(n, to), 1.0);
  if (!(nl > 0.0)) return vec3(0.0);
  vec3 h = normalize(to + eye), across = cross(n, h);
  float nh = max(dot(n, h), 0.0), nv = clamp(dot(n, eye), 0.0001, 1.0), lh = clamp(dot(to, h), 0.0, 1.0);
  float a = max(s.roughness * s.roughness, 0.001), a2 = a * a, b = 0.5 + 0.5 * s.roughness, b2 = b * b * b * b;
  // |N x H|^2 is 1 - (N.H)^2 without its cancellation; the sum is never below a^2.
  float q = max(a2 * nh * nh + dot(across, across), a2), d = nh > 0.0 ? a2 / (pi * q * q) : 0.0;
  float f90 = 0.5 + 2.0 * s.roughness * lh * lh;
  vec3 f0 = mix(vec3(0.08 * 0.5), s.albedo.rgb, s.metallic), f = f0 + (1.0 - f0) * pow(1.0 - lh, 5.0);
  vec3 diffuse = s.albedo.rgb * ((1.0 - s.metallic) * edge(f90, nl) * edge(f90, nv) / pi);
  return (diffuse + f * (d * masked(nl, b2) * masked(nv, b2))) * arrived * nl;
}
