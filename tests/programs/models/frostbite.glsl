// Frostbite's punctual and spot lights: Lagarde and de Rousiers, "Moving Frostbite to PBR" (2014), listings 1 (Disney's
// diffuse with its energy renormalised), 2 (GGX by height-correlated Smith) and 26, 27 (inverse square under a smooth
// window, the cone's scale and offset).
const float pi = 3.14159265;

vec3 fresnel(vec3 f0, float f90, float u) { return f0 + (f90 - f0) * pow(1.0 - u, 5.0); }

float disney(float nv, float nl, float lh, float rough) {
  float bias = mix(0.0, 0.5, rough), factor = mix(1.0, 1.0 / 1.51, rough), fd90 = bias + 2.0 * lh * lh * rough;
  vec3 f0 = vec3(1.0);
  return fresnel(f0, fd90, nl).r * fresnel(f0, fd90, nv).r * factor;
}
float correlated(float nl, float nv, float a) {
  float a2 = a * a, in_view = nv * sqrt((-nl * a2 + nl) * nl + a2), in_light = nl * sqrt((-nv * a2 + nv) * nv + a2);
  return 0.5 / (in_view + in_light);
}
float ggx(float nh, float m) {
  float m2 = m * m, f = (nh * m2 - nh) * nh + 1.0;
  return m2 / (f * f);
}
float windowed(vec3 d, float inverse_square_range) {
  float d2 = dot(d, d), factor = d2 * inverse_square_range, smoothed = clamp(1.0 - factor * factor, 0.0, 1.0);
  return smoothed * smoothed / max(d2, 0.01 * 0.01);
}

vec3 light(Surface s, Light l, View v) {
  vec3 d = l.position - s.position, to = normalize(d), n = normalize(s.normal), eye = normalize(v.eye - s.position);
  float attenuation = windowed(d, 1.0 / (l.range * l.range));
  if (l.type == light_type_spot) {
    float cone = clamp(dot(l.direction, -to) * l.cone_scale + l.cone_offset, 0.0, 1.0);
    attenuation *= cone * cone;
  }
  vec3 h = normalize(eye + to);
  float nv = abs(dot(n, eye)) + 1e-5, lh = clamp(dot(to, h), 0.0, 1.0), nh = clamp(dot(n, h), 0.0, 1.0);
  float nl = clamp(dot(n, to), 0.0, 1.0), a = max(s.roughness * s.roughness, 0.002);
  vec3 f0 = mix(vec3(0.04), s.albedo.rgb, s.metallic), f = fresnel(f0, 1.0, lh);
  vec3 mirror = ggx(nh, a) * correlated(nl, nv, a) * f / pi;
  vec3 diffuse = s.albedo.rgb * ((1.0 - s.metallic) * disney(nv, nl, lh, s.roughness) / pi);
  return (diffuse + mirror) * l.color * (nl * attenuation);
}
