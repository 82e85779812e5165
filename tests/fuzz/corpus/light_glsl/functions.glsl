vec3 light(Surface s, Light l, View v) {
  vec3 d = l.position - s.position;
  float a = sin(d.x) + cos(d.y) + tan(d.z) + asin(s.metallic) + acos(s.roughness) + atan(d.x, d.y) + sinh(d.x) * tanh(d.y);
  uint u = floatBitsToUint(a) >> 3u ^ uint(bitCount(7)) + bitfieldReverse(5u);
  a += exp2(d.x) + log2(l.range) + inversesqrt(dot(d, d)) + mod(d.x, 0.3) + smoothstep(0.0, 1.0, d.y) + fma(d.x, d.y, d.z);
  return refract(normalize(d), s.normal, 0.7) * a + cross(d, s.normal) * float(u % 7u) + unpackHalf2x16(u).xyx;
}
