// Filament's standard lobe for a punctual light: Guy and Agopian, "Physically Based Rendering in Filament" (2018), 4.4
// (D_GGX, V_SmithGGXCorrelated, F_Schlick), 4.6.1 (Lambert) and 5.2.2 (inverse square under a window).
const float pi = 3.14159265359;

float distribution(float nh, float a) {
  float f = (nh * a - nh) * nh + 1.0;
  return a / (pi * f * f);
}
float visibility(float nv, float nl, float a) {
  float in_view = nl * sqrt((nv - a * nv) * nv + a), in_light = nv * sqrt((nl - a * nl) * nl + a);
  return 0.5 / (in_view + in_light);
}
vec3 fresnel(vec3 f0, float f90, float vh) { return f0 + (f90 - f0) * pow(1.0 - vh, 5.0); }

vec3 light(Surface s, Light l, View v) {
  vec3 d = l.position - s.position;
  float d2 = dot(d, d), factor = d2 / (l.range * l.range), smoothed = max(1.0 - factor * factor, 0.0);
  float attenuation = smoothed * smoothed / max(d2, 1e-4);
  vec3 n = normalize(s.normal), to = normalize(d), eye = normalize(v.eye - s.position), h = normalize(eye + to);
  float nl = clamp(dot(n, to), 0.0, 1.0), nv = max(dot(n, eye), 1e-4), nh = clamp(dot(n, h), 0.0, 1.0);
  float lh = clamp(dot(to, h), 0.0, 1.0);
  if (nl <= 0.0) return vec3(0.0);
  float perceptual = clamp(s.roughness, 0.045, 1.0), roughness = perceptual * perceptual;
  vec3 base = s.albedo.rgb * (1.0 - s.metallic), f0 = 0.16 * 0.5 * 0.5 * (1.0 - s.metallic) + s.albedo.rgb * s.metallic;
  float f90 = clamp(dot(f0, vec3(50.0 * 0.33)), 0.0, 1.0);
  vec3 lobe = distribution(nh, roughness * roughness) * visibility(nv, nl, roughness * roughness) * fresnel(f0, f90, lh);
  return (base / pi + lobe) * l.color * (attenuation * nl);
}
