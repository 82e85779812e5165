// The preset light-volumes, for point lights.
vec3 light(Surface s, Light l, View v) {
  vec3 to_light = l.position - s.position;
  float d = length(to_light), r = d > 0.0 ? 1.0 / d : 0.0, f = 1.0 - d / l.range;
  float facing = dot(s.normal, to_light);
  if (!(facing > 0.0) || !(f > 0.0)) return vec3(0.0);
  return (s.albedo.rgb * (facing * r)) * (l.color * f);
}
