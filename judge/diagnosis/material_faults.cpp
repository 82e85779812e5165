// What people get wrong of materials: their colours, their masks, and how their maps are read.
#include <algorithm>
#include <cmath>
#include <map>

#include "judge/diagnosis/plane_evidence.h"
#include "judge/diagnosis/triple.h"

namespace trueshade::oracle {

namespace {

using P = FaultParameter;
using Suspects = std::vector<FaultParameter>;

glm::vec4 vec4_of(const Triple3& v) { return {float(v[0]), float(v[1]), float(v[2]), 1.0f}; }

bool tint_object(Scene& s, Pipeline&, const P& p) {
  if (!(p.number < double(s.instances.size())) || p.vector == Triple3{1, 1, 1}) return false;
  Instance& object = s.instances[size_t(p.number)];
  s.materials.push_back(s.materials[object.material]);
  object.material = uint32_t(s.materials.size() - 1);
  s.materials.back().base_color *= vec4_of(p.vector);
  return true;
}

bool tint_material(Scene& s, Pipeline&, const P& p) {
  if (!(p.number < double(s.materials.size())) || p.vector == Triple3{1, 1, 1}) return false;
  s.materials[size_t(p.number)].base_color *= vec4_of(p.vector);
  return true;
}

bool cut_alpha(Scene& s, Pipeline&, const P& p) {
  if (!(p.number < double(s.materials.size())) || !(p.vector[0] >= 0) || p.vector[0] > 1) return false;
  float& cutoff = s.materials[size_t(p.number)].alpha_cutoff;
  if (cutoff == float(p.vector[0])) return false;
  cutoff = float(p.vector[0]);
  return true;
}

bool other_color_map(Scene& s, Pipeline&, const P& p) {
  if (!(p.number < double(s.materials.size())) || !(p.part < double(s.textures.size()))) return false;
  TextureSlot& slot = s.materials[size_t(p.number)].color_map;
  if (!slot.used() || slot.texture == int32_t(p.part)) return false;
  slot.texture = int32_t(p.part);
  return true;
}

/// Moves what the colour maps are read at, by texels, in a set of coordinates of its own, so that those of the plane
/// stay. False where there is no colour map.
bool offset_texels(Scene& s, Pipeline&, const P& p) {
  if (p.vector == Triple3{}) return false;
  constexpr size_t kOwn = kMaxUvSets - 1;
  bool any = false;
  std::vector<Mesh> meshes;
  for (Instance& object : s.instances) {
    const TextureSlot& slot = s.materials[object.material].color_map;
    if (!slot.used() || slot.uv_set == kOwn) continue;
    const TextureLevel& level = s.textures[size_t(slot.texture)].levels[0];
    Mesh mesh = s.meshes[object.mesh];
    UvStreams uv = mesh.uv_set(slot.uv_set);
    for (size_t k = 0; k < 2; ++k)
      for (float& v : uv[k]) v += float(p.vector[k] / (k == 0 ? level.width : level.height));
    mesh.more_uv.resize(kOwn);
    mesh.more_uv[kOwn - 1] = std::move(uv);
    object.mesh = uint32_t(s.meshes.size() + meshes.size());
    meshes.push_back(std::move(mesh));
    any = true;
  }
  for (Mesh& mesh : meshes) s.meshes.push_back(std::move(mesh));
  for (Material& m : s.materials)
    if (m.color_map.used()) m.color_map.uv_set = uint8_t(kOwn);
  return any;
}

/// Moves the texture coordinates of all meshes, which the plane shows too.
bool offset_uv(Scene& s, Pipeline&, const P& p) {
  for (Mesh& mesh : s.meshes)
    for (size_t k = 0; k < 2; ++k)
      for (float& v : mesh.uv[k]) v += float(p.vector[k]);
  return p.vector != Triple3{};
}
bool scale_uv(Scene& s, Pipeline&, const P& p) {
  for (Mesh& mesh : s.meshes)
    for (size_t k = 0; k < 2; ++k)
      for (float& v : mesh.uv[k]) v *= float(p.vector[k]);
  return p.vector != Triple3{1, 1, 0} && p.vector[0] != 0 && p.vector[1] != 0;
}

/// Calls change(texture) for each texture that is read as normals, once. Returns whether any call returned true.
template <class Change>
bool change_normal_maps(Scene& s, const Change& change) {
  std::vector<uint8_t> done(s.textures.size());
  bool any = false;
  for (const Material& m : s.materials) {
    if (!m.normal_map.used() || done[size_t(m.normal_map.texture)] != 0) continue;
    done[size_t(m.normal_map.texture)] = 1;
    any = change(s.textures[size_t(m.normal_map.texture)]) || any;
  }
  return any;
}
bool has_codes(const Texture& t) { return t.format == TextureFormat::rgba8 || t.format == TextureFormat::srgb8_a8; }

/// Turns a channel's codes of all normal maps round: 255 - code. False where no normal map has codes.
template <size_t Channel>
bool turn_channel(Scene& s, Pipeline&, double) {
  return change_normal_maps(s, [](Texture& t) {
    if (!has_codes(t)) return false;
    for (TextureLevel& level : t.levels)
      for (size_t i = Channel; i < level.bytes.size(); i += 4) level.bytes[i] = uint8_t(255 - level.bytes[i]);
    return true;
  });
}
bool decode_normal_maps(Scene& s, Pipeline&, double) {
  return change_normal_maps(s, [](Texture& t) {
    if (!has_codes(t)) return false;
    t.format = t.format == TextureFormat::rgba8 ? TextureFormat::srgb8_a8 : TextureFormat::rgba8;
    return true;
  });
}
bool no_normal_maps(Scene& s, Pipeline&, double) {
  bool any = false;
  for (Material& m : s.materials) any = any || m.normal_map.used(), m.normal_map.texture = -1;
  return any;
}
/// Calls change(mesh) for each object whose mesh has tangents and whose material has a normal map. Returns whether any
/// call returned true.
template <class Change>
bool change_tangents(Scene& s, const Change& change) {
  bool any = false;
  for (const Instance& object : s.instances) {
    Mesh& mesh = s.meshes[object.mesh];
    if (s.materials[object.material].normal_map.used() && mesh.has_tangents()) any = change(mesh) || any;
  }
  return any;
}
/// Deletes the tangents and turns green round: the frames of triangles have green along v, which runs downward in
/// glTF's pictures, and tangents have it upward.
bool no_tangents(Scene& s, Pipeline& p, double) {
  const bool any = change_tangents(s, [](Mesh& mesh) {
    mesh.tangent = {};
    return true;
  });
  return any && turn_channel<1>(s, p, 0);
}
bool no_tangent_signs(Scene& s, Pipeline&, double) {
  return change_tangents(s, [](Mesh& mesh) {
    bool any = false;
    for (float& w : mesh.tangent[3]) any = any || w < 0, w = std::fabs(w);
    return any;
  });
}
bool scale_normal_maps(Scene& s, Pipeline&, double f) {
  bool any = false;
  for (Material& m : s.materials) any = any || m.normal_map.used(), m.normal_scale *= float(f);
  return any;
}

// --- which, and by how much

/// The two keys, at most, with the most wrong pixels. key(pixel): the number of a material or an object; below 0: none.
template <class Key>
std::vector<double> most_wrong(const PlaneEvidence& e, const Key& key) {
  std::map<double, double> votes;
  for (const EvidentPixel& p : e.pixels)
    if (p.wrong && key(p) >= 0) votes[key(p)] += p.at.weight;
  std::vector<std::pair<double, double>> ranked;
  for (const auto& [what, weight] : votes) ranked.emplace_back(-weight, what);
  std::sort(ranked.begin(), ranked.end());
  std::vector<double> best;
  for (size_t i = 0; i < std::min<size_t>(2, ranked.size()); ++i) best.push_back(ranked[i].second);
  return best;
}
double object_at(const EvidentPixel& p) { return p.expected.covered ? p.expected.object - 1 : -1; }
double given_material_at(const EvidentPixel& p) { return p.given.material - 1; }
double material_at(const EvidentPixel& p) { return p.expected.covered ? p.expected.material - 1 : -1; }

/// The two likeliest keys, each with factors of the albedo's channels, by least squares. Empty where albedo was not
/// captured.
template <class Key>
Suspects tinted(const PlaneEvidence& e, const Key& key) {
  Suspects all;
  if (!e.has_plane(Plane::albedo)) return all;
  for (const double which : most_wrong(e, key)) {
    Triple3 factors{1, 1, 1};
    for (size_t k = 0; k < 3; ++k) {
      double product = 0, square = 0;
      for (const EvidentPixel& p : e.pixels) {
        if (key(p) != which || p.given.object == 0) continue;
        product += p.given.albedo[k] * p.expected.albedo[k], square += p.expected.albedo[k] * p.expected.albedo[k];
      }
      if (square > 0) factors[k] = product / square;
    }
    Triple3 rounded = factors;
    for (double& f : rounded) f = std::nearbyint(f * 100) / 100;
    all.push_back(P(which, rounded)), all.push_back(P(which, factors));
  }
  return all;
}
Suspects tinted_objects(const PlaneEvidence& e) { return tinted(e, object_at); }
Suspects tinted_materials(const PlaneEvidence& e) { return tinted(e, material_at); }

Suspects masked_materials(const PlaneEvidence& e) {
  Suspects all;
  std::vector<double> materials;
  for (const double m : most_wrong(e, material_at)) materials.push_back(m);
  for (const double m : most_wrong(e, given_material_at)) materials.push_back(m);
  std::sort(materials.begin(), materials.end());
  materials.erase(std::unique(materials.begin(), materials.end()), materials.end());
  for (const double m : materials)
    if (m < double(e.scene.materials.size()) && e.scene.materials[size_t(m)].masked())
      for (const double cutoff : {0.0, 0.1, 0.2, 0.25, 0.3, 0.4, 0.5, 0.6, 0.75, 0.9})
        all.push_back(P(m, {cutoff, 0, 0}));
  return all;
}

Suspects with_another_map(const PlaneEvidence& e) {
  Suspects all;
  for (const double m : most_wrong(e, material_at))
    for (size_t t = 0; t < std::min<size_t>(4, e.scene.textures.size()); ++t) all.push_back(P(m, {}, double(t)));
  return all;
}

Suspects half_texels(const PlaneEvidence& e) {
  Suspects all;
  const bool textured = std::any_of(e.scene.materials.begin(), e.scene.materials.end(),
                                    [](const Material& m) { return m.color_map.used(); });
  for (const double x : {-0.5, 0.0, 0.5})
    for (const double y : {-0.5, 0.0, 0.5})
      if (textured && (x != 0 || y != 0)) all.push_back(P(0, {x, y, 0}));
  return all;
}

/// The median of number(pixel, k) over the pixels, of u (k = 0) and of v (k = 1): rounded, and as it is. Empty where uv
/// was not captured.
template <class Number>
Suspects middle_of(const PlaneEvidence& e, const Number& number) {
  Triple3 found{};
  for (size_t k = 0; k < 2 && e.has_plane(Plane::uv); ++k) {
    std::vector<double> all;
    for (const EvidentPixel& p : e.pixels)
      if (p.given.covered && p.expected.covered && std::isfinite(number(p, k))) all.push_back(number(p, k));
    if (all.empty()) return {};
    std::nth_element(all.begin(), all.begin() + ptrdiff_t(all.size() / 2), all.end());
    found[k] = all[all.size() / 2];
  }
  Triple3 rounded = found;
  for (double& f : rounded) f = std::nearbyint(f * 1e4) / 1e4;
  return e.has_plane(Plane::uv) ? Suspects{P(0, rounded), P(0, found)} : Suspects{};
}
Suspects offsets_of_uv(const PlaneEvidence& e) {
  return middle_of(e, [](const EvidentPixel& p, size_t k) { return p.given.uv[k] - p.expected.uv[k]; });
}
Suspects factors_of_uv(const PlaneEvidence& e) {
  return middle_of(e, [](const EvidentPixel& p, size_t k) { return p.given.uv[k] / p.expected.uv[k]; });
}

using Fault = PlaneFault;
constexpr double kMapScales[] = {0.25, 0.5, 1.5, 2, 4, -1};

constexpr PlaneFault suspected(std::string_view name, std::string_view text, bool (*edit)(Scene&, Pipeline&, const P&),
                               Suspects (*suspects)(const PlaneEvidence&), ParameterForm numbers, PlaneFault::Of of,
                               bool estimated = false) {
  return {.name = name,
          .text = text,
          .search = Fault::Search::suspected,
          .edit = edit,
          .suspects = suspects,
          .numbers = numbers,
          .of = of,
          .estimated = estimated};
}
constexpr PlaneFault redrawn(std::string_view name, std::string_view text, bool (*redraw)(Scene&, Pipeline&, double)) {
  return {.name = name, .text = text, .redraw = redraw};
}
constexpr auto kMaterial = Fault::Of::material;

constexpr PlaneFault kMaterialFaults[] = {
    suspected("object-color", "the colour of object %s is %v times what it should be", tint_object, tinted_objects,
              {true, false, 3}, Fault::Of::object, true),
    suspected("material-color", "the colour of material %s is %v times what it should be", tint_material,
              tinted_materials, {true, false, 3}, kMaterial, true),
    suspected("material-color-map", "material %s has the colour map %p", other_color_map, with_another_map,
              {true, true, 0}, kMaterial),
    suspected("alpha-cutoff", "the cutoff of the alpha test of material %s is %v", cut_alpha, masked_materials,
              {true, false, 1}, kMaterial),
    suspected("texture-offset", "colour maps are read %v texels beside where they should be", offset_texels,
              half_texels, {false, false, 2}, Fault::Of::object),
    suspected("uv-offset", "%v is added to the texture coordinates", offset_uv, offsets_of_uv, {false, false, 2},
              Fault::Of::object, true),
    suspected("uv-scaled", "the texture coordinates are %v times what they should be", scale_uv, factors_of_uv,
              {false, false, 2}, Fault::Of::object, true),
    redrawn("normal-map-red", "the normal maps' X has the wrong sign", turn_channel<0>),
    redrawn("normal-map-green", "the normal maps' Y has the wrong sign", turn_channel<1>),
    redrawn("normal-map-srgb", "normal maps are decoded as if they were sRGB", decode_normal_maps),
    redrawn("normal-map-missing", "the normal maps are not read", no_normal_maps),
    redrawn("tangents-missing", "normal maps are laid along the texture coordinates, not along the model's tangents",
            no_tangents),
    redrawn("tangent-sign-missing", "the tangents' w is not read, so that mirrored parts have green turned",
            no_tangent_signs),
    {.name = "normal-map-scale",
     .text = "the normal maps' X and Y are %s times what they should be",
     .redraw = scale_normal_maps,
     .search = Fault::Search::one_of,
     .starts = kMapScales},
};

}  // namespace

std::span<const PlaneFault> material_faults() { return kMaterialFaults; }

}  // namespace trueshade::oracle
