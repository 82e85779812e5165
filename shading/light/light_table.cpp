#include "shading/light/light_table.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>
#include <utility>

#include "core/threads/parallel_for.h"
#include "scenes/pipeline/light_mesh.h"
#include "scenes/trig.h"

namespace trueshade {
namespace {

constexpr float kNoCut = std::numeric_limits<float>::infinity();

// The kernel's falloffs that end, operation by operation; correctly rounded sqrt, product, division and subtraction are
// monotone, so each is positive below one squared distance and 0 from there on.
bool lit_at(Falloff falloff, float d2, float range) {
  if (falloff == Falloff::linear_range) return 1.0f - std::sqrt(d2) / range > 0.0f;
  const float u = d2 / (range * range);
  return std::sqrt(d2) < range && 1.0f - u * u > 0.0f;
}

// The least float that is not inside; `inside` holds below one value and not from there on. `guess` is near it.
template <class Inside>
float least_outside(float guess, const Inside& inside) {
  constexpr uint32_t kEnd = std::bit_cast<uint32_t>(kNoCut);
  const auto holds = [&](uint32_t bits) { return inside(std::bit_cast<float>(bits)); };
  if (holds(kEnd - 1)) return kNoCut;
  uint32_t low = std::isfinite(guess) && guess > 0.0f ? std::bit_cast<uint32_t>(guess) : 1, high = low;
  for (uint32_t step = 1; high < kEnd && holds(high); step *= 2) low = high + 1, high += std::min(step, kEnd - high);
  for (uint32_t step = 1; low > 0 && !holds(low - 1); step *= 2) high = low - 1, low -= std::min(step, low);
  while (low < high) {  // least bit pattern, and so least float
    const uint32_t middle = low + (high - low) / 2;
    if (holds(middle))
      low = middle + 1;
    else
      high = middle;
  }
  return std::bit_cast<float>(low);
}

float cut_distance2(Falloff falloff, float range) {
  return least_outside(range * range, [&](float d2) { return lit_at(falloff, d2, range); });
}

bool ends(Falloff falloff) { return falloff == Falloff::linear_range || falloff == Falloff::inverse_square; }

struct ConeRow {
  bool narrow = false;
  float edge = 0.0f, slope = 0.0f, dark = -2.0f;
};

/// The cone's numbers, each a double formula rounded once: docs/arithmetic.md section 8.
ConeRow cone_row(const Light& light, Cone cone) {
  if (!is_spot(light.type) || cone == Cone::none) return {};
  const double outer_rad = double(light.cone_rad) + double(light.penumbra_rad);
  const double outer = cosine(outer_rad), inner = cosine(double(light.cone_rad));
  const float e0 = float(outer), e1 = float(cone == Cone::smooth_cutoff ? outer * 0.9 + 0.1 : inner);
  if (cone == Cone::exponent) return {float(outer_rad) < float(kPi), e0, 0.0f, e0};
  if (cone != Cone::squared_penumbra) return {true, e0, float(1.0 / (double(e1) - double(e0))), e0};
  const double scale = 1.0 / std::max(0.001, inner - outer);
  const float slope = float(scale), offset = float(-outer * scale);
  // c * slope + offset, of two roundings, is negative for c below this.
  return {true, offset, slope, float(-double(offset) / double(slope) - 1e-5)};
}

LightRow row_of(const Light& light, const LightModel& model) {
  const glm::vec3 position = is_directional(light.type) ? -light.direction : light.position;
  const ConeRow cone = cone_row(light, model.cone);
  LightRow row{};
  row.type = light.type;
  row.kind = !is_placed(light.type) ? LightKind::other : cone.narrow ? LightKind::coned : LightKind::point;
  for (int c = 0; c < 3; ++c) {
    row.position[c] = position[c];
    row.color[c] = light.color[c] * model.damping;
    row.ambient[c] = light.ambient[c];
    row.axis[c] = -light.direction[c];
  }
  row.range = light.range, row.range2 = light.range * light.range;
  row.k0 = light.attenuation.x, row.k1 = light.attenuation.y, row.k2 = light.attenuation.z;
  row.cut2 = row.extent2 = kNoCut;
  row.edge = cone.edge, row.slope = cone.slope, row.dark_cosine = cone.dark;
  row.spot_exponent = exponent_of(light.spot_exponent);
  return row;
}

constexpr size_t kChunk = 512;
static_assert(std::is_trivially_copyable_v<Light>);

void set_viewer(const Camera& camera, LightTable& table) {
  const glm::vec3 axis = view_axis(camera);
  for (int c = 0; c < 3; ++c) table.eye[c] = camera.eye[c], table.view_axis[c] = axis[c];
}

void resize(LightTable& table, size_t lights) {
  const size_t padded = (lights + 15) / 16 * 16;
  for (auto& stream : table.position)
    stream.resize(padded), std::fill(stream.begin() + long(lights), stream.end(), 0.0f);
  table.cut2.resize(padded), std::fill(table.cut2.begin() + long(lights), table.cut2.end(), 0.0f);
  table.row.resize(lights);
}

// Rows from `first` on.
void make_rows(std::span<const Light> lights, const LightModel& model, size_t first, LightTable& table) {
  float range = -1.0f, cut2 = kNoCut;  // of the light before
  for (size_t k = 0; k < lights.size(); ++k) {
    const Light& light = lights[k];
    LightRow& row = table.row[first + k] = row_of(light, model);
    if (ends(model.falloff) && is_placed(light.type)) {
      if (light.range != range) range = light.range, cut2 = cut_distance2(model.falloff, range);
      row.cut2 = cut2;
    }
    // No comparison with a NaN drops a light.
    for (int c = 0; c < 3; ++c) table.position[c][first + k] = is_placed(light.type) ? row.position[c] : std::nanf("");
    table.cut2[first + k] = row.cut2;
  }
}

void bound_rows(std::span<const Light> lights, const LightVolumes& volumes, bool draws_meshes, size_t first,
                LightTable& table) {
  for (size_t k = 0; k < lights.size(); ++k) {
    const LightExtent extent = drawn_extent(lights[k], volumes);
    if (extent == LightExtent::unbounded || (draws_meshes && is_mesh(extent))) continue;
    LightRow& row = table.row[first + k];
    const float range = lights[k].range;
    row.extent2 = least_outside(range * range, [&](float d2) { return std::sqrt(d2) < range; });
    row.cut2 = table.cut2[first + k] = std::min(row.cut2, row.extent2);
  }
}

bool has_cones(std::span<const Light> lights, const LightModel& model) {
  return model.cone != Cone::none &&
         std::any_of(lights.begin(), lights.end(), [](const Light& l) { return is_spot(l.type); });
}

uint64_t next_version() {
  static std::atomic<uint64_t> version{0};
  return ++version;
}

std::span<const Light> chunk_of(std::span<const Light> lights, size_t first) {
  return lights.subspan(first, std::min(kChunk, lights.size() - first));
}

int chunks(size_t lights) { return int((lights + kChunk - 1) / kChunk); }

}  // namespace

void make_light_table(std::span<const Light> lights, const LightModel& model, const Camera& camera, int threads,
                      LightTable& table) {
  set_viewer(camera, table);
  resize(table, lights.size());
  parallel_for(chunks(lights.size()), threads, [&](int chunk) {
    make_rows(chunk_of(lights, size_t(chunk) * kChunk), model, size_t(chunk) * kChunk, table);
  });
  table.cones = has_cones(lights, model);
  table.made_of.clear();
  table.version = next_version();
}

LightTable make_light_table(std::span<const Light> lights, const LightModel& model, const Camera& camera, int threads) {
  LightTable table;
  make_light_table(lights, model, camera, threads, table);
  return table;
}

void bound_by_extents(LightTable& table, std::span<const Light> lights, const LightVolumes& volumes,
                      bool draws_meshes) {
  bound_rows(lights, volumes, draws_meshes, 0, table);
  table.made_of.clear();
  table.version = next_version();
}

LightTableUpdate::LightTableUpdate(std::span<const Light> lights, const LightModel& model, const LightVolumes& volumes,
                                   bool draws_meshes, const Camera& camera, LightTable& table)
    : lights_(lights),
      table_(table),
      kept_(0),
      version_(std::exchange(table.version, 0)),  // until it is whole
      changed_(version_ == 0 || lights.size() != table.made_of.size()) {
  set_viewer(camera, table);
  if (table.model == model && table.volumes == volumes && table.draws_meshes == draws_meshes)
    kept_ = std::min(lights.size(), table.made_of.size());
  table.model = model, table.volumes = volumes, table.draws_meshes = draws_meshes;
  if (lights.size() == table.row.size() && lights.size() == table.made_of.size()) return;
  resize(table, lights.size());
  table.made_of.resize(lights.size());
}

int LightTableUpdate::tasks() const { return chunks(lights_.size()); }

void LightTableUpdate::run(int task) {
  const size_t first = size_t(task) * kChunk;
  const std::span<const Light> lights = chunk_of(lights_, first);
  Light* const made_of = table_.made_of.data() + first;
  if (first + lights.size() <= kept_ && std::memcmp(made_of, lights.data(), lights.size_bytes()) == 0) return;
  changed_ = true;
  make_rows(lights, table_.model, first, table_);
  bound_rows(lights, table_.volumes, table_.draws_meshes, first, table_);
  std::memcpy(made_of, lights.data(), lights.size_bytes());
}

void LightTableUpdate::finish() {
  if (changed_) table_.cones = has_cones(lights_, table_.model);
  table_.version = changed_ ? next_version() : version_;
}

bool dark_over(const LightRow& light, const float low[3], const float high[3]) {
  if (light.kind != LightKind::coned) return false;
  double distance2 = 0.0, radius2 = 0.0, axis2 = 0.0, along = 0.0;
  for (int c = 0; c < 3; ++c) {
    const double half = (double(high[c]) - double(low[c])) * 0.5, axis = double(light.axis[c]);
    const double v = double(light.position[c]) - (double(low[c]) + half);
    distance2 += v * v, radius2 += half * half, axis2 += axis * axis, along += v * axis;
  }
  const double distance = std::sqrt(distance2), radius = std::sqrt(radius2), length = std::sqrt(axis2);
  // Nearer or farther, the kernel's squares have too few bits for the slack below. False for NaN.
  if (!(distance > radius && distance - radius > 1e-15 && distance < 1e18)) return false;
  // The largest cosine to the axis over the sphere about the box: the angle to its centre less that of its radius.
  const double cosine = along / (distance * length), sine_r = radius / distance;
  const double cosine_r = std::sqrt(1.0 - sine_r * sine_r);
  const double most =
      cosine >= cosine_r ? 1.0 : cosine * cosine_r + std::sqrt(std::max(0.0, 1.0 - cosine * cosine)) * sine_r;
  return most * length + 1e-5 < double(light.dark_cosine);  // some ten roundings of 2^-24
}

}  // namespace trueshade
