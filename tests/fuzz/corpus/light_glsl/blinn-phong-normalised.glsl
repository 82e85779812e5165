// Blinn-Phong that keeps its energy: Akenine-Moeller, Haines, Hoffman, Real-Time Rendering (3rd edition, 2008), 7.6
//   f = albedo / pi + specular (n + 8) / (8 pi) (N.H)^n,   n = shininess
// (n + 8) / (8 pi) is near the exact factor, so that a mirror's glint grows brighter as it grows smaller.
// An ambient light adds color * albedo. Reads position, normal, albedo, specular, shininess; lights of all four types;
// the eye.
const float pi = 3.14159265;

// What arrives of a light, and from where: the inverse square under a window, and the cone, of KHR_lights_punctual.
vec3 arriving(Surface s, Light l, out vec3 to) {
  vec3 d = l.position - s.position;
  float d2 = dot(d, d), part = d2 / (l.range * l.range), cone = 1.0;
  to = l.type == light_type_directional ? -l.direction : normalize(d);
  if (l.type == light_type_directional) return l.color;
  if (l.type == light_type_spot) cone = clamp(l.cone_scale * -dot(l.direction, to) + l.cone_offset, 0.0, 1.0);
  return l.color * (cone * cone * clamp(1.0 - part * part, 0.0, 1.0) / max(d2, 1e-16));
}

vec3 light(Surface s, Light l, View v) {
  if (l.type == light_type_ambient) return l.color * s.albedo.rgb;
  vec3 to, arrived = arriving(s, l, to), n = normalize(s.normal), eye = normalize(v.eye - s.position);
  float nl = dot(n, to);
  if (!(nl > 0.0)) return vec3(0.0);
  float nh = clamp(dot(n, normalize(to + eye)), 0.0, 1.0);
  float shine = (s.shininess + 8.0) / (8.0 * pi) * pow(nh, s.shininess);
  return (s.albedo.rgb / pi + s.specular * shine) * arrived * nl;
}
