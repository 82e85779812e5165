// Cartoons, light in flat steps: Lake et al., Stylized Rendering Techniques for Scalable Real-Time 3D Animation (2000)
//   albedo * paint * ceil(steps * N.L * w) / steps,   w = clamp(1 - (d / range)^2, 0, 1)^2 times the square of the cone
// The paper looks up N.L in a row of tones; here the fall-off goes through the steps too, so that pools of light have
// hard edges. paint is color, divided by its largest component where that is over 1: a lamp paints, however bright. The
// parameter steps is a whole number. An ambient light adds color * albedo.
// Reads position, normal, albedo; lights of all four types.
layout(std140) uniform Parameters {
  float steps;  // from 1, usually 4
};

vec3 light(Surface s, Light l, View v) {
  if (l.type == light_type_ambient) return l.color * s.albedo.rgb;
  vec3 d = l.position - s.position;
  float window = clamp(1.0 - dot(d, d) / (l.range * l.range), 0.0, 1.0), cone = 1.0;
  vec3 to = l.type == light_type_directional ? -l.direction : normalize(d);
  if (l.type == light_type_spot) cone = clamp(l.cone_scale * -dot(l.direction, to) + l.cone_offset, 0.0, 1.0);
  float w = l.type == light_type_directional ? 1.0 : window * window * cone * cone;
  float bright = clamp(dot(normalize(s.normal), to), 0.0, 1.0) * w;
  vec3 paint = l.color / max(max(l.color.r, l.color.g), max(l.color.b, 1.0));
  return s.albedo.rgb * paint * (ceil(steps * bright) / steps);
}
