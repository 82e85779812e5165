// What a light program is given. The user's file follows this text.

struct Surface {              // what a pixel of the G-buffer holds, in world space
  vec3 position;
  vec3 normal;                // as stored: of unit length only as far as its format keeps it
  vec4 albedo;
  vec3 specular;
  float shininess;
  float metallic, roughness, occlusion;
  vec3 emission;
  vec2 uv, uv1;
  vec4 tangent;
  uint object, material, pixel_x, pixel_y;
  vec4 user[4];               // planes of a capture
};

struct Light {
  uint type, index;           // type: one of the constants below; index: its place in the scene
  vec3 position;
  float range;
  vec3 direction;             // the way the light travels
  vec3 color;
  vec3 attenuation;
  vec3 ambient;
  float cone, penumbra;       // radians
  float cos_inner, cos_outer, cone_scale, cone_offset, spot_exponent;  // made in double, rounded once
  float penumbra_slope;       // 1 / (cos_inner - cos_outer), as are
  float cutoff_slope;         // 1 / (e - cos_outer), e = 0.9 cos_outer + 0.1: the lit edge of a "smooth_cutoff" cone
  vec3 right, up;             // half extents of area lights; a sphere's radius is right.x
  int shadow, cookie;         // numbers of textures, -1: none
  vec4 user[4];
};

const uint light_type_ambient = 0u, light_type_directional = 1u, light_type_point = 2u;
const uint light_type_spot = 3u, light_type_sphere = 4u, light_type_tube = 5u;
const uint light_type_rectangle = 6u, light_type_disk = 7u;

struct View {
  vec3 eye, axis;             // axis: the way the camera looks
  mat4 view, projection, view_projection;
  vec2 size;                  // of the picture, pixels
  float time;                 // seconds
  uint frame;
};
