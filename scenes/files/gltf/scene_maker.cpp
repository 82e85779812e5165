#include "scenes/files/gltf/scene_maker.h"

#include <algorithm>
#include <bit>

#include "core/error.h"
#include "core/memory_cap.h"
#include "scenes/files/gltf/animations.h"
#include "scenes/files/gltf/instancing.h"
#include "scenes/files/gltf/lights_and_cameras.h"
#include "scenes/files/gltf/skins.h"
#include "scenes/lights_of_ours.h"
#include "scenes/scene_defaults.h"

namespace trueshade::gltf {

SceneMaker::SceneMaker(Buffers& buffers, const SceneFolder& folder, const SceneLimits& limits,
                       const ImageDecoder& decode, const SceneParts& parts, bool keeps_tangents)
    : document_(buffers.document()),
      limits_(limits),
      asked_(parts),
      keeps_tangents_(keeps_tangents),
      faults_(document_.faults),
      accessors_(buffers, limits),
      pictures_(buffers, folder, limits, decode, faults_, scene_),
      materials_(document_, pictures_, faults_, scene_),
      hierarchy_(hierarchy_of(document_, limits)) {}

Scene SceneMaker::make() {
  Timeline& timeline = scene_.timeline;
  scene_.spec = document_.file;
  scene_.photometric = true;
  scene_.is_model = true;
  choose_parts();
  prepare();
  pictures_.decode_all([this] { read_geometry_and_nodes(); });
  lose_textures(scene_, pictures_.lost());
  bake_uv(scene_, materials_.uv_sources(), [this](uint64_t bytes) { accessors_.take(bytes, "/meshes"); });
  set_time(scene_, 0.0);
  if (!timeline.node_camera) add_camera_of_ours(scene_);
  if (!moves()) timeline = Timeline{};
  if (scene_.lights.empty()) {
    add_lights_of_ours(scene_);
    if (scene_.camera_of_ours) turn_lamps(scene_, turn_of_side(scene_));
  }
  add_notes();
  faults_.tell(scene_);
  return std::move(scene_);
}

/// Before anything large is read, because they may be none of the file's.
void SceneMaker::choose_parts() {
  std::vector<uint32_t> places;
  for (uint32_t place = 0; place < hierarchy_.nodes.size(); ++place) {
    const NodeSource& node = document_.nodes[hierarchy_.nodes[place]];
    if (node.camera == kNone) continue;
    const CameraSource& camera = document_.cameras[node.camera];
    places.push_back(place);
    scene_.cameras.push_back(
        {camera.name, node.name, camera.type == CameraSource::Type::perspective ? camera.fov_y_rad : 0.0});
  }
  const size_t camera = asked_.camera ? camera_named(*asked_.camera, scene_.cameras, document_.file) : 0;
  if (!places.empty()) camera_place_ = places[camera];
  scene_.animations = animations_of(document_);
  animation_ = played_animation(document_, asked_.animation, passed_over_);
}

bool SceneMaker::moves() const {
  const Timeline& timeline = scene_.timeline;
  return !timeline.node_motions.empty() || std::any_of(timeline.posed.begin(), timeline.posed.end(),
                                                       [](const PosedMesh& p) { return p.motion.has_value(); });
}

void SceneMaker::add_node(uint32_t place) {
  const NodeSource& node = document_.nodes[hierarchy_.nodes[place]];
  if (node.mesh != kNone) add_mesh(place, node);
  if (node.copies && (node.mesh == kNone || node.skin != kNone)) ++ignored_copies_;
  if (node.light != kNone) add_light(place, node.light);
  if (place != camera_place_) return;
  const Lens lens = lens_of(document_, node.camera);
  scene_.camera = lens.camera;
  scene_.timeline.node_camera = NodeCamera{place, lens.clip_from_view};
}

namespace {

/// Whether a target moves texture coordinates or colours, which poses leave as they are.
bool has_unread_target(const Primitive& primitive) {
  return std::any_of(primitive.targets.begin(), primitive.targets.end(),
                     [](const Attributes& target) { return target.color != kNone || !target.uv.empty(); });
}

}  // namespace

SceneMaker::Parts SceneMaker::parts_of(const MeshSource& mesh) const {
  Parts parts;
  for (size_t i = 0; i < mesh.primitives.size(); ++i) {
    const Primitive& primitive = mesh.primitives[i];
    if (!has_triangles(primitive.mode))
      ++(primitive.mode == Mode::points ? parts.points : parts.lines);
    else if (primitive.attributes.position == kNone)
      ++parts.without_positions;
    else if (!materials_.is_invisible(primitive.material)) {
      parts.drawn.push_back(i);
      parts.with_joints += primitive.attributes.joints.empty() ? 0 : 1;
      parts.with_unread_targets += has_unread_target(primitive) ? 1 : 0;
    }
  }
  return parts;
}

/// Instances of the primitives that a node draws, `before` of others before them. Error(limit) with the node.
uint64_t SceneMaker::instances_of(uint32_t place, const NodeSource& node, const Parts& parts, uint64_t before) const {
  const uint64_t skinned = node.skin != kNone ? parts.with_joints : 0, copied = parts.drawn.size() - skinned,
                 copies = node.copies ? count_of(accessors_, *node.copies) : 1,
                 left = limits_.instances - before;  // none of these is over the limit
  if (skinned > left || (copied > 0 && copies > (left - skinned) / copied))
    throw Error(ErrorKind::limit, document_.file + ": " + pointer_to("nodes", hierarchy_.nodes[place]),
                "the instances are over the limit", within_limit(limits_.instances, "", "--max-instances"));
  return skinned + copied * copies;
}

/// What costs little is checked before geometry is read: All instances are counted, and the materials, in the order in
/// which they are drawn, name the pictures, which are checked. A mesh may have many primitives that are not drawn and
/// many nodes, so it is summarised once.
void SceneMaker::prepare() {
  uint64_t instances = 0;
  for (uint32_t place = 0; place < hierarchy_.nodes.size(); ++place) {
    const NodeSource& node = document_.nodes[hierarchy_.nodes[place]];
    if (node.mesh == kNone) continue;
    const MeshSource& mesh = document_.meshes[node.mesh];
    const auto [found, is_new] = parts_.try_emplace(node.mesh);
    Parts& parts = found->second;
    if (is_new) parts = parts_of(mesh);
    for (size_t i = 0; is_new && i < parts.drawn.size(); ++i)
      materials_.scene_material(mesh.primitives[parts.drawn[i]].material);
    instances += instances_of(place, node, parts, instances);
  }
  pictures_.check();
  plan_primitives();
  require_memory(instances * (sizeof(Instance) + sizeof(NodeInstance)), document_.file + ": /nodes", "its instances");
  scene_.instances.reserve(size_t(instances));
  scene_.timeline.node_instances.reserve(size_t(instances));
}

void SceneMaker::add_mesh(uint32_t place, const NodeSource& node) {
  const Parts& parts = parts_.at(node.mesh);
  points_ += parts.points;
  lines_ += parts.lines;
  without_positions_ += parts.without_positions;
  with_unread_targets_ += parts.with_unread_targets;
  const bool is_copied = node.copies && parts.drawn.size() > (node.skin != kNone ? parts.with_joints : 0);
  const std::vector<glm::dmat4x3> copies =
      is_copied ? matrices_of(accessors_, *node.copies, pointer_to("nodes", hierarchy_.nodes[place]))
                : std::vector<glm::dmat4x3>{glm::dmat4x3(1.0)};
  for (const size_t primitive : parts.drawn) add_primitive(place, node, primitive, copies);
}

void SceneMaker::add_light(uint32_t place, uint32_t light) {
  if (scene_.lights.size() >= limits_.lights)
    throw Error(ErrorKind::limit, document_.file + ": " + pointer_to("nodes", hierarchy_.nodes[place]),
                "the lights are over the limit", within_limit(limits_.lights, "", "--max-lights"));
  scene_.timeline.node_lights.push_back({uint32_t(scene_.lights.size()), place});
  scene_.lights.push_back(light_of(document_, light));
}

void SceneMaker::add_primitive(uint32_t place, const NodeSource& node, size_t index,
                               std::span<const glm::dmat4x3> copies) {
  const Primitive& primitive = document_.meshes[node.mesh].primitives[index];
  Drawn& drawn = drawn_of(node.mesh, index);
  const bool skinned = node.skin != kNone && !primitive.attributes.joints.empty(),
             posed = skinned || !primitive.targets.empty();
  Instance instance;
  instance.mesh = posed ? add_posed_mesh(node, place, drawn, skinned) : static_mesh(drawn);
  instance.material = materials_.scene_material(primitive.material);
  if (skinned) {  // in world space: the joints' matrices bring it there, and the node's has no say
    scene_.instances.push_back(instance);
    return;
  }
  for (const glm::dmat4x3& copy : copies) {
    scene_.timeline.node_instances.push_back({uint32_t(scene_.instances.size()), place, copy, drawn.reach});
    scene_.instances.push_back(instance);
  }
}

/// Sets that are read: the first two whether maps read them or not, and up to the last that a map reads. Tangents are
/// read for normal maps.
Wanted SceneMaker::wanted_of(const Primitive& primitive) const {
  size_t sets = 2;
  bool tangents = false;
  if (primitive.material != kNone) {
    const MaterialSource& m = document_.materials[primitive.material];
    const std::vector<uint32_t>& uv = primitive.attributes.uv;
    const size_t along = m.normal_map.uv.set;  // which --lenient lets a mesh lack
    tangents = keeps_tangents_ && m.normal_map.texture != kNone && along < uv.size() && uv[along] != kNone;
    for (const TextureInfo* map :
         {&m.base_color_map, &m.metallic_roughness_map, &m.normal_map, &m.occlusion_map, &m.emission_map})
      if (map->texture != kNone) sets = std::max(sets, size_t(map->uv.set) + 1);
  }
  return {std::min(sets, primitive.attributes.uv.size()), tangents};
}

namespace {

constexpr uint64_t kTangentStreams = 4, kMostStreams = 3 + 3 + 2 + 4 + kTangentStreams;  // with one set of uv
constexpr uint64_t kTangentWork = 80;  // bytes of a corner, while tangents are made

/// Whether a primitive's normal map asks for tangents that the file does not have.
bool makes_tangents(const Primitive& primitive, const Wanted& wanted) {
  return wanted.tangents && (primitive.attributes.tangent == kNone || primitive.attributes.normal == kNone);
}

}  // namespace

/// Finds what primitives share, and adds up what reading all of them takes.
void SceneMaker::plan_primitives() {
  for (uint32_t mesh = 0; mesh < document_.meshes.size(); ++mesh)
    for (size_t i = 0; i < document_.meshes[mesh].primitives.size(); ++i) {
      const Primitive& p = document_.meshes[mesh].primitives[i];
      const Attributes& a = p.attributes;
      if (!has_triangles(p.mode) || a.position == kNone) continue;
      const Wanted wanted = wanted_of(p);
      std::vector<uint32_t> key{a.position, a.normal, a.color, p.indices, uint32_t(p.mode), uint32_t(wanted.uv_sets)};
      key.insert(key.end(), a.uv.begin(), a.uv.begin() + ptrdiff_t(wanted.uv_sets));
      key.push_back(wanted.tangents ? a.tangent : kNone);
      key.push_back(makes_tangents(p, wanted) ? 1 : 0);
      if (key.back() == 1) {
        const UvSource& along = document_.materials[p.material].normal_map.uv;
        key.push_back(along.set);
        for (const float x : {along.transform.offset.x, along.transform.offset.y, along.transform.scale.x,
                              along.transform.scale.y, along.transform.rotation_rad})
          key.push_back(std::bit_cast<uint32_t>(x));
      }
      key.insert(key.end(), a.joints.begin(), a.joints.end());
      key.insert(key.end(), a.weights.begin(), a.weights.end());
      key.push_back(uint32_t(a.joints.size()));
      for (const Attributes& target : p.targets)
        key.insert(key.end(), {target.position, target.normal, wanted.tangents ? target.tangent : kNone});
      const auto [found, is_new] = drawn_.try_emplace(std::move(key));
      drawn_of_primitive_[{mesh, i}] = &found->second;  // elements of a map stay where they are
      if (is_new) plan_geometry(accessors_, p, wanted);
    }
}

SceneMaker::Drawn& SceneMaker::drawn_of(uint32_t mesh, size_t index) {
  Drawn& drawn = *drawn_of_primitive_.at({mesh, index});
  if (!drawn.pointer.empty()) return drawn;
  const Primitive& p = document_.meshes[mesh].primitives[index];
  drawn.pointer = pointer_to("meshes", mesh, "primitives", index);
  drawn.geometry = read_geometry(accessors_, p, wanted_of(p), drawn.pointer);
  if (p.targets.empty() && p.attributes.joints.empty()) drop_unused_vertices(drawn.geometry.mesh);
  if (makes_tangents(p, wanted_of(p))) {
    const Mesh& mesh = drawn.geometry.mesh;
    const uint64_t before = mesh.vertex_count(), corners = mesh.indices.size();
    const uint64_t vertex_bytes = (kMostStreams + 2 * mesh.more_uv.size()) * sizeof(float);
    require_memory(corners * (kTangentWork + vertex_bytes), document_.file + ": " + drawn.pointer, "its tangents");
    add_tangents(document_.materials[p.material].normal_map.uv, drawn.geometry);
    const uint64_t parted = mesh.vertex_count() - before;
    accessors_.take(before * kTangentStreams * sizeof(float) + parted * vertex_bytes, drawn.pointer);
  }
  drawn.geometry.mesh.name = document_.meshes[mesh].name;
  drawn.reach = reach_of(drawn.geometry.mesh);
  return drawn;
}

uint32_t SceneMaker::static_mesh(Drawn& drawn) {
  if (drawn.mesh) return *drawn.mesh;
  drawn.mesh = uint32_t(scene_.meshes.size());
  const bool has_pose = drawn.geometry.shape.influences > 0;  // another node may give it a skin
  scene_.meshes.push_back(has_pose ? drawn.geometry.mesh : std::move(drawn.geometry.mesh));
  return *drawn.mesh;
}

/// Adds a mesh for this node alone, because each node has its own pose.
uint32_t SceneMaker::add_posed_mesh(const NodeSource& node, uint32_t place, Drawn& drawn, bool skinned) {
  Timeline& timeline = scene_.timeline;
  const Mesh& mesh = drawn.geometry.mesh;
  const size_t targets = document_.meshes[node.mesh].primitives.front().targets.size();  // of each primitive
  accessors_.take(targets * sizeof(double) + sizeof(PosedMesh) + sizeof(Mesh), drawn.pointer);
  if (!drawn.shape) {
    drawn.shape = uint32_t(timeline.shapes.size());
    timeline.shapes.push_back(std::move(drawn.geometry.shape));
  }
  const RestShape& shape = timeline.shapes[*drawn.shape];
  const uint32_t index = hierarchy_.nodes[place];
  const auto found = weight_channels_.find(index);
  const Channel* channel = found == weight_channels_.end() ? nullptr : found->second;
  const auto read = channel ? weights_read_.find(channel->sampler) : weights_read_.end();
  PosedMesh posed = weighed(accessors_, index, shape.targets.size(), animation_ ? &*animation_ : nullptr, channel,
                            read == weights_read_.end() ? nullptr : &*timeline.posed[read->second].motion);
  if (posed.motion) weights_read_.try_emplace(channel->sampler, timeline.posed.size());
  posed.mesh = uint32_t(scene_.meshes.size());
  posed.shape = *drawn.shape;
  if (skinned) {
    posed.skin = scene_skin(node.skin);
    check_joints(document_, shape, timeline.skins[*posed.skin], drawn.pointer);
  }
  const size_t floats = 12 + 2 * mesh.more_uv.size() + (mesh.has_tangents() ? 4 : 0);
  accessors_.take((uint64_t(mesh.vertex_count()) * floats + mesh.indices.size()) * 4, drawn.pointer);
  scene_.meshes.push_back(mesh);
  timeline.posed.push_back(std::move(posed));
  return timeline.posed.back().mesh;
}

uint32_t SceneMaker::scene_skin(uint32_t skin) {
  const auto [found, is_new] = skins_.try_emplace(skin, uint32_t(scene_.timeline.skins.size()));
  if (is_new) scene_.timeline.skins.push_back(skin_of(accessors_, skin, hierarchy_));
  return found->second;
}

/// All that lies in buffers but pictures. What the scene does not draw is read too, so that whether a file is broken
/// does not depend on its default scene.
void SceneMaker::read_geometry_and_nodes() {
  Timeline& timeline = scene_.timeline;
  timeline.nodes = scene_nodes(document_, hierarchy_);
  if (animation_) {
    timeline.node_motions = node_motions(accessors_, *animation_, hierarchy_);
    for (const Channel& channel : animation_->channels)
      if (channel.path == Path::weights && channel.node != kNone) weight_channels_.emplace(channel.node, &channel);
  }
  for (uint32_t place = 0; place < hierarchy_.nodes.size(); ++place) add_node(place);
  for (const auto& [place, drawn] : drawn_of_primitive_) drawn_of(place.first, place.second);
  for (const SkinSource& skin : document_.skins)
    if (skin.inverse_bind != kNone) accessors_.matrices(skin.inverse_bind);
}

void SceneMaker::add_notes() {
  const auto note = [&](uint64_t count, const char* one, const char* many, const char* rest) {
    if (count > 0) scene_.notes.push_back(std::to_string(count) + ' ' + (count == 1 ? one : many) + rest);
  };
  note(points_, "primitive of points is", "primitives of points are", " not drawn, because only triangles are drawn");
  note(lines_, "primitive of lines is", "primitives of lines are", " not drawn, because only triangles are drawn");
  note(without_positions_, "primitive has", "primitives have", " no POSITION and no triangles to draw");
  note(with_unread_targets_, "primitive has", "primitives have",
       " morph targets of texture coordinates or colours, which keep their values");
  note(ignored_copies_, "node has", "nodes have",
       " EXT_mesh_gpu_instancing, which is ignored: Only a mesh without a skin is copied");
  if (!asked_.camera)
    note(std::max<uint64_t>(scene_.cameras.size(), 1) - 1, "camera is", "cameras are",
         " ignored: The file's first camera is the scene's");
  if (!asked_.animation)
    note(std::max<uint64_t>(document_.animations.size(), 1) - 1, "animation is", "animations are",
         " ignored: The first animation is played");
  note(passed_over_, "channel of an animation is", "channels of animations are",
       " ignored: An animation before it moves the same");
  uint64_t unknown_paths = 0;
  if (animation_)
    for (const Channel& channel : animation_->channels) unknown_paths += channel.path == Path::unknown;
  note(unknown_paths, "channel", "channels",
       " of the animation without an effect: The path is none of translation, rotation, scale and weights");
  uint64_t strided = 0;
  const auto count_stride = [&](uint32_t accessor) {
    const uint32_t view = document_.accessors[accessor].view;
    strided += view != kNone && document_.views[view].stride != 0;
  };
  for (const SkinSource& skin : document_.skins)
    if (skin.inverse_bind != kNone) count_stride(skin.inverse_bind);
  for (const AnimationSource& animation : document_.animations)
    for (const AnimationSampler& sampler : animation.samplers)
      count_stride(sampler.input), count_stride(sampler.output);
  note(strided, "accessor of joints or animations is", "accessors of joints or animations are",
       " read by the stride of the view, which glTF keeps for vertices");
  std::string names;
  constexpr size_t kNamed = 5;
  size_t unread = 0;
  for (const SceneExtension& extension : document_.extensions)
    if (!extension.is_read && ++unread <= kNamed) names += (unread > 1 ? ", " : "") + extension.name;
  if (unread > kNamed) names += ", ...";
  note(unread, "extension is", "extensions are",
       (" not read, and the file is drawn as if it had none: " + names).c_str());
}

}  // namespace trueshade::gltf
