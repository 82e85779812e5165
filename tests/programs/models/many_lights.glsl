// The preset many-lights, for point lights.
vec3 light(Surface s, Light l, View v) {
  vec3 n = normalize(s.normal), to_eye = normalize(v.eye - s.position), to_light = l.position - s.position;
  float d2 = dot(to_light, to_light), d = sqrt(d2), r = d2 > 0.0 ? 1.0 / d : 0.0;
  float facing = dot(n, to_light), f = 1.0 - d / l.range;
  if (!(facing > 0.0) || !(f > 0.0)) return vec3(0.0);
  vec3 h = to_light * r + to_eye;
  float h2 = dot(h, h), t = max(dot(n, h), 0.0);
  float shine = pow(min(h2 > 0.0 ? (t * t) / h2 : 0.0, 1.0), 16.0);
  return (s.albedo.rgb * (facing * r) + vec3(0.25) * shine) * (l.color * f);
}
