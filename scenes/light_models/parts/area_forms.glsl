// Form factors of area lights: the integral of cos / pi over the directions in which a surface of the unit normal n sees
// the light, from 0 to 1. A light of radiance L gives the irradiance pi L F. c, right and up are seen from the surface.

// The angle over its sine, by its cosine from 0 to 1: a polynomial in 1 - c, fitted to within 1e-7.
float angle_over_sine(float c) {
  float t = 1.0 - c;
  return 1.0 + t * (0.33331966 + t * (0.133675 + t * (0.05387633 + t * (0.04086326 + t * (-0.02877811 +
         t * (0.06489242 + t * (-0.04518781 + t * 0.01813539)))))));
}

// An angle from 0 to pi by its cosine and its sine.
float angle_of(float c, float s) {
  return c >= 0.0 ? angle_over_sine(c) * s : pi - angle_over_sine(-c) * s;
}

// Lambert's sum over the edges of a polygon: of an edge from the direction a to b, both of unit length, its angle times
// the cosine between n and the normal of the plane through both and the surface.
float edge(vec3 a, vec3 b, vec3 n) {
  vec3 across = cross(a, b);
  float c = dot(a, b);
  float part = c >= 0.0 ? angle_over_sine(c) : pi / max(length(across), 1e-6) - angle_over_sine(-c);
  return part * dot(n, across);
}

// The part of an edge above the horizon, where dot(n, direction) > 0. `leaves` and `enters` become the directions in
// which the outline goes below the horizon and comes back.
float edge_above(vec3 a, vec3 b, vec3 n, inout vec3 leaves, inout vec3 enters) {
  float za = dot(n, a), zb = dot(n, b);
  vec3 between = normalize(a * abs(zb) + b * abs(za)), from = a, to = b;
  if (za <= 0.0 && zb <= 0.0) return 0.0;
  if (za < 0.0) from = enters = between;
  if (zb < 0.0) to = leaves = between;
  return edge(from, to, n);
}

// Lambert, Photometria (1760); the outline is closed along the horizon.
float rectangle_form(vec3 c, vec3 right, vec3 up, vec3 n) {
  vec3 p0 = normalize(c - right - up), p1 = normalize(c + right - up);
  vec3 p2 = normalize(c + right + up), p3 = normalize(c - right + up);
  vec3 leaves = p0, enters = p0;
  float sum = edge_above(p0, p1, n, leaves, enters) + edge_above(p1, p2, n, leaves, enters) +
              edge_above(p2, p3, n, leaves, enters) + edge_above(p3, p0, n, leaves, enters);
  return max(sum + edge(leaves, enters, n), 0.0) / (2.0 * pi);
}

// The same integral round a circle, c + r (cos p a + sin p b), for the part of it above the horizon: a is along the
// part of c in the circle's plane, and p goes from turn - half_arc to turn + half_arc.
//   |v|^2 = A + B cos p,   S^2 = A^2 - B^2,   d = atan(B sin p / (A + S + B cos p))
//   integrals over p, between its ends:  of 1 / |v|^2  (p - 2 d) / S,   of sin p / |v|^2  -ln(A + B cos p) / B
//   of cos p / |v|^2  2 A d / (B S) - B p / (S (A + S))
float disk_form(vec3 c, vec3 right, vec3 up, vec3 n) {
  float r = length(right);
  vec3 x = right / r, y = up / r, w = cross(x, y);
  vec2 flat_c = vec2(dot(c, x), dot(c, y));
  float off = length(flat_c), height = dot(c, w);
  vec2 along = off > 1e-6 * r ? flat_c / off : vec2(1.0, 0.0);
  vec3 a = x * along.x + y * along.y, b = y * along.x - x * along.y;
  float na = dot(n, a), nb = dot(n, b), nw = dot(n, w), tilt = length(vec2(na, nb));
  float q1 = height * height + (off - r) * (off - r), q2 = height * height + (off + r) * (off + r);
  float A = 0.5 * (q1 + q2), B = 2.0 * r * off, S = sqrt(q1 * q2);
  // Of the ends of the arc.
  float cos_half = clamp(-dot(n, c) / max(r * tilt, 1e-20), -1.0, 1.0);
  float sin_half = sqrt(max(1.0 - cos_half * cos_half, 0.0));
  vec2 turn = tilt > 1e-6 ? vec2(na, nb) / tilt : vec2(1.0, 0.0);
  vec2 p1 = vec2(turn.x * cos_half + turn.y * sin_half, turn.y * cos_half - turn.x * sin_half);
  vec2 p2 = vec2(turn.x * cos_half - turn.y * sin_half, turn.y * cos_half + turn.x * sin_half);
  float arc = 2.0 * angle_of(cos_half, sin_half);
  // d over B at either end.
  float k1 = p1.y / (A + S + B * p1.x), k2 = p2.y / (A + S + B * p2.x);
  float c1 = inversesqrt(1.0 + B * B * k1 * k1), c2 = inversesqrt(1.0 + B * B * k2 * k2);
  float d = k2 * (angle_over_sine(c2) * c2) - k1 * (angle_over_sine(c1) * c1);
  float ones = (arc - 2.0 * B * d) / S, cosines = 2.0 * A * d / S - B * arc / (S * (A + S));
  float low = A + B * p1.x, rise = (p2.x - p1.x) / low, part = B * rise;
  float sines = -rise * (abs(part) < 0.05 ? 1.0 - part * (0.5 - part * (1.0 / 3.0 - part * (0.25 - part * 0.2)))
                                          : log(1.0 + part) / part);
  vec3 v1 = normalize(c + r * (a * p1.x + b * p1.y)), v2 = normalize(c + r * (a * p2.x + b * p2.y));
  float sum = r * ((off * nw - height * na) * cosines - height * nb * sines) + r * r * nw * ones;
  return max(sum + edge(v2, v1, n), 0.0) / (2.0 * pi);
}

