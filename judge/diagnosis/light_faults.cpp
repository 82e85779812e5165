#include <algorithm>
#include <cmath>
#include <numbers>

#include "judge/diagnosis/picture_faults.h"
#include "judge/diagnosis/predicted_store.h"
#include "judge/diagnosis/triple.h"

namespace trueshade::oracle {

namespace {

using F = LightFault;

bool lamp(const Light& l) { return is_placed(l.type); }
bool has_lamps(const LightPass& p) { return std::any_of(p.lights.begin(), p.lights.end(), lamp); }
bool falls_off(const LightPass& p) { return has_lamps(p) && p.pipeline.light_model.falloff != Falloff::none; }
bool has_range(const LightPass& p) {
  const Falloff f = p.pipeline.light_model.falloff;
  const LightVolumes& v = p.pipeline.light_volumes;
  return has_lamps(p) && (f == Falloff::linear_range || f == Falloff::linear || f == Falloff::inverse_square ||
                          v.point != LightExtent::unbounded || v.spot != LightExtent::unbounded);
}
bool has_attenuation(const LightPass& p) {
  const Falloff f = p.pipeline.light_model.falloff;
  return has_lamps(p) && (f == Falloff::quadratic || f == Falloff::attenuation);
}
bool shines(const LightPass& p) { return p.pipeline.light_model.specular != Specular::none; }
bool squares(const LightPass& p) {
  const Falloff f = p.pipeline.light_model.falloff;
  return has_lamps(p) && (f == Falloff::quadratic || f == Falloff::attenuation || f == Falloff::inverse_square);
}
bool goes_by_distance(const LightPass& p) {
  const Falloff f = p.pipeline.light_model.falloff;
  return has_lamps(p) && f != Falloff::none && f != Falloff::inverse_square;
}
bool has_cones(const LightPass& p) {
  return p.pipeline.light_model.cone != Cone::none &&
         std::any_of(p.lights.begin(), p.lights.end(), [](const Light& l) { return is_spot(l.type); });
}
bool order_matters(const LightPass& p) {
  return p.lights.size() > 1 && info(p.pipeline.target).number_class == NumberClass::floating;
}
bool of_small_floats(const LightPass& p) { return info(p.pipeline.target).small_float(); }
bool stores_truncate(const LightPass& p) {
  return holds_codes(p) || (of_small_floats(p) && p.pipeline.gbuffer.half_round == HalfRound::nearest);
}
bool stores_nearest(const LightPass& p) {
  return of_small_floats(p) && p.pipeline.gbuffer.half_round == HalfRound::toward_zero;
}

void scale_intensity(LightPass& p, double f) { p.fault.intensity *= f; }
void scale_range(LightPass& p, double f) { p.fault.range *= f; }
void scale_attenuation(LightPass& p, double f) {
  for (Light& l : p.lights) l.attenuation.y *= float(f), l.attenuation.z *= float(f);
}
void scale_specular(LightPass& p, double f) { p.fault.specular *= f; }
void scale_diffuse(LightPass& p, double f) { p.fault.diffuse *= f; }
void scale_shininess(LightPass& p, double f) { p.fault.shininess *= f; }
void scale_position(LightPass& p, double f) { p.fault.position *= f; }
void other_falloff(LightPass& p, double f) { p.pipeline.light_model.falloff = Falloff(int(f)); }
void distance_once(LightPass& p, double) { p.fault.distance = F::Distance::once; }
void distance_squared(LightPass& p, double) { p.fault.distance = F::Distance::squared; }
void viewer_turned(LightPass& p, double) { p.fault.half = F::Half::viewer_turned; }
void light_turned(LightPass& p, double) { p.fault.half = F::Half::light_turned; }
void reflected(LightPass& p, double) { p.fault.half = F::Half::reflected; }
void viewer_far(LightPass& p, double) {
  p.pipeline.light_model.viewer = p.pipeline.light_model.viewer == Viewer::local ? Viewer::infinite : Viewer::local;
}
void other_mask(LightPass& p, double) {
  p.pipeline.light_model.specular_masked = !p.pipeline.light_model.specular_masked;
}
void other_length(LightPass& p, double) { p.pipeline.light_model.renormalize = !p.pipeline.light_model.renormalize; }
void no_specular(LightPass& p, double) { p.fault.specular = 0; }
void round_normals(LightPass& p, double codes) { p.fault.normal_codes = codes; }
void turn_normals(LightPass& p, double) { p.fault.normal_turned = true; }
void normals_to_view(LightPass& p, double) { p.fault.normal_in_view = true; }
void unclamp(LightPass& p, double) { p.fault.cosine = F::Cosine::unclamped; }
void two_sided(LightPass& p, double) { p.fault.cosine = F::Cosine::two_sided; }
void half_lambert(LightPass& p, double) { p.fault.cosine = F::Cosine::half_lambert; }
void no_cosine(LightPass& p, double) { p.fault.cosine = F::Cosine::missing; }
void leave_out(LightPass& p, double light) { p.fault.missing = int64_t(light); }
void draw_twice(LightPass& p, double light) { p.fault.twice = int64_t(light); }
void at_most(LightPass& p, double count) { p.fault.most_lights = uint32_t(count); }
void at_most_here(LightPass& p, double count) { p.fault.most_at_pixel = uint32_t(count); }
void reverse_order(LightPass& p, double) { p.fault.reversed = !p.fault.reversed; }
void swap_colors(LightPass& p, double) { p.fault.swapped_colors = true; }
void mirror_z(LightPass& p, double) { p.fault.mirrored_z = true; }
void no_ambient(LightPass& p, double) { p.fault.no_ambient = true; }
void scale_ambient(LightPass& p, double f) {
  p.pipeline.light_model.global_ambient *= float(f);
  for (Light& l : p.lights) {
    l.ambient *= float(f);
    if (is_ambient(l.type)) l.color *= float(f);
  }
}
void no_emission(LightPass& p, double) { p.pipeline.light_model.emission = false; }
bool emits(const LightPass& p) { return p.pipeline.light_model.emission; }
template <int K>
void mirror(LightPass& p, double) {
  for (Light& l : p.lights) l.position[K] = -l.position[K];
}
void no_range(LightPass& p, double) { p.fault.range = 1e6; }
void drop_cones(LightPass& p, double) { p.fault.cone_dropped = true; }
void newton_root(LightPass& p, double) { p.fault.root = F::Root::one_newton_step; }
void short_root(LightPass& p, double) { p.fault.root = F::Root::twelve_bits; }
void half_sums(LightPass& p, double) { p.fault.sum = F::Sum::halves; }
void truncate(LightPass& p, double) { p.fault.store = F::Store::truncated; }
void to_nearest(LightPass& p, double) { p.fault.store = F::Store::nearest; }
void round_up(LightPass& p, double) { p.fault.store = F::Store::upward; }
void codes_per_light(LightPass& p, double) {
  p.pipeline.strategy = blends_lights(p.pipeline.strategy) ? Strategy::deferred_loop : Strategy::deferred_volumes;
}
void scale_near(LightPass& p, double f) { p.fault.near *= f; }
void scale_far(LightPass& p, double f) { p.fault.far *= f; }
bool rebuilds_positions(const LightPass& p) {
  return p.pipeline.gbuffer.position_from_depth && !p.camera.clip_from_world;
}
void nothing(LightPass&, double) {}
void scale_cones(LightPass& p, double f) {
  for (Light& l : p.lights) l.cone_rad *= float(f), l.penumbra_rad *= float(f);
}
bool has_direction(const Light& l) { return row_of(l.type).is_aimed; }
bool is_flat(const Light& l) { return has_area(l.type) && has_direction(l); }
void turn_directions(LightPass& p, double) {
  for (Light& l : p.lights) {
    l.direction = -l.direction;
    if (is_flat(l)) l.right = -l.right;
  }
}
bool has_areas(const LightPass& p) {
  return std::any_of(p.lights.begin(), p.lights.end(), [](const Light& l) { return has_area(l.type); });
}
bool has_flats(const LightPass& p) { return std::any_of(p.lights.begin(), p.lights.end(), is_flat); }
double length_of(const glm::vec3& v) { return std::sqrt(inner(triple(v), triple(v))); }
double area_of(const Light& l) {
  const double right = length_of(l.right), up = length_of(l.up);
  if (l.type == LightType::sphere) return std::numbers::pi * right * right;  // as it is seen
  if (l.type == LightType::disk) return std::numbers::pi * right * up;
  return 4 * right * up;
}
void scale_extents(LightPass& p, double f) {
  for (Light& l : p.lights) l.right *= float(f), l.up *= float(f);
}
void swap_extents(LightPass& p, double) {
  for (Light& l : p.lights)
    if (l.type == LightType::rectangle) {
      const double right = length_of(l.right), up = length_of(l.up);
      l.right *= float(up / right), l.up *= float(right / up);
    }
}
void shine_to_both_sides(LightPass& p, double) {
  std::vector<Light> turned;
  for (const Light& l : p.lights)
    if (is_flat(l)) turned.push_back(l), turned.back().right = -l.right, turned.back().direction = -l.direction;
  p.lights.insert(p.lights.end(), turned.begin(), turned.end());
}
void by_power(LightPass& p, double) {
  for (Light& l : p.lights)
    if (has_area(l.type)) l.color *= float(1 / area_of(l));
}
void as_points(LightPass& p, double) {
  for (Light& l : p.lights)
    if (has_area(l.type)) l.color *= float(area_of(l)), l.type = LightType::point;
}
void positions_as_halves(LightPass& p, double) {
  for (Light& l : p.lights)
    for (int k = 0; k < 3; ++k)
      l.position[k] = float(rounded_to(double(l.position[k]), 10, -14, LightFault::Store::nearest));
}
void positions_in_view(LightPass& p, double) {
  for (Light& l : p.lights) {
    const Triple3 d = minus(triple(l.position), triple(p.camera.eye));
    for (size_t k = 0; k < 3; ++k) l.position[int(k)] = float(inner(p.view[k], d));
  }
}

using Vector = std::array<double, 3>;
void move_light(Light& l, const Vector& v) { l.position += vec3_of(v); }
void turn_light(Light& l, const Vector& v) {
  const glm::vec3 d = l.direction + vec3_of(v);
  const float length = std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
  if (length > 0) l.direction = d * (1 / length);
}
void color_light(Light& l, const Vector& v) { l.color *= vec3_of(v); }
void move_lights(LightPass& p, const Vector& v) {
  for (Light& l : p.lights) l.position += vec3_of(v);
}
void color_lights(LightPass& p, const Vector& v) {
  for (Light& l : p.lights) l.color *= vec3_of(v);
}
void move_viewer(LightPass& p, const Vector& v) { p.camera.eye += vec3_of(v); }
void positions_from_eye(LightPass& p, double) {
  for (Light& l : p.lights) l.position -= p.camera.eye;
}
/// Keeps one of each `step` lights.
void thin_out(LightPass& p, double step) {
  std::vector<Light> left;
  for (size_t i = 0; i < p.lights.size(); i += size_t(step)) left.push_back(p.lights[i]);
  p.lights = std::move(left);
}
/// Numbers of the light, times those of the vector.
void scale_reach(Light& l, const Vector& v) { l.range *= float(v[0]); }
void scale_cone(Light& l, const Vector& v) { l.cone_rad *= float(v[0]), l.penumbra_rad *= float(v[1]); }
void scale_exponent(Light& l, const Vector& v) { l.spot_exponent *= float(v[0]); }
void scale_falloff(Light& l, const Vector& v) { l.attenuation *= glm::vec3(1.0f, float(v[0]), float(v[1])); }
bool reaches(const Light& l) { return lamp(l) && std::isfinite(l.range); }
bool spot(const Light& l) { return is_spot(l.type); }
bool any_light(const Light&) { return true; }
bool has_directions(const LightPass& p) { return std::any_of(p.lights.begin(), p.lights.end(), has_direction); }

bool has_ambient(const LightPass& p) {
  const auto ambient = [](const Light& l) { return is_ambient(l.type); };
  return std::any_of(p.lights.begin(), p.lights.end(), ambient) ||
         p.pipeline.light_model.global_ambient != glm::vec3(0.0f) ||
         p.pipeline.light_model.order == TermOrder::with_ambient;
}
bool several(const LightPass& p) { return p.lights.size() > 1; }
bool shines_local(const LightPass& p) { return shines(p); }
bool shines_locally(const LightPass& p) { return shines(p) && p.pipeline.light_model.viewer == Viewer::local; }
bool sums_once(const LightPass& p) {
  return of_small_floats(p) ? false : several(p) && !blends_lights(p.pipeline.strategy);
}
bool lists_tiles(const LightPass& p) { return several(p) && has_range(p) && !is_forward(p.pipeline.strategy); }

constexpr double kSpecularFactors[] = {0.25, 0.5, 2, 4};
constexpr double kLightingPlaneFactors[] = {0.1, 0.2, 0.5, 0.8, 1.25, 2, 5, 10};
constexpr double kShininessFactors[] = {0.25, 0.5, 0.97, 1.03, 2, 4};
constexpr double kFalloffNumbers[] = {0, 1, 2, 3, 4, 5};
constexpr double kNormalCodes[] = {255, 1023};
constexpr double kStrides[] = {2, 3, 4};
constexpr double kTiles[] = {0, 1, 2, 3, 4, 5, 6, 7},
                 kListed[] = {1, 2, 3, 4, 6, 8, 10, 12, 16, 20, 24, 32, 64, 128, 256};

std::string falloff_name(double f) {
  constexpr const char* kNames[] = {"linear_range", "quadratic", "none", "linear", "attenuation", "inverse_square"};
  return kNames[std::clamp(int(f), 0, 5)];
}
std::string neighbour_name(double at) {
  constexpr const char* kNames[] = {"right of them",      "left of them",       "below them",
                                    "above them",         "below to the right", "below to the left",
                                    "above to the right", "above to the left"};
  return kNames[std::clamp(int(at), 0, 7)];
}

constexpr PictureFault lists_of_other_tiles(int side, std::string_view name, std::string_view text) {
  return {.name = name,
          .text = text,
          .light = nothing,
          .can = lists_tiles,
          .search = Search::one_of,
          .starts = kTiles,
          .tile = side,
          .says = neighbour_name};
}

constexpr PictureFault full_lists(int side, std::string_view name, std::string_view text) {
  return {.name = name,
          .text = text,
          .light = nothing,
          .can = lists_tiles,
          .search = Search::one_of,
          .starts = kListed,
          .tile = side,
          .counts = true};
}

constexpr PictureFault stale_tiles(int side, std::string_view name, std::string_view text) {
  return {.name = name, .text = text, .light = nothing, .stale = side};
}

// What a light's numbers may be times, to begin with.
constexpr Vector kReaches[] = {{0.5, 1, 1}, {0.75, 1, 1}, {0.9, 1, 1}, {1.1, 1, 1}, {1.3, 1, 1}, {2, 1, 1}};
constexpr Vector kCones[] = {{0.5, 1, 1}, {0.75, 1, 1}, {0.9, 0.9, 1}, {1.1, 1.1, 1}, {1.25, 1, 1}, {2, 1, 1},
                             {8, 1, 1},   {1, 0.5, 1},  {1, 2, 1},     {0.5, 0.5, 1}, {2, 2, 1}};
constexpr Vector kExponentsOfOne[] = {{0.5, 1, 1}, {2, 1, 1}, {4, 1, 1}};
constexpr Vector kFalloffsOfOne[] = {{0.5, 0.5, 1}, {2, 2, 1}, {0.5, 1, 1}, {2, 1, 1}, {1, 0.5, 1}, {1, 2, 1}};

constexpr double kNumberCost = 0.004;  ///< what a number more than one must earn

constexpr PictureFault of_one(std::string_view name, std::string_view text, bool (*can)(const LightPass&),
                              void (*change)(Light&, const Vector&), bool (*of_light)(const Light&), int numbers = 3,
                              double start = 0, std::span<const Vector> from = {}) {
  return {.name = name,
          .text = text,
          .can = can,
          .search = Search::one_light,
          .doubt = numbers * kNumberCost,
          .one_light = change,
          .of_light = of_light,
          .start = start,
          .numbers = numbers,
          .from = from};
}
constexpr PictureFault of_all(std::string_view name, std::string_view text, bool (*can)(const LightPass&),
                              void (*change)(LightPass&, const Vector&), double start = 0) {
  return {.name = name,
          .text = text,
          .can = can,
          .search = Search::vector,
          .doubt = 3 * kNumberCost,
          .start = start,
          .by_vector = change};
}

// name, text, light, value, can, search, starts, move, doubt, reach
constexpr PictureFault kLightFaults[] = {
    {"light-intensity", "the lights are %s times as bright as they should be", scale_intensity, nullptr, has_lamps,
     Search::smooth, kFactorsNearOne},
    {"light-range", "the lights' range is %s times what it should be", scale_range, nullptr, has_range, Search::smooth,
     kFactorsNearOne},
    {"light-attenuation", "the lights' linear and quadratic attenuation are %s times what they should be",
     scale_attenuation, nullptr, has_attenuation, Search::smooth, kFactorsNearOne},
    {"light-position", "the lights' positions are %s times what they should be", scale_position, nullptr, has_lamps,
     Search::smooth, kFactorsNearOne},
    {"light-mirrored-z", "the lights' z has the wrong sign", mirror_z, nullptr, has_lamps},
    {"light-colors-bgr", "the lights' colours are in the order BGR", swap_colors},
    {"falloff-distance-once", "the falloff uses d where d^2 is due", distance_once, nullptr, squares},
    {"falloff-distance-squared", "the falloff uses d^2 where d is due", distance_squared, nullptr, goes_by_distance},
    {"falloff-other", "the falloff is `%s`", other_falloff, nullptr, falls_off, Search::one_of, kFalloffNumbers,
     nullptr, 0, 0, 0, falloff_name},
    {"cone-dropped", "spot lights shine in all directions", drop_cones, nullptr, has_cones},
    {"half-vector-viewer", "the half vector is L - V: the viewer's direction has the wrong sign", viewer_turned,
     nullptr, shines},
    {"half-vector-light", "the half vector is V - L: the light's direction has the wrong sign", light_turned, nullptr,
     shines},
    {"specular-reflected", "the highlight is of the other kind: R.V for N.H, or N.H for R.V", reflected, nullptr,
     shines},
    {"specular-viewer", "the highlight's viewer is at infinity for a local one, or the other way round", viewer_far,
     nullptr, shines_local},
    {"specular-mask", "the highlight is not left out where N.L is not positive, or is where it should stay", other_mask,
     nullptr, shines},
    {"specular-missing", "there is no highlight", no_specular, nullptr, shines},
    {"specular-factor", "the highlight is %s times as strong as it should be", scale_specular, nullptr, shines,
     Search::smooth, kSpecularFactors, nullptr, 0.01},
    {"shininess", "the shininess is %s times what it should be", scale_shininess, nullptr, shines, Search::smooth,
     kShininessFactors},
    {"diffuse-factor", "the diffuse term is %s times what it should be", scale_diffuse, nullptr, has_lamps,
     Search::smooth, kFactorsNearOne, nullptr, 0.01},
    {"lighting-normal-length",
     "the light pass leaves normals unnormalised, or normalises those that it should take as they are", other_length},
    {"lighting-normal-rounded", "the light pass reads normals rounded to %s steps", round_normals, nullptr, nullptr,
     Search::one_of, kNormalCodes},
    {"lighting-normal-turned", "the light pass turns normals round", turn_normals},
    {"lighting-normal-in-view", "the light pass takes normals in view space for normals in the world", normals_to_view},
    {"diffuse-unclamped", "N.L is not clamped to 0, or is where it should not be", unclamp},
    {"diffuse-two-sided", "N.L counts by its magnitude", two_sided},
    {"diffuse-half-lambert", "N.L is replaced by (N.L / 2 + 1/2)^2", half_lambert},
    {"diffuse-missing", "N.L is missing", no_cosine},
    {"ambient-factor", "the ambient light is %s times as bright as it should be", scale_ambient, nullptr, has_ambient,
     Search::smooth, kFactorsNearOne},
    {"emission-missing", "surfaces do not emit", no_emission, nullptr, emits},
    {"light-mirrored-x", "the lights' x has the wrong sign", mirror<0>, nullptr, has_lamps},
    {"light-mirrored-y", "the lights' y has the wrong sign", mirror<1>, nullptr, has_lamps},
    {"light-range-missing", "the lights have no range", no_range, nullptr, has_range},
    {"ambient-missing", "there is no ambient light", no_ambient, nullptr, has_ambient},
    {"light-missing", "light %s is missing", leave_out, nullptr, nullptr, Search::missing_light},
    {"light-twice", "light %s is drawn twice", draw_twice, nullptr, nullptr, Search::doubled_light},
    {"light-count", "only the first %s lights are drawn", at_most, nullptr, several, Search::count},
    {"light-count-pixel", "only the first %s lights in range of a pixel are drawn", at_most_here, nullptr, several,
     Search::count_at_pixel},
    of_one("light-moved", "light %s is moved by %v", has_lamps, move_light, lamp),
    of_one("light-turned", "%v is added to the direction of light %s", has_directions, turn_light, has_direction),
    of_one("light-colored", "the colour of light %s is %v times what it should be", several, color_light, any_light, 3,
           1),
    of_one("light-reach", "the range of light %s is %v times what it should be", has_range, scale_reach, reaches, 1, 1,
           kReaches),
    of_one("light-cone", "the cone and the penumbra of light %s are %v times as wide as they should be", has_cones,
           scale_cone, spot, 2, 1, kCones),
    of_one("light-exponent", "the exponent of the cone of light %s is %v times what it should be", has_cones,
           scale_exponent, spot, 1, 1, kExponentsOfOne),
    of_one("light-falloff", "the linear and the quadratic attenuation of light %s are %v times what they should be",
           has_attenuation, scale_falloff, lamp, 2, 1, kFalloffsOfOne),
    {"lighting-near", "positions are rebuilt from depths with a near plane %s times as far as it is", scale_near,
     nullptr, rebuilds_positions, Search::smooth, kLightingPlaneFactors},
    {"lighting-far", "positions are rebuilt from depths with a far plane %s times as far as it is", scale_far, nullptr,
     rebuilds_positions, Search::smooth, kLightingPlaneFactors},
    {"light-cones", "all cones are %s times as wide as they should be", scale_cones, nullptr, has_cones, Search::smooth,
     kSpecularFactors},
    {"light-directions-turned", "the lights' directions have the wrong sign", turn_directions, nullptr, has_directions},
    {"light-extents", "the extents of lights with an area are %s times what they should be", scale_extents, nullptr,
     has_areas, Search::smooth, kSpecularFactors},
    {"light-extents-swapped", "the two extents of rectangles are swapped", swap_extents, nullptr, has_flats},
    {"light-both-sides", "lights with an area shine to both sides where they should shine to one", shine_to_both_sides,
     nullptr, has_flats},
    {"light-power", "the radiance of lights with an area is divided by the area", by_power, nullptr, has_areas},
    {"light-as-point", "lights with an area are drawn as points of the same intensity", as_points, nullptr, has_areas},
    of_all("lights-moved", "all lights are moved by %v", has_lamps, move_lights),
    of_all("lights-colored", "the colours of all lights are %v times what they should be", has_lamps, color_lights, 1),
    of_all("lighting-eye", "the viewer of highlights is moved by %v", shines_locally, move_viewer),
    {"light-positions-from-eye", "the lights' positions are relative to the eye", positions_from_eye, nullptr,
     has_lamps},
    {"light-stride", "of %s lights one is drawn", thin_out, nullptr, several, Search::one_of, kStrides},
    {"light-positions-half", "the lights' positions are rounded to half floats", positions_as_halves, nullptr,
     has_lamps},
    {"light-positions-view", "the lights' positions are in view space", positions_in_view, nullptr, has_lamps},
    {.name = "light-order",
     .text = "the lights are drawn in the opposite order",
     .light = reverse_order,
     .can = order_matters,
     .doubt = 0.02},
    lists_of_other_tiles(8, "tile-lists-8", "tiles of 8x8 pixels are lit by the lists of the tiles %s"),
    lists_of_other_tiles(16, "tile-lists-16", "tiles of 16x16 pixels are lit by the lists of the tiles %s"),
    lists_of_other_tiles(32, "tile-lists-32", "tiles of 32x32 pixels are lit by the lists of the tiles %s"),
    lists_of_other_tiles(64, "tile-lists-64", "tiles of 64x64 pixels are lit by the lists of the tiles %s"),
    full_lists(8, "tile-count-8", "tiles of 8x8 pixels are lit by the first %s lights that reach them"),
    full_lists(16, "tile-count-16", "tiles of 16x16 pixels are lit by the first %s lights that reach them"),
    full_lists(32, "tile-count-32", "tiles of 32x32 pixels are lit by the first %s lights that reach them"),
    full_lists(64, "tile-count-64", "tiles of 64x64 pixels are lit by the first %s lights that reach them"),
    stale_tiles(8, "tile-stale-8", "a few tiles of 8x8 pixels hold something else"),
    stale_tiles(16, "tile-stale-16", "a few tiles of 16x16 pixels hold something else"),
    stale_tiles(32, "tile-stale-32", "a few tiles of 32x32 pixels hold something else"),
    stale_tiles(64, "tile-stale-64", "a few tiles of 64x64 pixels hold something else"),
    {"root-newton", "reciprocal square roots are estimated with one step of Newton's", newton_root},
    {"root-12-bits", "reciprocal square roots have 12 bits", short_root},
    {"sum-halves", "the lights are summed in half precision", half_sums, nullptr,
     [](const LightPass& p) { return several(p) && !blends_lights(p.pipeline.strategy); }},
    {"store-truncated", "stores truncate", truncate, nullptr, stores_truncate},
    {"store-nearest", "halves are rounded to nearest", to_nearest, nullptr, stores_nearest},
    {"store-upward", "stores round upward", round_up, nullptr, nullptr, Search::none, {}, nullptr, 0.01},
    {"store-per-light", "each light is rounded where the sum should be, or the sum where each light should be",
     codes_per_light, nullptr, sums_once},
};

}  // namespace

std::span<const PictureFault> light_faults() { return kLightFaults; }

}  // namespace trueshade::oracle
