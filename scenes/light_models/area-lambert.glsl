// Lambert under lights with an area, exact: spheres, rectangles and disks by closed forms, tubes as wide lines
//   albedo L F   of a light of radiance L, F its form factor (parts/area_forms.glsl)
// Other lights are those of KHR_lights_punctual, albedo / pi N.L of what arrives; an area light has their window about
// its centre. An ambient light adds color * albedo. Reads position, normal, albedo; lights of all types.
const float pi = 3.14159265;

#include "parts/area_forms.glsl"

#include "parts/arriving.glsl"

vec3 light(Surface s, Light l, View v) {
  if (l.type == light_type_ambient) return l.color * s.albedo.rgb;
  vec3 n = normalize(s.normal), c = l.position - s.position;
  if (has_area(l)) return s.albedo.rgb * l.color * (form_factor(l, c, n) * window_of(l, c));
  vec3 to, arrived = arriving(s, l, to);
  return s.albedo.rgb * (max(dot(n, to), 0.0) / pi) * arrived;
}
