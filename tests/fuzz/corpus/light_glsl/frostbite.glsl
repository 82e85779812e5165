// Frostbite's GGX and its window: Lagarde and de Rousiers, Moving Frostbite to PBR (2014), 3.1 and 4.5
//   f = fd c_diff / pi + F D V,   D = a^2 / (pi ((N.H)^2 (a^2 - 1) + 1)^2),   a = r^2,   r = roughness
//   V = 0.5 / (N.L sqrt((N.V)^2 (1 - a^2) + a^2) + N.V sqrt((N.L)^2 (1 - a^2) + a^2)), Smith's for correlated heights
//   F = F0 + (1 - F0) (1 - L.H)^5,   F0 = mix(0.04, albedo, metallic)
//   fd = e(N.L) e(N.V) mix(1, 1 / 1.51, r),  e(x) = 1 + (f90 - 1) (1 - x)^5,  f90 = 0.5 r + 2 r (L.H)^2
//   of a point light arrives color * clamp(1 - (d / range)^4, 0, 1)^2 / max(d^2, 0.0001), and of its cone the square
// N.V is |N.V| + 0.00001 as there, a at least 0.002; D is 0 where N.H is. An ambient light adds color * albedo.
// Reads position, normal, albedo, metallic, roughness; lights of all four types; the eye.
const float pi = 3.14159265;

// What arrives of a light, and from where.
vec3 arriving(Surface s, Light l, out vec3 to) {
  vec3 d = l.position - s.position;
  float d2 = dot(d, d), part = d2 / (l.range * l.range), cone = 1.0;
  to = l.type == light_type_directional ? -l.direction : normalize(d);
  if (l.type == light_type_directional) return l.color;
  if (l.type == light_type_spot) cone = clamp(l.cone_scale * -dot(l.direction, to) + l.cone_offset, 0.0, 1.0);
  float window = clamp(1.0 - part * part, 0.0, 1.0);
  return l.color * (cone * cone * window * window / max(d2, 0.0001));
}

float edge(float f90, float x) { return 1.0 + (f90 - 1.0) * pow(1.0 - x, 5.0); }

vec3 light(Surface s, Light l, View v) {
  if (l.type == light_type_ambient) return l.color * s.albedo.rgb;
  vec3 to, arrived = arriving(s, l, to), n = normalize(s.normal), eye = normalize(v.eye - s.position);
  float nl = min(dot(n, to), 1.0);
  if (!(nl > 0.0)) return vec3(0.0);
  vec3 h = normalize(to + eye), across = cross(n, h);
  float nh = max(dot(n, h), 0.0), nv = min(abs(dot(n, eye)) + 0.00001, 1.0), lh = clamp(dot(to, h), 0.0, 1.0);
  float a = max(s.roughness * s.roughness, 0.002), a2 = a * a;
  // |N x H|^2 is 1 - (N.H)^2 without its cancellation; the sum is never below a^2.
  float q = max(a2 * nh * nh + dot(across, across), a2), d = nh > 0.0 ? a2 / (pi * q * q) : 0.0;
  float visible = 0.5 / (nl * sqrt(nv * nv * (1.0 - a2) + a2) + nv * sqrt(nl * nl * (1.0 - a2) + a2));
  vec3 f0 = mix(vec3(0.04), s.albedo.rgb, s.metallic), f = f0 + (1.0 - f0) * pow(1.0 - lh, 5.0);
  float f90 = 0.5 * s.roughness + 2.0 * s.roughness * lh * lh;
  float scattered = edge(f90, nl) * edge(f90, nv) * mix(1.0, 1.0 / 1.51, s.roughness);
  vec3 diffuse = s.albedo.rgb * ((1.0 - s.metallic) * scattered / pi);
  return (diffuse + f * (d * visible)) * arrived * nl;
}
