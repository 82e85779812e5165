// What arrives of a light, and from where: the inverse square under a window, and the cone, of KHR_lights_punctual.
vec3 arriving(Surface s, Light l, out vec3 to) {
  vec3 d = l.position - s.position;
  float d2 = dot(d, d), part = d2 / (l.range * l.range), cone = 1.0;
  to = l.type == light_type_directional ? -l.direction : normalize(d);
  if (l.type == light_type_directional) return l.color;
  if (l.type == light_type_spot) cone = clamp(l.cone_scale * -dot(l.direction, to) + l.cone_offset, 0.0, 1.0);
  return l.color * (cone * cone * clamp(1.0 - part * part, 0.0, 1.0) / max(d2, 1e-16));
}