// Snyder, Area Light Sources for Real-Time Graphics (1996). A surface inside the sphere gets nothing.
float sphere_form(vec3 c, float r, vec3 n) {
  float d2 = dot(c, c), share = r * r / d2;
  if (!(share < 1.0)) return 0.0;
  float cosine = dot(n, c) * inversesqrt(d2), sine = sqrt(max(1.0 - cosine * cosine, 0.0));
  float x = sqrt(1.0 / share - 1.0), y = clamp(-x * cosine / max(sine, 1e-6), -1.0, 1.0);
  float root = sqrt(max(1.0 - y * y, 0.0)), w = sine * root, size = max(sqrt(x * x + w * w), 1e-20);
  return max((cosine * angle_of(y, root) - x * w) * share + angle_of(x / size, w / size), 0.0) / pi;
}

// Heitz and Hill, Linear-Light Shading with Linearly Transformed Cosines (2017): a tube as a line that is as wide as the
// tube is seen, so thin ones are exact; of others the error goes by (radius / distance)^2. Their ends are dark.
float tube_form(vec3 c, vec3 right, float r, vec3 n) {
  vec3 a = c - right, b = c + right, t = normalize(right);
  float za = dot(n, a), zb = dot(n, b);
  vec3 between = a + (b - a) * (abs(za) / max(abs(za) + abs(zb), 1e-30));
  if (za <= 0.0 && zb <= 0.0) return 0.0;
  if (za < 0.0) a = between;
  if (zb < 0.0) b = between;
  float la = dot(a, t), lb = dot(b, t), a2 = max(dot(a, a), r * r), b2 = max(dot(b, b), r * r);
  vec3 foot = a - t * la, ua = normalize(a), ub = normalize(b);
  float d = max(length(foot), r), angle = angle_of(dot(ua, ub), length(cross(ua, ub)));
  float sum = dot(n, foot) * ((lb / b2 - la / a2) / d + angle / (d * d)) + dot(n, t) * d * (1.0 / a2 - 1.0 / b2);
  return clamp(r * sum / pi, 0.0, 1.0);
}

// Of any area light; flat ones shine to the side of `direction` alone.
float form_factor(Light l, vec3 c, vec3 n) {
  if (l.type == light_type_sphere) return sphere_form(c, l.right.x, n);
  if (l.type == light_type_tube) return tube_form(c, l.right, l.up.x, n);
  if (!(dot(l.direction, c) < 0.0)) return 0.0;
  return l.type == light_type_disk ? disk_form(c, l.right, l.up, n) : rectangle_form(c, l.right, l.up, n);
}

bool has_area(Light l) { return l.type >= light_type_sphere; }

// The window of KHR_lights_punctual: 1 at the light's centre, 0 from its range on.
float window_of(Light l, vec3 c) {
  float part = dot(c, c) / (l.range * l.range);
  return clamp(1.0 - part * part, 0.0, 1.0);
}
