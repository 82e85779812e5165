// Burley's diffuse and GTR2 lobe: "Physically-Based Shading at Disney" (2012), 5.3 and 5.4, with Smith's masking of
// roughness (0.5 + r / 2)^2, as its appendix B has them; the light's fall-off is inverse square.
const float pi = 3.14159265;

float schlick(float u) {
  float m = clamp(1.0 - u, 0.0, 1.0), m2 = m * m;
  return m2 * m2 * m;
}
float masking(float x, float a) {
  float a2 = a * a, x2 = x * x;
  return 1.0 / (x + sqrt(a2 + x2 - a2 * x2));
}

vec3 light(Surface s, Light l, View v) {
  vec3 d = l.position - s.position, n = normalize(s.normal), to = normalize(d), eye = normalize(v.eye - s.position);
  float nl = dot(n, to), nv = dot(n, eye);
  if (nl <= 0.0 || nv <= 0.0) return vec3(0.0);
  vec3 h = normalize(to + eye);
  float nh = dot(n, h), lh = dot(to, h), fl = schlick(nl), fv = schlick(nv), fh = schlick(lh);
  float fd90 = 0.5 + 2.0 * lh * lh * s.roughness, fd = mix(1.0, fd90, fl) * mix(1.0, fd90, fv);
  float a = max(0.001, s.roughness * s.roughness), t = 1.0 + (a * a - 1.0) * nh * nh;
  float gtr2 = a * a / (pi * t * t), half_rough = 0.5 + 0.5 * s.roughness, g = half_rough * half_rough;
  vec3 tint = mix(vec3(0.08 * 0.5), s.albedo.rgb, s.metallic), f = mix(tint, vec3(1.0), fh);
  vec3 diffuse = s.albedo.rgb * (fd * (1.0 - s.metallic) / pi);
  return (diffuse + gtr2 * masking(nl, g) * masking(nv, g) * f) * nl * l.color / dot(d, d);
}
