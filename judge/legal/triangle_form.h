#pragma once
// A triangle as all of its samples see it, made once for those that are near each other.
#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "judge/legal/bent_normal.h"
#include "judge/legal/piece_shape.h"
#include "judge/legal/surface.h"

namespace trueshade::oracle {

/// What all samples of a triangle share: its pieces, their shapes, its vertices' values. For one thread at a time, as
/// some of it is made when it is first asked for.
class TriangleForm {
 public:
  /// Computes the pieces, their shapes and the vertices' values. Borrows the projector.
  TriangleForm(const Projector& projector, uint32_t instance, uint32_t triangle);

  /// The triangle's pieces, from Projector::pieces().
  const std::vector<Piece>& pieces() const { return pieces_; }
  /// The shape of one of the pieces.
  const PieceShape& shape(size_t piece) const { return forms_[piece].shape; }
  /// The vertices' attributes, from triangle_values().
  const TriangleValues& values() const { return values_; }

  /// An attribute's values at the vertices of a piece, as `interpolation` needs them; not for flat.
  ///   index: a ValueIndex plus a component
  const VertexAttribute& attribute(size_t piece, size_t index, Interpolation interpolation) const;

  /// The frame that the material's normal map is read in, by the map's uv set. Where the mesh has vertex tangents only
  /// the frame's `side` is set.
  const TangentFrame& tangents() const;

 private:
  struct KnownAttribute {
    VertexAttribute attribute;
    Interpolation interpolation = Interpolation::flat;  ///< flat: not made yet
  };
  struct PieceForm {
    PieceShape shape;
    std::array<KnownAttribute, kMaxValues> attributes{};
  };
  const Projector& projector_;
  const uint32_t instance_, triangle_;
  std::vector<Piece> pieces_;
  TriangleValues values_;
  mutable std::vector<PieceForm> forms_;
  mutable std::optional<TangentFrame> tangents_;
};

/// A cache of the forms of triangles that were asked for last. For one thread at a time.
class TriangleForms {
 public:
  /// Borrows the projector.
  explicit TriangleForms(const Projector& projector) : projector_(projector), slots_(kSlots) {}
  /// The form of a triangle, made now unless it is in the cache. The reference is valid until the next call; a copy of
  /// the pointer keeps the form alive.
  const std::shared_ptr<const TriangleForm>& of(uint32_t instance, uint32_t triangle);

 private:
  static constexpr size_t kSlots = 256;  ///< a tile of 16 x 16 pixels sees fewer
  struct Slot {
    uint32_t instance = 0, triangle = 0;
    std::shared_ptr<const TriangleForm> form;
  };
  const Projector& projector_;
  std::vector<Slot> slots_;
};

}  // namespace trueshade::oracle
