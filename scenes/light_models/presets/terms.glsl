// What one light adds under a pipeline's `light_model`: docs/arithmetic.md, section 8. All presets are made of these
// terms. A line `#ifdef term` keeps what follows it where the pipeline chooses that term, as in `"falloff": "linear"`, or
// where terms_of() of scenes/light_models/stated_model.cpp finds it: most of these say how the formula is spelled.
// The model's numbers stand before this text, as constants.

struct Arrival {   // of one light at one surface
  vec3 to;         // L, from the surface to the light, of unit length
  float facing;    // N . D, D of any length: above 0 where the surface faces the light
  float cosine;    // N . L
  float strength;  // fall-off times cone
  bool reaches;    // false outside the light's range or cone: it adds nothing
};

vec3 unit(vec3 v) {
#ifdef for_drivers
  float l2 = dot(v, v);  // 0 stays 0
  return v * (l2 > 0.0 ? inversesqrt(l2) : 0.0);
#else
  return normalize(v);
#endif
}

vec3 normal_of(Surface s) {
#ifdef renormalize
  return unit(s.normal);
#else
  return s.normal;
#endif
}

vec3 color_of(Light l) {
#ifdef damped
  return l.color * damping;
#else
  return l.color;
#endif
}

#ifdef powers
float power_of(float x, float p) {
#ifdef for_drivers
  return p == 0.0 ? 1.0 : pow(x, p);  // GLSL leaves pow(0, 0) open
#else
  return pow(x, p);
#endif
}

#endif
Arrival arrival(Surface s, Light l) {
  vec3 n = normal_of(s);
  if (l.type == light_type_directional) {
    float nl = dot(n, -l.direction);
    return Arrival(-l.direction, nl, nl, 1.0, true);
  }
  vec3 offset = l.position - s.position;
#ifdef for_drivers
  float d2 = dot(offset, offset), r = d2 > 0.0 ? inversesqrt(d2) : 0.0, d = d2 * r;
#else
  float d2 = dot(offset, offset), d = sqrt(d2), r = d2 > 0.0 ? 1.0 / d : 0.0;
#endif
  bool reaches = d2 <= 3.40282347e38;
#ifdef falloff_linear_range
  float f = 1.0 - d / l.range;
  reaches = reaches && f > 0.0;
#endif
#ifdef falloff_linear
  float f = 1.0 - d / l.range;
#endif
#ifdef falloff_quadratic
  float f = 1.0 / ((1.0 + l.attenuation.y * d) + (l.attenuation.z * d) * d);
#endif
#ifdef falloff_none
  float f = 1.0;
#endif
#ifdef falloff_attenuation
  float f = min(1e18, 1.0 / ((l.attenuation.x + l.attenuation.y * d) + (l.attenuation.z * d) * d));
#endif
#ifdef falloff_inverse_square
  float part = d2 / (l.range * l.range), window = 1.0 - part * part;
  reaches = reaches && d < l.range && window > 0.0;
  float f = window * min(1e18, r * r);
#endif
  vec3 to = offset * r;
#ifdef coned
  if (l.type == light_type_spot) {
    float c = dot(to, -l.direction);
#ifdef cone_smooth_cutoff
    float t = clamp((c - l.cos_outer) * l.cutoff_slope, 0.0, 1.0);
#endif
#ifdef cone_smooth_penumbra
    float t = clamp((c - l.cos_outer) * l.penumbra_slope, 0.0, 1.0);
#endif
#ifdef cone_smooth
#ifdef for_drivers
    t = c > l.cos_outer ? t : 0.0;  // GLSL leaves open what clamp() makes of 0 times an infinite slope
#endif
    float g = (t * t) * (3.0 - 2.0 * t);
#endif
#ifdef cone_exponent
    bool all_around = l.cone + l.penumbra >= 3.14159274;
    float g = all_around ? 1.0 : c >= l.cos_outer ? power_of(max(c, 0.0), l.spot_exponent) : 0.0;
#endif
#ifdef cone_squared_penumbra
    float t = clamp(c * l.cone_scale + l.cone_offset, 0.0, 1.0);
    float g = t * t;
#endif
    reaches = reaches && g > 0.0;
    f = f * g;
  }
#endif
#ifdef as_renderers_write
  float facing = dot(n, to);
  return Arrival(to, facing, facing, f, reaches);
#else
  float facing = dot(n, offset);
  return Arrival(to, facing, facing * r, f, reaches);
#endif
}

