#include "compare/differences.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/threads/parallel_for.h"

namespace trueshade::compare {
namespace {

constexpr int kBandRows = 32;

/// Of one channel in one band of rows.
struct BandOfChannel {
  uint64_t unequal = 0, not_finite_reference = 0, not_finite_test = 0, finite = 0;
  double largest = 0.0, largest_ulp = 0.0, sum = 0.0, sum_of_squares = 0.0, peak = 0.0;
  size_t worst = 0;  ///< pixel
};

struct Band {
  std::vector<BandOfChannel> channels;
  uint64_t unequal = 0, unequal_other = 0, beyond = 0, not_finite = 0, apart = 0, left_out = 0;
  std::optional<size_t> first, worst, first_not_finite;  ///< pixels
  double largest = 0.0;
};

/// What is known of one pixel over its channels.
struct PixelMarks {
  bool unequal = false, unequal_other = false, beyond = false, not_finite = false, apart = false;
  double largest = 0.0;
};

void add_pair(const NumberPair& n, size_t pixel, BandOfChannel& band) {
  band.unequal += n.equal ? 0 : 1;
  band.not_finite_reference += n.reference_finite ? 0 : 1;
  band.not_finite_test += n.test_finite ? 0 : 1;
  if (n.difference > band.largest) band.largest = n.difference, band.worst = pixel;
  band.largest_ulp = std::max(band.largest_ulp, n.ulp);
  if (n.reference_finite) band.peak = std::max(band.peak, std::fabs(n.reference));
  if (!n.reference_finite || !n.test_finite) return;
  ++band.finite;
  band.sum += n.difference, band.sum_of_squares += n.difference * n.difference;
}

/// Two equal words that are finite say all there is: the common case by far.
bool same_and_finite(const PairReader& reader, size_t pixel) {
  const Channel& r = *reader.pair().reference;
  const uint32_t word = r.words[pixel];
  if (!reader.same_storage() || word != reader.pair().test->words[pixel]) return false;
  return r.kind != ChannelKind::floating || (word & 0x7f800000u) != 0x7f800000u;
}

class PartCounter {
 public:
  PartCounter(const PartPair& part, Decoding decoding, const CountRules& rules, bool is_first)
      : part_(part), rules_(rules), is_first_(is_first) {
    for (const int side : rules.window_sides) windows_.emplace_back(part.width, part.height, side);
    for (const ChannelPair& pair : part.channels) {
      const bool color = is_color(*pair.reference) && is_color(*pair.test);
      readers_.emplace_back(pair, decoding.reference && color, decoding.test && color);
    }
  }

  /// Bands are counted apart from each other, each once.
  Band band(int index) {
    Band band;
    band.channels.resize(readers_.size());
    const size_t begin = size_t(index) * kBandRows * size_t(part_.width),
                 end = std::min(begin + size_t(kBandRows) * size_t(part_.width),
                                size_t(part_.width) * size_t(part_.height));
    for (size_t pixel = begin; pixel < end; ++pixel)
      if (rules_.mask != nullptr && rules_.mask->has(pixel))
        leave_out(pixel, band);
      else
        add_pixel(pixel, band);
    return band;
  }

  const std::vector<LocalWindows>& windows() const { return windows_; }

 private:
  int x_of(size_t pixel) const { return int(pixel % size_t(part_.width)); }
  int y_of(size_t pixel) const { return int(pixel / size_t(part_.width)); }

  void leave_out(size_t pixel, Band& band) {
    ++band.left_out;
    for (LocalWindows& windows : windows_) windows.leave_out(x_of(pixel), y_of(pixel));
  }

  void add_pixel(size_t pixel, Band& band) {
    PixelMarks marks;
    for (size_t c = 0; c < readers_.size(); ++c) {
      const PairReader& reader = readers_[c];
      if (same_and_finite(reader, pixel)) {
        ++band.channels[c].finite;
        band.channels[c].peak = std::max(band.channels[c].peak, std::fabs(reader.pair().reference->value(pixel)));
        continue;
      }
      const NumberPair n = reader.at(pixel);
      add_pair(n, pixel, band.channels[c]);
      marks.unequal |= !n.equal;
      marks.unequal_other |= !n.equal && !(is_first_ && is_color(*reader.pair().reference));
      marks.beyond |= n.difference > rules_.beyond;
      marks.not_finite |= !n.reference_finite || !n.test_finite;
      marks.apart |= (!n.reference_finite || !n.test_finite) && n.difference > 0;
      marks.largest = std::max(marks.largest, n.difference);
    }
    band.unequal += marks.unequal, band.unequal_other += marks.unequal_other, band.beyond += marks.beyond;
    band.not_finite += marks.not_finite, band.apart += marks.apart;
    if (marks.unequal && !band.first) band.first = pixel;
    if (marks.not_finite && !band.first_not_finite) band.first_not_finite = pixel;
    if (marks.largest > band.largest) band.largest = marks.largest, band.worst = pixel;
    if (!marks.unequal) return;
    for (LocalWindows& windows : windows_) windows.add(x_of(pixel), y_of(pixel), marks.beyond, false, marks.largest);
  }

