// Unreal Engine 4's GGX and its window: Karis, Real Shading in Unreal Engine 4 (2013), Shading Model and Lighting Model
//   f = c_diff / pi + D F G / (4 (N.L)(N.V)),   D = a^2 / (pi ((N.H)^2 (a^2 - 1) + 1)^2),   a = roughness^2
//   G = g(N.L) g(N.V),  g(x) = x / (x (1 - k) + k),  k = (roughness + 1)^2 / 8
//   F = F0 + (1 - F0) 2^((-5.55473 V.H - 6.98316) V.H),   F0 = mix(0.04, albedo, metallic)
//   of a point light arrives color * clamp(1 - (d / range)^4, 0, 1)^2 / (d^2 + 1); Unreal's d is in centimetres
// Cones are those of KHR_lights_punctual. N.V is at least 0.0001, a at least 0.001; D is 0 where N.H is. An ambient
// light adds color * albedo. Reads position, normal, albedo, metallic, roughness; lights of all four types; the eye.
const float pi = 3.14159265;

// What arrives of a light, and from where.
vec3 arriving(Surface s, Light l, out vec3 to) {
  vec3 d = l.position - s.position;
  float d2 = dot(d, d), part = d2 / (l.range * l.range), cone = 1.0;
  to = l.type == light_type_directional ? -l.direction : normalize(d);
  if (l.type == light_type_directional) return l.color;
  if (l.type == light_type_spot) cone = clamp(l.cone_scale * -dot(l.direction, to) + l.cone_offset, 0.0, 1.0);
  float window = clamp(1.0 - part * part, 0.0, 1.0);
  return l.color * (cone * cone * window * window / (d2 + 1.0));
}

vec3 light(Surface s, Light l, View v) {
  if (l.type == light_type_ambient) return l.color * s.albedo.rgb;
  vec3 to, arrived = arriving(s, l, to), n = normalize(s.normal), eye = normalize(v.eye - s.position);
  float nl = dot(n, to);
  if (!(nl > 0.0)) return vec3(0.0);
  vec3 h = normalize(to + eye), across = cross(n, h);
  float nh = max(dot(n, h), 0.0), nv = max(dot(n, eye), 0.0001), vh = clamp(dot(eye, h), 0.0, 1.0);
  float a = max(s.roughness * s.roughness, 0.001), a2 = a * a, k = (s.roughness + 1.0) * (s.roughness + 1.0) / 8.0;
  // |N x H|^2 is 1 - (N.H)^2 without its cancellation; the sum is never below a^2.
  float q = max(a2 * nh * nh + dot(across, across), a2), d = nh > 0.0 ? a2 / (pi * q * q) : 0.0;
  vec3 f0 = mix(vec3(0.04), s.albedo.rgb, s.metallic);
  vec3 f = f0 + (1.0 - f0) * exp2((-5.55473 * vh - 6.98316) * vh);
  vec3 diffuse = s.albedo.rgb * ((1.0 - s.metallic) / pi);
  float mirror = d / (4.0 * (nl * (1.0 - k) + k) * (nv * (1.0 - k) + k));
  return (diffuse + f * mirror) * arrived * nl;
}