#ifdef shines
// The cosine of the highlight to the shininess.
float highlight(Surface s, View v, Arrival at) {
#ifdef viewer_local
  vec3 n = normal_of(s), eye = unit(v.eye - s.position);
#else
  vec3 n = normal_of(s), eye = -v.axis;
#endif
#ifdef own_gloss
  float power = roundEven(min(8192.0, max(s.shininess, 0.0)));
#endif
#ifdef specular_phong
  vec3 reflected = (2.0 * min(1.0, max(at.cosine, 0.0))) * n - at.to;
  float x = min(1.0, max(dot(reflected, eye), 0.0));
#else
#ifdef as_renderers_write
  float x = max(dot(n, unit(at.to + eye)), 0.0);
#else
  vec3 h = at.to + eye;  // the half vector, of any length
  float h2 = dot(h, h), t = max(dot(n, h), 0.0);
#ifdef by_own_power
  bool even = floor(power * 0.5) * 2.0 == power;  // then no root is needed
  float x = h2 > 0.0 ? (even ? (t * t) / h2 : t / sqrt(h2)) : 0.0;
  power = even ? power * 0.5 : power;
#endif
#ifdef squared
  float x = h2 > 0.0 ? (t * t) / h2 : 0.0;  // the square of the cosine, to half of an even shininess
#endif
#ifdef not_squared
  float x = h2 > 0.0 ? t / sqrt(h2) : 0.0;
#endif
#endif
#ifdef renormalize
  x = min(1.0, x);
#endif
#endif
#ifdef products
  float shine = whole_power(x);
#else
  float shine = power_of(x, power);
#endif
#ifdef masked_behind
  return at.facing > 0.0 ? shine : 0.0;
#else
  return shine;
#endif
}
#endif

// Of a light that reaches the surface, what the surface sends to the eye.
vec3 reflected_light(Surface s, Light l, View v, Arrival at) {
  vec3 albedo = s.albedo.rgb, color = color_of(l);
#ifdef diffuse_clamped
  float c = max(at.cosine, 0.0);
#else
  float c = at.cosine;
#endif
#ifdef diffuse_at_most_1
  c = min(1.0, c);
#endif
#ifdef shines
  float shine = highlight(s, v, at);
#endif
#ifdef own_gloss
  vec3 specular = s.specular;
#endif
#ifdef own_color
  vec3 specular = specular_color;
#endif
#ifdef shines_by_albedo
  float reflected = c + shine;
#endif
#ifdef order_albedo_last
#ifdef shines
  return (reflected * at.strength) * color;
#else
  return (c * at.strength) * color;
#endif
#else
#ifdef order_separate
  vec3 sum = ((c * albedo) * color) * at.strength;
#ifdef shines_by_albedo
  return sum + ((color * shine) * albedo) * at.strength;
#else
#ifdef shines
  return sum + ((color * shine) * specular) * at.strength;
#else
  return sum;
#endif
#endif
#else
#ifdef shines_by_albedo
  vec3 back = albedo * reflected;
#else
#ifdef shines
  vec3 back = albedo * c + specular * shine;
#else
  vec3 back = albedo * c;
#endif
#endif
#ifdef order_factored
  return back * (color * at.strength);
#endif
#ifdef order_with_ambient
  return (albedo * l.ambient + back * color) * at.strength;
#endif
#endif
#endif
}

vec3 light(Surface s, Light l, View v) {
#ifdef order_albedo_last
  vec3 ambient = color_of(l);
#else
  vec3 ambient = s.albedo.rgb * color_of(l);
#endif
#ifdef emission
  ambient = ambient * s.occlusion;
#endif
  if (l.type == light_type_ambient) return ambient;
  Arrival at = arrival(s, l);
#ifdef for_drivers
  vec3 added = reflected_light(s, l, v, at);
  return at.reaches ? added : vec3(0.0);
#else
  if (!at.reaches) return vec3(0.0);
#ifdef dark_behind
  if (!(at.facing > 0.0)) return vec3(0.0);
#endif
  return reflected_light(s, l, v, at);
#endif
}

#ifdef defines_reaches
bool reaches(Surface s, Light l, View v) {
  if (l.type == light_type_ambient) return false;
  Arrival at = arrival(s, l);
  return at.reaches && at.facing > 0.0;
}
#endif
#ifdef starts

vec3 start(Surface s, View v) {
#ifdef global_ambient_given
#ifdef order_albedo_last
  vec3 ambient = global_ambient;
#else
  vec3 ambient = s.albedo.rgb * global_ambient;
#endif
#ifdef emission
  return s.emission + ambient * s.occlusion;
#else
  return ambient;
#endif
#else
  return s.emission;
#endif
}
#endif
#ifdef finishes

vec4 finish(Surface s, View v, vec3 sum) {
#ifdef order_albedo_last
  vec3 color = sum * s.albedo.rgb;
#else
  vec3 color = sum;
#endif
#ifdef alpha_from_albedo
  vec4 result = vec4(color, s.albedo.a);
#else
  vec4 result = vec4(color, 1.0);
#endif
#ifdef clamp_result
  return clamp(result, 0.0, 1.0);
#else
  return result;
#endif
}
#endif
