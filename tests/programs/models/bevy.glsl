// Bevy's point lights (crates/bevy_pbr, pbr_lighting.wgsl of 0.12): inverse square under 1 - (d^2 / r^2)^2 squared,
// Burley's diffuse as Filament has it, D by Filament's form without cancellation, f90 from f0.
const float pi = 3.141592653589793;

float schlick(float f0, float f90, float u) { return f0 + (f90 - f0) * pow(1.0 - u, 5.0); }

vec3 light(Surface s, Light l, View v) {
  vec3 d = l.position - s.position, n = normalize(s.normal), eye = normalize(v.eye - s.position), to = normalize(d);
  float d2 = dot(d, d), inverse_range2 = 1.0 / (l.range * l.range), factor = d2 * inverse_range2;
  float window = clamp(1.0 - factor * factor, 0.0, 1.0), attenuation = window * window / max(d2, 0.0001);
  vec3 h = normalize(to + eye);
  float nl = clamp(dot(n, to), 0.0, 1.0), nh = clamp(dot(n, h), 0.0, 1.0), lh = clamp(dot(to, h), 0.0, 1.0);
  float nv = max(dot(n, eye), 0.0001), perceptual = clamp(s.roughness, 0.089, 1.0), rough = perceptual * perceptual;
  float one_minus = 1.0 - nh * nh, a = nh * rough, k = rough / (one_minus + a * a), distribution = k * k * (1.0 / pi);
  float a2 = rough * rough, in_view = nl * sqrt((nv - a2 * nv) * nv + a2), in_light = nv * sqrt((nl - a2 * nl) * nl + a2);
  vec3 f0 = 0.16 * 0.5 * 0.5 * (1.0 - s.metallic) + s.albedo.rgb * s.metallic;
  float f90 = clamp(dot(f0, vec3(50.0 * 0.33)), 0.0, 1.0);
  vec3 fresnel = f0 + (f90 - f0) * pow(1.0 - lh, 5.0), mirror = distribution * (0.5 / (in_view + in_light)) * fresnel;
  float fd90 = 0.5 + 2.0 * rough * lh * lh;
  float scattered = schlick(1.0, fd90, nl) * schlick(1.0, fd90, nv) * (1.0 / pi);
  return (s.albedo.rgb * (1.0 - s.metallic) * scattered + mirror) * l.color * (attenuation * nl);
}