  const PartPair& part_;
  const CountRules& rules_;
  bool is_first_;
  std::vector<LocalWindows> windows_;
  std::vector<PairReader> readers_;
};

Place place_of(size_t pixel, size_t part, int width) {
  return {part, int(pixel % size_t(width)), int(pixel / size_t(width))};
}

void add_band_of_channel(const BandOfChannel& band, size_t part, int width, ChannelDifferences& all) {
  all.unequal += band.unequal;
  all.not_finite_reference += band.not_finite_reference, all.not_finite_test += band.not_finite_test;
  all.finite += band.finite;
  all.sum += band.sum, all.sum_of_squares += band.sum_of_squares;
  all.peak = std::max(all.peak, band.peak);
  all.largest_ulp = std::max(all.largest_ulp, band.largest_ulp);
  if (band.largest > all.largest) all.largest = band.largest, all.worst = place_of(band.worst, part, width);
}

/// Adds a part's bands, whose channels begin at `channel` of `all`. `largest`: of the worst pixel so far.
void add_bands(const std::vector<Band>& bands, const PartPair& part, size_t index, size_t channel, double& largest,
               Differences& all) {
  for (const Band& band : bands) {
    all.unequal_pixels += band.unequal, all.unequal_other_pixels += band.unequal_other;
    all.left_out += band.left_out, all.pixels -= band.left_out;
    all.pixels_beyond += band.beyond, all.not_finite_pixels += band.not_finite, all.apart_pixels += band.apart;
    if (band.first && !all.first) all.first = place_of(*band.first, index, part.width);
    if (band.first_not_finite && !all.first_not_finite)
      all.first_not_finite = place_of(*band.first_not_finite, index, part.width);
    if (band.worst && band.largest > largest)
      largest = band.largest, all.worst = place_of(*band.worst, index, part.width);
    for (size_t c = 0; c < band.channels.size(); ++c)
      add_band_of_channel(band.channels[c], index, part.width, all.channels[channel + c]);
  }
}

void keep_worse(const LocalWindows& windows, const PartPair& part, size_t index, std::vector<WorstWindow>& worst) {
  const std::optional<LocalWindow> found = windows.worst();
  if (!found) return;
  const WorstWindow here{*found, index, found->share(part.width, part.height)};
  const auto same =
      std::find_if(worst.begin(), worst.end(), [&](const WorstWindow& w) { return w.window.side == found->side; });
  if (same == worst.end())
    worst.push_back(here);
  else if (is_worse(here.window, same->window))
    *same = here;
}

ChannelDifferences unmeasured(const ChannelPair& pair, uint64_t pixels) {
  ChannelDifferences channel;
  channel.name = pair.name;
  channel.reference_storage = storage_text(*pair.reference), channel.test_storage = storage_text(*pair.test);
  channel.pixels = pixels;
  return channel;
}

}  // namespace

double ChannelDifferences::rms() const { return finite > 0 ? std::sqrt(sum_of_squares / double(finite)) : 0.0; }

double ChannelDifferences::psnr() const {
  if (std::isinf(largest)) return std::numeric_limits<double>::quiet_NaN();
  return 20.0 * std::log10(peak / rms());
}

bool is_color(const Channel& channel) {
  return channel.name == "R" || channel.name == "G" || channel.name == "B" || channel.name == "Y";
}

Differences differences(const Pairing& pairing, Decoding decoding, const CountRules& rules) {
  Differences all;
  all.delta = rules.beyond;
  double largest = 0.0;
  for (size_t p = 0; p < pairing.parts.size(); ++p) {
    const PartPair& part = pairing.parts[p];
    const uint64_t pixels = uint64_t(part.width) * uint64_t(part.height),
                   seen = pixels - (rules.mask != nullptr ? rules.mask->count() : 0);
    const size_t channel = all.channels.size();
    for (const ChannelPair& pair : part.channels) all.channels.push_back(unmeasured(pair, seen));
    PartCounter counter(part, decoding, rules, p == 0);
    std::vector<Band> bands(size_t((part.height + kBandRows - 1) / kBandRows));
    parallel_for(int(bands.size()), rules.threads, [&](int i) { bands[size_t(i)] = counter.band(i); });
    all.pixels += pixels;
    add_bands(bands, part, p, channel, largest, all);
    for (const LocalWindows& windows : counter.windows()) keep_worse(windows, part, p, all.windows);
  }
  // Pixels that differ by nothing, as 0 and -0 do: the first of them is as bad as any.
  if (all.first && !all.worst) all.worst = all.first;
  return all;
}

}  // namespace trueshade::compare
