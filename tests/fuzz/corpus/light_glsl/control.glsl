#define twice(x) ((x) * 2.0)
#ifdef GL_ES
#error none
#endif
layout(std140) uniform Parameters { int count; mat2 turn; float weight[2]; };
struct Pair { float a; vec2 b[2]; };
float gone(float x, inout Pair p) {
  for (int i = 0; i < 4; ++i) { if (x > float(i)) break; if (x < 0.0) continue; p.b[i & 1].y += x; x = x * 1.5; }
  switch (count) { case 1: return x; case 2: x += 1.0; default: x = -x; }
  while (x > 9.0) { x *= 0.5; if (x < 1.0) return x; }
  return x;
}
vec3 light(Surface s, Light l, View v) {
  Pair p = Pair(weight[1], vec2[](s.albedo.rg, turn * l.color.xy));
  float t = gone(s.metallic, p);
  int n = 0; float f = frexp(t, n);
  bool near = s.position.x > 0.0 && l.range < 9.5;
  return mat3(1) * s.normal * (near ? f : p.b[count].x) + reflect(s.normal, l.direction) * pow(s.roughness, twice(t));
}
bool reaches(Surface s, Light l, View v) { return l.range > 1.0; }
vec3 start(Surface s, View v) { return s.albedo.rgb * 0.1; }
vec4 finish(Surface s, View v, vec3 sum) { return unpackUnorm4x8(packUnorm4x8(vec4(sum, 1))); }
