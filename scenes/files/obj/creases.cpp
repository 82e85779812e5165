#include "scenes/files/obj/creases.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace trueshade::obj {
namespace {

constexpr size_t kWordBits = 64;

double dot_of(const glm::dvec3& a, const glm::dvec3& b) { return (a.x * b.x + a.y * b.y) + a.z * b.z; }

}  // namespace

/// A power of two scales exactly, so the test of an angle is that of the cross products themselves; their squares,
/// though, could vanish, or be infinite, where areas are extreme.
CreasedVertex::Plane CreasedVertex::plane_of(const glm::dvec3& area_normal) {
  double largest = 0.0;
  for (int k = 0; k < 3; ++k) largest = std::max(largest, std::fabs(area_normal[k]));
  if (largest == 0.0) return {glm::dvec3(0.0), 0.0};
  const double scale = std::ldexp(1.0, -std::ilogb(largest));
  const glm::dvec3 normal(area_normal.x * scale, area_normal.y * scale, area_normal.z * scale);
  return {normal, dot_of(normal, normal)};
}

/// cos >= 1/2, squared, so that no root is rounded.
bool CreasedVertex::are_within_60_degrees(const Plane& a, const Plane& b) {
  const double dot = dot_of(a.normal, b.normal);
  return dot > 0.0 && 4.0 * (dot * dot) >= a.square * b.square;
}

void CreasedVertex::find_members() {
  const size_t count = planes_.size();
  words_ = (count + kWordBits - 1) / kWordBits;
  members_.assign(count * words_, 0);
  const auto add = [&](size_t triangle, size_t member) {
    members_[triangle * words_ + member / kWordBits] |= uint64_t(1) << (member % kWordBits);
  };
  for (size_t a = 0; a < count; ++a) {
    const bool has_area = planes_[a].square > 0.0;
    if (has_area) add(a, a);
    for (size_t b = 0; b < a; ++b) {
      const bool other_has_area = planes_[b].square > 0.0;
      const bool joined = has_area && other_has_area && are_within_60_degrees(planes_[a], planes_[b]);
      if (joined || (has_area && !other_has_area)) add(b, a);
      if (joined || (!has_area && other_has_area)) add(a, b);
    }
  }
}

glm::dvec3 CreasedVertex::sum_of(const uint64_t* members, std::span<const glm::dvec3> area_normals) const {
  glm::dvec3 sum(0.0);
  for (size_t word = 0; word < words_; ++word)
    for (uint64_t left = members[word]; left != 0; left &= left - 1)
      sum += area_normals[word * kWordBits + size_t(std::countr_zero(left))];
  return sum;
}

void CreasedVertex::set(std::span<const glm::dvec3> area_normals) {
  sum_of_triangle_.assign(area_normals.size(), 0);
  sums_.clear();
  if (area_normals.size() > kMostCreasedTriangles) {
    sums_.emplace_back(0.0);
    for (const glm::dvec3& normal : area_normals) sums_[0] += normal;
    return;
  }
  planes_.clear();
  for (const glm::dvec3& normal : area_normals) planes_.push_back(plane_of(normal));
  find_members();
  first_of_sum_.clear();
  for (size_t triangle = 0; triangle < area_normals.size(); ++triangle) {
    const uint64_t* members = &members_[triangle * words_];
    const auto has_members = [&](uint32_t first) {
      return std::equal(members, members + words_, &members_[first * words_]);
    };
    const auto found = std::find_if(first_of_sum_.begin(), first_of_sum_.end(), has_members);
    sum_of_triangle_[triangle] = uint32_t(found - first_of_sum_.begin());
    if (found != first_of_sum_.end()) continue;
    first_of_sum_.push_back(uint32_t(triangle));
    sums_.push_back(sum_of(members, area_normals));
  }
}

}  // namespace trueshade::obj
