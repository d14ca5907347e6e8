#include "proofmass/signal/events/fine_scales.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace proofmass::signal {
namespace {

/// The filter, for one segment of the series at a time.
class FineScales {
 public:
  static constexpr std::size_t stretch = 32 * fine_block;
  static constexpr std::size_t margin = 48;

  FineScales(const Source& source, std::size_t first)
      : m_(stretch + 2 * margin), wider_(m_.size()), source_(source) {
    open(first);
  }

  /// Reads the segment that begins at `first`.
  void open(std::size_t first) {
    source_.read(static_cast<std::ptrdiff_t>(first) - static_cast<std::ptrdiff_t>(margin), m_);
    w_ = 1;
  }

  /// Doubles the length of the windows.
  void widen() {
    average_pairs(m_.data(), wider_.data(), m_.size() - w_, w_);
    std::fill(wider_.end() - static_cast<std::ptrdiff_t>(w_), wider_.end(), nan);
    std::swap(m_, wider_);
    w_ *= 2;
  }

  /// Adds the tallies of the first `blocks` blocks.
  void add_tallies(std::size_t blocks, std::vector<Tally>& tallies) const {
    const std::size_t known = tallies.size();
    tallies.resize(known + blocks);
    tally_outliers(m_.data() + margin, w_, blocks, &tallies[known]);
    for (std::size_t b = 0; b < blocks; ++b)
      if (std::isnan(tallies[known + b].mean)) tallies[known + b] = tally_with_gaps(b);
  }

  [[nodiscard]] double departure_at(std::size_t k) const {
    return departure(m_, margin + k, w_, true);
  }
  [[nodiscard]] std::size_t window() const { return w_; }

 private:
  /// Where the filter lacks samples, uses those present.
  [[nodiscard]] Tally tally_with_gaps(std::size_t b) const {
    std::array<double, fine_block> outputs{};
    for (std::size_t k = 0; k < fine_block; ++k) {
      const double* here = &m_[margin + b * fine_block + k];
      const double output =
          *here - 0.25 * ((*(here - 2 * w_) + *(here - w_)) + (here[w_] + here[2 * w_]));
      outputs[k] = std::isnan(output) ? departure_at(b * fine_block + k) : output;
    }
    return tally(outputs);
  }

  std::vector<double> m_, wider_;
  const Source& source_;
  std::size_t w_ = 1;
};

constexpr std::size_t blocks_per_stretch = FineScales::stretch / fine_block;

/// Adds the samples of block `b` that exceed the threshold; the open segment begins at block
/// `begin`.
void add_hits_of_block(const FineScales& fine,
                       std::size_t begin,
                       std::size_t b,
                       const Bar& bar,
                       std::vector<Hit>& hits) {
  for (std::size_t k = 0; k < fine_block; ++k) {
    const double size = std::abs(fine.departure_at((b - begin) * fine_block + k));
    const std::size_t at = b * fine_block + k;
    if (size > bar.at(b)) hits.push_back({{at, at + fine.window() - 1}, size / bar.scale_at(b)});
  }
}

/// Searches the segment that begins at block `begin` again; it is read only if one of its blocks
/// has a detection.
void add_hits_of_stretch(FineScales& fine,
                         std::size_t begin,
                         const FineTallies& blocks,
                         const std::array<Bar, fine_scales>& bars,
                         std::vector<Hit>& hits) {
  const std::size_t end = std::min(begin + blocks_per_stretch, blocks[0].size());
  bool open = false;
  for (std::size_t scale = 0; scale < fine_scales; ++scale) {
    for (std::size_t b = begin; b < end; ++b) {
      if (!(blocks[scale][b].max > bars[scale].at(b))) continue;
      if (!open) fine.open(begin * fine_block);
      open = true;
      while (fine.window() < (std::size_t{1} << scale)) fine.widen();
      add_hits_of_block(fine, begin, b, bars[scale], hits);
    }
  }
}

}  // namespace

FineTallies tally_fine_scales(const Source& source) {
  const std::size_t size = source.series.size();
  FineTallies result;
  for (auto& blocks : result) blocks.reserve(size / fine_block + 1);
  FineScales fine(source, 0);
  for (std::size_t first = 0; first < size; first += FineScales::stretch) {
    fine.open(first);
    const std::size_t blocks =
        (std::min(FineScales::stretch, size - first) + fine_block - 1) / fine_block;
    for (std::size_t scale = 0; scale < fine_scales; ++scale) {
      if (scale > 0) fine.widen();
      fine.add_tallies(blocks, result[scale]);
    }
  }
  return result;
}

std::vector<Hit> hits_on_fine_scales(const Source& source,
                                     const FineTallies& blocks,
                                     const std::array<Bar, fine_scales>& bars) {
  std::vector<Hit> hits;
  FineScales fine(source, 0);
  for (std::size_t begin = 0; begin < blocks[0].size(); begin += blocks_per_stretch)
    add_hits_of_stretch(fine, begin, blocks, bars, hits);
  return hits;
}

}  // namespace proofmass::signal
