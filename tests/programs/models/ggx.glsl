// glTF 2.0, appendix B: metallic and rough materials under a point light of KHR_lights_punctual.
const float kPi = 3.141592653589793;

vec3 light(Surface s, Light l, View v) {
  vec3 n = normalize(s.normal), to_eye = normalize(v.eye - s.position), to_light = l.position - s.position;
  float d2 = dot(to_light, to_light), window = max(1.0 - (d2 / (l.range * l.range)) * (d2 / (l.range * l.range)), 0.0);
  vec3 direction = normalize(to_light), h = normalize(direction + to_eye);
  float nl = clamp(dot(n, direction), 0.0, 1.0), nv = clamp(dot(n, to_eye), 0.0, 1.0);
  float nh = clamp(dot(n, h), 0.0, 1.0), vh = clamp(dot(to_eye, h), 0.0, 1.0);
  float alpha = s.roughness * s.roughness, a2 = alpha * alpha;
  vec3 c_diffuse = mix(s.albedo.rgb, vec3(0.0), s.metallic), f0 = mix(vec3(0.04), s.albedo.rgb, s.metallic);
  float m = 1.0 - vh, m2 = m * m;
  vec3 fresnel = f0 + (1.0 - f0) * (m2 * m2 * m);
  float g = nl * sqrt(nv * nv * (1.0 - a2) + a2) + nv * sqrt(nl * nl * (1.0 - a2) + a2);
  float visible = g > 0.0 ? 0.5 / g : 0.0;
  float q = nh * nh * (a2 - 1.0) + 1.0, distribution = a2 / (kPi * q * q);
  vec3 reflected = (1.0 - fresnel) * (c_diffuse / kPi) + fresnel * (visible * distribution);
  return reflected * (l.color * (nl * (window / d2)));
}
