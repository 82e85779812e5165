// glTF's metals and plastics under lights with an area: Lambert exact, GGX by the point that stands for the light
//   (1 - F) c_diff / pi E + F D V G,   c_diff, F, D and V as in gltf.glsl, of the direction to that point
//   E = pi L F_area, the irradiance of a light of radiance L by its form factor (parts/area_forms.glsl)
//   G = mix(L W N.L, E, a), W the solid angle of the light about the point: of gloss, as if all stood there
//   D is lower for a lobe that the light widens: times a^2 / sqrt((a^2 + w k) (a^2 + w / k)), w = W / (4 pi V.H), k how
//   many times as long as wide the light is
// The point: of a sphere and a tube the nearest to the mirrored ray (Karis, Real Shading in Unreal Engine 4, 2013), of a
// rectangle and a disk where that ray meets their plane, moved into them. Other lights are those of gltf.glsl; an area
// light has their window about its centre. An ambient light adds color * albedo * occlusion.
// Reads position, normal, albedo, metallic, roughness, emission, occlusion; lights of all types; the eye.
const float pi = 3.14159265;

#include "parts/area_forms.glsl"

#include "parts/arriving.glsl"

// The point of a ball about c that is nearest to the ray from the surface along r.
vec3 nearest_in_ball(vec3 c, float radius, vec3 r) {
  vec3 off = r * dot(c, r) - c;
  return c + off * min(radius * inversesqrt(max(dot(off, off), 1e-20)), 1.0);
}

// The point of a light that stands for all of it, seen from the surface; r: the mirrored ray, of unit length.
vec3 standing_for(Light l, vec3 c, vec3 r) {
  if (l.type == light_type_sphere) return nearest_in_ball(c, l.right.x, r);
  if (l.type == light_type_tube) {
    float along = dot(l.right, r), square = dot(l.right, l.right);
    float t = (along * dot(c, r) - dot(c, l.right)) / max(square - along * along, 1e-6 * square);
    return nearest_in_ball(c + l.right * clamp(t, -1.0, 1.0), l.up.x, r);
  }
  vec3 off = r * (dot(c, l.direction) / min(dot(r, l.direction), -1e-3)) - c;
  vec2 at = vec2(dot(off, l.right) / dot(l.right, l.right), dot(off, l.up) / dot(l.up, l.up));
  at = l.type == light_type_disk ? at * min(inversesqrt(max(dot(at, at), 1e-20)), 1.0) : clamp(at, -1.0, 1.0);
  return c + l.right * at.x + l.up * at.y;
}

// The solid angle in which the light is seen from so far, about.
float solid_angle(Light l, vec3 c) {
  float d2 = max(dot(c, c), 1e-16), area;
  if (l.type == light_type_sphere) area = pi * l.right.x * l.right.x;
  else if (l.type == light_type_tube) area = 4.0 * l.up.x * length(cross(l.right, c)) * inversesqrt(d2);
  else area = (l.type == light_type_disk ? pi : 4.0) * abs(dot(cross(l.right, l.up), c)) * inversesqrt(d2);
  return area / (d2 + area / (2.0 * pi));
}

// How many times as long as wide it is.
float aspect(Light l) {
  if (l.type == light_type_tube) return length(l.right) / l.up.x;
  return l.type == light_type_rectangle ? length(l.right) / length(l.up) : 1.0;
}

float masked(float x, float a2) { return 1.0 / (x + sqrt(a2 + (1.0 - a2) * x * x)); }

vec3 start(Surface s, View v) { return s.emission; }

vec3 light(Surface s, Light l, View v) {
  if (l.type == light_type_ambient) return l.color * s.albedo.rgb * s.occlusion;
  vec3 n = normalize(s.normal), eye = normalize(v.eye - s.position), c = l.position - s.position, to, arrived, glossy;
  float a = max(s.roughness * s.roughness, 0.001), a2 = a * a, angle = 0.0, k = 1.0;
  if (has_area(l)) {
    vec3 point = standing_for(l, c, n * (2.0 * dot(n, eye)) - eye);
    to = normalize(point), angle = solid_angle(l, point), k = aspect(l);
    vec3 radiance = l.color * window_of(l, c);
    arrived = radiance * (pi * form_factor(l, c, n));
    glossy = mix(radiance * (angle * max(dot(n, to), 0.0)), arrived, a);
  } else {
    arrived = arriving(s, l, to);
    glossy = arrived = arrived * max(dot(n, to), 0.0);
  }
  if (arrived == vec3(0.0)) return vec3(0.0);
  vec3 h = normalize(to + eye), across = cross(n, h);
  float nl = max(dot(n, to), 0.0), nh = max(dot(n, h), 0.0), vh = min(abs(dot(eye, h)), 1.0);
  // |N x H|^2 is 1 - (N.H)^2 without its cancellation; the sum is never below a^2.
  float q = max(a2 * nh * nh + dot(across, across), a2), d = nh > 0.0 ? a2 / (pi * q * q) : 0.0;
  float w = angle / (4.0 * pi * max(vh, 0.001));
  d *= a2 * inversesqrt((a2 + w * k) * (a2 + w / k));
  vec3 f0 = mix(vec3(0.04), s.albedo.rgb, s.metallic);
  vec3 f = f0 + (1.0 - f0) * pow(1.0 - vh, 5.0);
  vec3 diffuse = s.albedo.rgb * ((1.0 - s.metallic) / pi);
  float mirror = d * masked(nl, a2) * masked(abs(dot(n, eye)), a2);
  return (1.0 - f) * diffuse * arrived + f * mirror * glossy;
}
