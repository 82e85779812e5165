#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "core/image.h"
#include "scenes/pipeline/post_chain.h"

namespace trueshade {

// The steps of the post chain, each a function over float32 pictures, in the operations of docs/post.md: + - * / and
// square-free double logarithms of ours, one rounding each, reductions row by row. They need FpScope.

/// Float32 RGBA, rows from the top.
struct Picture {
  int width = 0, height = 0;
  std::vector<float> values;  ///< 4 a pixel

  Picture(int w, int h) : width(w), height(h), values(size_t(w) * size_t(h) * 4) {}
  float* at(int x, int y) { return values.data() + (size_t(y) * size_t(width) + size_t(x)) * 4; }
  const float* at(int x, int y) const { return values.data() + (size_t(y) * size_t(width) + size_t(x)) * 4; }
};

/// What a shader reads of stored texels; alpha 1 where the format has none.
Picture picture_of(const Image& image);

/// Each pixel the mean of a square of samples x samples.
Picture box_average(const Picture& picture, int samples, int threads);

/// Adds strength times the blurred light above the threshold.
void add_bloom(const PostChain::Bloom& bloom, int threads, Picture& picture);

/// exp of the mean of log(offset + luminance) over all pixels, of pictures that come in parts.
class LogarithmicMean {
 public:
  explicit LogarithmicMean(float offset) : offset_(offset) {}
  /// Adds the pixels of each row to that row's sum, from the left.
  void add_to_rows(const Picture& picture, std::span<double> rows) const;
  void add(std::span<const double> rows);  ///< the sums of whole rows, from the top
  double of(uint64_t pixels) const;        ///< of the whole picture, whose pixels these are

 private:
  float offset_;
  double sum_ = 0.0;
};
double logarithmic_mean(const Picture& picture, float offset);

/// Reinhard's global operator (E. Reinhard, M. Stark, P. Shirley, J. Ferwerda, "Photographic tone reproduction for
/// digital images", 2002, equations 1 to 4), luminance alone, hue kept.
/// `logarithmic_mean`: of the whole picture, of which this may be a part.
void map_tones(const PostChain& chain, double logarithmic_mean, Picture& picture);
void map_tones(const PostChain& chain, Picture& picture);  ///< of a whole picture

/// Linear values as sRGB values in [0, 1] (IEC 61966-2-1); alpha as it is.
void encode_srgb(int threads, Picture& picture);

/// How far from a pixel smoothed_edges() looks, pixels.
inline constexpr int kEdgeReach = 14;

/// Edges smoothed as FXAA does: each pixel next to an edge takes of its neighbour across what the edge's slope, seen
/// from its ends, would cover. Flat parts and straight level or upright edges keep their bits. Alpha as it is.
Picture smoothed_edges(const Picture& picture, int threads);

/// Rounded to rgba8, rgba16f or rgba32f.
Image stored(const Picture& picture, Format format, HalfRound half_round);

}  // namespace trueshade
