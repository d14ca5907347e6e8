#include "proofmass/signal/events.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "proofmass/core/contract.hpp"
#include "proofmass/core/statistics.hpp"

namespace proofmass::signal {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

struct Stretch {
  std::size_t first, last;  // samples, inclusive
};

struct Hit {
  Stretch at;
  double sigmas;
};

struct Step {
  std::size_t at;
  double size, sigmas;
  std::size_t window;
};

std::size_t samples(double seconds, double rate_hz) {
  return static_cast<std::size_t>(std::min(std::ceil(seconds * rate_hz), 1e18));
}

/// The upper median, which leaves the values in another order; NaN if there are none.
double median_of(std::span<double> values) {
  if (values.empty()) return nan;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

/// Enough values, evenly taken, to know quantiles well.
constexpr std::size_t sample_size = 8192;
std::size_t stride_of(std::size_t size) {
  return size / sample_size + 1;
}

/// The series with what must not be looked at taken out.
struct Source {
  View<double> series;
  std::vector<Stretch> missing;  // ascending, not overlapping

  /// Samples from `first`, which may lie before the series; NaN where there is none.
  void read(std::ptrdiff_t first, std::span<double> out) const {
    const auto size = static_cast<std::ptrdiff_t>(series.size());
    const auto count = static_cast<std::ptrdiff_t>(out.size());
    const std::ptrdiff_t begin = std::clamp<std::ptrdiff_t>(first, 0, size);
    const std::ptrdiff_t end = std::clamp<std::ptrdiff_t>(first + count, begin, size);
    std::fill(out.begin(), out.begin() + std::min(begin - first, count), nan);
    std::fill(out.begin() + std::clamp<std::ptrdiff_t>(end - first, 0, count), out.end(), nan);
    for (std::ptrdiff_t k = begin; k < end; ++k) {
      const double x = series[static_cast<std::size_t>(k)];
      out[static_cast<std::size_t>(k - first)] = x - x == 0.0 ? x : nan;
    }
    auto gap =
        std::ranges::lower_bound(missing, static_cast<std::size_t>(begin), {}, &Stretch::last);
    for (; gap != missing.end() && static_cast<std::ptrdiff_t>(gap->first) < end; ++gap) {
      const auto from = std::max(begin, static_cast<std::ptrdiff_t>(gap->first));
      const auto to = std::min(end, static_cast<std::ptrdiff_t>(gap->last) + 1);
      std::fill(out.begin() + (from - first), out.begin() + (to - first), nan);
    }
  }

  [[nodiscard]] std::vector<double> read(std::size_t first, std::size_t count) const {
    std::vector<double> out(count);
    read(static_cast<std::ptrdiff_t>(first), out);
    return out;
  }
};

struct Grain {
  double quantum = 0.0;        // least difference between neighbours that is not zero
  std::vector<Stretch> stuck;  // runs of one value 20 times as long as the mean run
};

/// The least |difference| of neighbours, NaN left out; ∞ if there is none.
double least_difference(View<double> series) {
  std::array<double, 4> least;
  least.fill(std::numeric_limits<double>::infinity());
  std::size_t k = 1;
  for (; k + least.size() <= series.size(); k += least.size())
    for (std::size_t lane = 0; lane < least.size(); ++lane) {
      const double difference = std::abs(series[k + lane] - series[k + lane - 1]);
      least[lane] = difference < least[lane] ? difference : least[lane];
    }
  for (; k < series.size(); ++k) {
    const double difference = std::abs(series[k] - series[k - 1]);
    least[0] = difference < least[0] ? difference : least[0];
  }
  return *std::ranges::min_element(least);
}

Grain grain_of(View<double> series) {
  constexpr std::size_t shortest = 20;
  double quantum = std::numeric_limits<double>::infinity();
  std::vector<Stretch> runs;
  std::size_t changes = 0;
  std::size_t run_first = 0;
  const auto change_at = [&](std::size_t k) {
    ++changes;
    if (k - run_first >= shortest) runs.push_back({run_first, k - 1});
    run_first = k;
  };
  constexpr std::size_t block = 64;
  for (std::size_t k = 1; k < series.size();) {
    const std::size_t end = std::min(k + block, series.size());
    // Most often no two neighbours are equal, which is quickly seen.
    if (const double least = least_difference(series.subspan(k - 1, end - k + 1)); least > 0.0) {
      quantum = std::min(quantum, least);
      change_at(k);
      changes += end - k - 1;
      run_first = end - 1;
      k = end;
      continue;
    }
    for (; k < end; ++k) {
      const double difference = std::abs(series[k] - series[k - 1]);
      if (difference == 0.0) continue;
      quantum = difference < quantum ? difference : quantum;
      change_at(k);
    }
  }
  change_at(series.size());
  std::erase_if(runs, [&](const Stretch& run) {
    return (run.last - run.first + 1) * changes < 20 * series.size();
  });
  return {std::isfinite(quantum) ? quantum : 0.0, std::move(runs)};
}

/// What one filter put out over a block of places.
struct Tally {
  double mean, max;  // of |output|; NaN and 0 where there was none
};

Tally tally(View<double> outputs) {
  double sum = 0.0;
  double max = 0.0;
  double count = 0.0;
  for (const double output : outputs) {
    const double size = std::abs(output);
    const bool there = size >= 0.0;
    sum += there ? size : 0.0;
    max = size > max ? size : max;
    count += there ? 1.0 : 0.0;
  }
  return {count > 0.0 ? sum / count : nan, max};
}

std::vector<Tally> tallies(View<double> outputs, std::size_t block) {
  std::vector<Tally> result;
  result.reserve(outputs.size() / block + 1);
  for (std::size_t k = 0; k < outputs.size(); k += block)
    result.push_back(tally(outputs.subspan(k, std::min(block, outputs.size() - k))));
  return result;
}

/// What an output must exceed, block by block.
struct Bar {
  std::size_t group = 1;      // blocks that share a scale
  std::vector<double> scale;  // of each group
  double sigmas = 0.0;

  [[nodiscard]] double scale_at(std::size_t block) const {
    return scale[std::min(block / group, scale.size() - 1)];
  }
  [[nodiscard]] double at(std::size_t block) const { return sigmas * scale_at(block); }
};

std::vector<double> group_scales(const std::vector<Tally>& blocks,
                                 std::size_t group,
                                 double floor) {
  constexpr double sigma_per_mean = 1.2533141373155003;  // √(π/2)
  std::vector<double> all;
  for (std::size_t b = 0; b < blocks.size(); b += stride_of(blocks.size()))
    if (!std::isnan(blocks[b].mean)) all.push_back(sigma_per_mean * blocks[b].mean);
  const double overall = std::max(floor, all.empty() ? 0.0 : median_of(all));
  std::vector<double> own;
  std::vector<double> means;
  for (std::size_t g = 0; g < std::max<std::size_t>(blocks.size() / group, 1); ++g) {
    const std::size_t end = (g + 2) * group > blocks.size() ? blocks.size() : (g + 1) * group;
    means.clear();
    for (std::size_t b = g * group; b < end; ++b)
      if (!std::isnan(blocks[b].mean)) means.push_back(sigma_per_mean * blocks[b].mean);
    own.push_back(means.empty() ? 0.0 : median_of(means));
  }
  std::vector<double> scale(own.size());
  for (std::size_t g = 0; g < own.size(); ++g)
    scale[g] =
        std::max({overall, own[g], own[g > 0 ? g - 1 : 0], own[std::min(g + 1, own.size() - 1)]});
  return scale;
}

/// Where a Gumbel law with the quartiles of `largest` stands once in a hundred records of `blocks`.
double gumbel_reach(std::vector<double> largest, std::size_t blocks) {
  if (largest.size() < 4) return 0.0;
  std::ranges::sort(largest);
  const double lower = largest[largest.size() / 4];
  const double middle = largest[largest.size() / 2];
  const double upper = largest[largest.size() * 3 / 4];
  const double beta = (upper - lower) / 1.5725;  // ln ln 4 − ln ln 4/3
  return middle + beta * (std::log(100.0 * static_cast<double>(blocks)) - 0.3665);
}

Bar bar_of(const std::vector<Tally>& blocks, std::size_t group, double floor, std::size_t outputs) {
  Bar bar{group, group_scales(blocks, group, floor), 0.0};
  std::vector<double> largest;
  for (std::size_t b = 0; b < blocks.size(); b += stride_of(blocks.size()))
    if (blocks[b].max > 0.0 && bar.scale_at(b) > 0.0)
      largest.push_back(blocks[b].max / bar.scale_at(b));
  const double few = 1.0 + 3.0 / static_cast<double>(std::max<std::size_t>(blocks.size(), 1));
  const double gauss = few * std::sqrt(2.0 * std::log(1000.0 * static_cast<double>(outputs + 1)));
  bar.sigmas = std::max(gauss, gumbel_reach(std::move(largest), blocks.size()));
  return bar;
}

/// How far m[k] stands out from the level before and from the level after, each the mean of the
/// windows w and 2 w away or of the one that is there: the lesser if they agree in sign, or 0, so
/// that a step is none. At an end, where `ends` asks for it, from the line through the nearest
/// four. NaN where there is too little.
double departure(View<double> m, std::size_t k, std::size_t w, bool ends) {
  const auto at = [&](std::ptrdiff_t windows) {
    const auto place = static_cast<std::ptrdiff_t>(k) + windows * static_cast<std::ptrdiff_t>(w);
    const bool inside = place >= 0 && place < static_cast<std::ptrdiff_t>(m.size());
    return inside ? m[static_cast<std::size_t>(place)] : nan;
  };
  const auto level = [&](std::ptrdiff_t way) {
    const double near = at(way);
    const double far = at(2 * way);
    return std::isnan(near) ? far : std::isnan(far) ? near : 0.5 * (near + far);
  };
  const double from_before = m[k] - level(-1);
  const double from_after = m[k] - level(1);
  if (!std::isnan(from_before + from_after)) {
    if (from_before * from_after <= 0.0) return 0.0;
    return std::abs(from_before) < std::abs(from_after) ? from_before : from_after;
  }
  if (!ends) return nan;
  const std::ptrdiff_t way = std::isnan(from_after) ? -1 : 1;
  // Divided by √2, it scatters as the output of the filter in the open.
  return (m[k] - at(way) - 0.5 * at(2 * way) + 0.5 * at(4 * way)) * (0.5 * std::numbers::sqrt2);
}

void merge(std::vector<Hit>& hits, std::size_t apart) {
  std::ranges::sort(hits, {}, [](const Hit& hit) { return hit.at.first; });
  std::size_t kept = 0;
  for (const Hit& hit : hits) {
    if (kept > 0 && hit.at.first <= hits[kept - 1].at.last + apart) {
      Hit& before = hits[kept - 1];
      before.at.last = std::max(before.at.last, hit.at.last);
      before.sigmas = std::max(before.sigmas, hit.sigmas);
    } else {
      hits[kept++] = hit;
    }
  }
  hits.resize(kept);
}

/// The knock filter over windows of 1, 2, 4 and 8 samples, a stretch of the series at a time.
class FineScales {
 public:
  static constexpr std::size_t scales = 4;
  static constexpr std::size_t block = 64;
  static constexpr std::size_t stretch = 64 * block;
  static constexpr std::size_t margin = 48;

  FineScales(const Source& source, std::size_t first)
      : m_(stretch + 2 * margin), output_(stretch), source_(source) {
    open(first);
  }

  /// Reads the stretch that begins at `first`.
  void open(std::size_t first) {
    source_.read(static_cast<std::ptrdiff_t>(first) - static_cast<std::ptrdiff_t>(margin), m_);
    w_ = 1;
  }

  /// On to windows of twice the length.
  void widen() {
    for (std::size_t k = 0; k + w_ < m_.size(); ++k) m_[k] = 0.5 * (m_[k] + m_[k + w_]);
    std::fill(m_.end() - static_cast<std::ptrdiff_t>(w_), m_.end(), nan);
    w_ *= 2;
  }

  void filter() {
    const double* m = m_.data() + margin;
    const std::size_t w = w_;
    for (std::size_t k = 0; k < stretch; ++k) {
      const double* here = m + k;
      output_[k] = *here - 0.25 * ((*(here - 2 * w) + *(here - w)) + (here[w] + here[2 * w]));
    }
  }

  [[nodiscard]] Tally tally_of(std::size_t b) const {
    constexpr std::size_t lanes = 8;
    std::array<double, lanes> sum{};
    std::array<double, lanes> max{};
    for (std::size_t k = b * block; k < (b + 1) * block; k += lanes)
      for (std::size_t lane = 0; lane < lanes; ++lane) {
        const double size = std::abs(output_[k + lane]);
        sum[lane] += size;
        max[lane] = size > max[lane] ? size : max[lane];
      }
    const double total = std::accumulate(sum.begin(), sum.end(), 0.0);
    if (!std::isnan(total))
      return {total / static_cast<double>(block), *std::ranges::max_element(max)};
    std::array<double, block> outputs{};
    for (std::size_t k = 0; k < block; ++k) {
      const double output = output_[b * block + k];
      outputs[k] = std::isnan(output) ? departure_at(b * block + k) : output;
    }
    return tally(outputs);
  }

  [[nodiscard]] double departure_at(std::size_t k) const {
    return departure(m_, margin + k, w_, true);
  }
  [[nodiscard]] std::size_t window() const { return w_; }

 private:
  std::vector<double> m_, output_;
  const Source& source_;
  std::size_t w_ = 1;
};

using FineTallies = std::array<std::vector<Tally>, FineScales::scales>;

FineTallies tally_fine_scales(const Source& source) {
  const std::size_t size = source.series.size();
  FineTallies result;
  for (auto& blocks : result) blocks.reserve(size / FineScales::block + 1);
  FineScales fine(source, 0);
  for (std::size_t first = 0; first < size; first += FineScales::stretch) {
    fine.open(first);
    for (std::size_t scale = 0; scale < FineScales::scales; ++scale) {
      if (scale > 0) fine.widen();
      fine.filter();
      for (std::size_t b = 0;
           b < FineScales::stretch / FineScales::block && first + b * FineScales::block < size; ++b)
        result[scale].push_back(fine.tally_of(b));
    }
  }
  return result;
}

/// Looks again, with a level that the knock itself does not move, where a block stood out.
std::vector<Hit> hits_on_fine_scales(const Source& source,
                                     const FineTallies& blocks,
                                     const std::array<Bar, FineScales::scales>& bars) {
  constexpr std::size_t per_stretch = FineScales::stretch / FineScales::block;
  std::vector<Hit> hits;
  FineScales fine(source, 0);
  for (std::size_t begin = 0; begin < blocks[0].size(); begin += per_stretch) {
    const std::size_t end = std::min(begin + per_stretch, blocks[0].size());
    bool open = false;
    for (std::size_t scale = 0; scale < FineScales::scales; ++scale) {
      const auto is_hot = [&](std::size_t b) { return blocks[scale][b].max > bars[scale].at(b); };
      for (std::size_t b = begin; b < end; ++b) {
        if (!is_hot(b)) continue;
        if (!open) fine.open(begin * FineScales::block);
        open = true;
        while (fine.window() < (std::size_t{1} << scale)) fine.widen();
        for (std::size_t k = 0; k < FineScales::block; ++k) {
          const double size = std::abs(fine.departure_at((b - begin) * FineScales::block + k));
          const std::size_t at = b * FineScales::block + k;
          if (size > bars[scale].at(b))
            hits.push_back({{at, at + fine.window() - 1}, size / bars[scale].scale_at(b)});
        }
      }
    }
  }
  return hits;
}

/// Means of the series over blocks, and the share of each that is there.
struct Level {
  std::size_t block = 16;
  std::vector<double> mean;
  std::vector<float> weight;
};

Level base_level(const Source& source) {
  constexpr std::size_t stretch = 4096;
  Level level;
  const std::size_t blocks = source.series.size() / level.block;
  level.mean.reserve(blocks);
  level.weight.reserve(blocks);
  std::vector<double> x(stretch);
  for (std::size_t first = 0; level.mean.size() < blocks; first += stretch) {
    source.read(static_cast<std::ptrdiff_t>(first), x);
    for (std::size_t k = 0; k < stretch && level.mean.size() < blocks; k += level.block) {
      double sum = 0.0;
      double count = 0.0;
      for (std::size_t j = 0; j < level.block; ++j) {
        const bool there = !std::isnan(x[k + j]);
        sum += there ? x[k + j] : 0.0;
        count += there ? 1.0 : 0.0;
      }
      level.mean.push_back(count > 0.0 ? sum / count : 0.0);
      level.weight.push_back(static_cast<float>(count / static_cast<double>(level.block)));
    }
  }
  return level;
}

Level halved(const Level& level) {
  Level result;
  result.block = 2 * level.block;
  const std::size_t size = level.mean.size() / 2;
  result.mean.resize(size);
  result.weight.resize(size);
  for (std::size_t k = 0; k < size; ++k) {
    const auto a = static_cast<double>(level.weight[2 * k]);
    const auto b = static_cast<double>(level.weight[2 * k + 1]);
    const double sum = a * level.mean[2 * k] + b * level.mean[2 * k + 1];
    result.mean[k] = a + b > 0.0 ? sum / (a + b) : 0.0;
    result.weight[k] = static_cast<float>(0.5 * (a + b));
  }
  return result;
}

/// Means over `width` blocks from each block on; NaN where too few samples are there: the mean of
/// the rest does not lie at the middle, where lines and drift are felt.
std::vector<double> windows(const Level& level, std::size_t width) {
  if (level.mean.size() < width) return {};
  std::vector<double> m(level.mean.size() - width + 1);
  const double enough = (width * level.block < 256 ? 0.75 : 0.85) * static_cast<double>(width);
  for (std::size_t k = 0; k < m.size(); ++k) {
    double sum = 0.0;
    double weight = 0.0;
    for (std::size_t j = k; j < k + width; ++j) {
      const auto share = static_cast<double>(level.weight[j]);
      sum += share * level.mean[j];
      weight += share;
    }
    m[k] = weight >= enough ? sum / weight : nan;
  }
  return m;
}

/// Everything about the record that each scale asks for.
struct Record {
  const Source& source;
  double rate_hz;
  double step_floor, knock_floor;
};

constexpr std::size_t coarse_block = 8;

std::size_t group_of(double rate_hz, std::size_t samples_per_block) {
  return std::max<std::size_t>(16, samples(30.0, rate_hz) / samples_per_block);
}

/// The split of a stretch in two constants that leaves the least squares.
std::size_t place_of_step(const Source& source, std::size_t first, std::size_t count) {
  const std::vector<double> x = source.read(first, count);
  double mean = 0.0;
  double seen = 0.0;
  for (const double value : x)
    if (!std::isnan(value)) mean += (value - mean) / ++seen;
  double best = -1.0;
  std::size_t place = first + count / 2;
  double sum = 0.0;
  double n = 0.0;
  for (std::size_t k = 0; k + 1 < x.size(); ++k) {
    if (!std::isnan(x[k])) {
      sum += x[k] - mean;
      ++n;
    }
    const double gain = n > 0.0 && n < seen ? sum * sum / (n * (seen - n)) : 0.0;
    if (gain > best) {
      best = gain;
      place = first + k + 1;
    }
  }
  return place;
}

double mean_of(const Source& source, std::size_t first, std::size_t count) {
  double sum = 0.0;
  std::size_t seen = 0;
  for (const double x : source.read(first, count))
    if (!std::isnan(x)) {
      sum += x;
      ++seen;
    }
  return 2 * seen >= count && seen > 0 ? sum / static_cast<double>(seen) : nan;
}

/// The step filter about a place, through windows of w samples.
double step_output(const Source& source, std::size_t place, std::size_t w) {
  if (place < 2 * w) return nan;
  return 0.5 * (mean_of(source, place - 2 * w, w) - 3.0 * mean_of(source, place - w, w) +
                3.0 * mean_of(source, place, w) - mean_of(source, place + w, w));
}

bool is_sharp(const Source& source, std::size_t place, std::size_t w, double size) {
  for (std::size_t narrow = std::max<std::size_t>(w / 4, 1); narrow < w; narrow *= 2) {
    const double output = step_output(source, place, narrow);
    if (!std::isnan(output)) return output / size > 0.5;
  }
  return true;
}

/// Whether the outputs two and a half to four windows away are far below `size`, unlike beside a
/// bend.
bool stands_alone(View<double> outputs, std::size_t k, std::size_t width, double size) {
  const std::size_t first = k > 4 * width ? k - 4 * width : 0;
  const std::size_t last = std::min(k + 4 * width, outputs.size() - 1);
  for (std::size_t j = first; j <= last; ++j) {
    const std::size_t away = j > k ? j - k : k - j;
    const double other = std::abs(outputs[j]);
    if (2 * away >= 5 * width && 2.5 * other > size) return false;
  }
  return true;
}

bool is_peak(View<double> outputs, std::size_t k, std::size_t width) {
  const std::size_t first = k - std::min(k, 2 * width);
  const std::size_t last = std::min(k + 2 * width, outputs.size() - 1);
  for (std::size_t j = first; j <= last; ++j)
    if (std::abs(outputs[j]) > std::abs(outputs[k])) return false;
  return true;
}

/// Steps that windows of `width` blocks show, added to those known.
void find_steps(const Record& record,
                const Level& level,
                View<double> m,
                std::size_t width,
                std::vector<Step>& steps) {
  if (m.size() < 4 * width) return;
  std::vector<double> outputs(m.size() - 3 * width);
  for (std::size_t k = 0; k < outputs.size(); ++k)
    outputs[k] = 0.5 * ((m[k] - m[k + 3 * width]) + 3.0 * (m[k + 2 * width] - m[k + width]));
  const std::size_t w = width * level.block;
  const Bar bar =
      bar_of(tallies(outputs, coarse_block), group_of(record.rate_hz, coarse_block * level.block),
             record.step_floor, outputs.size());
  for (std::size_t k = 0; k < outputs.size(); ++k) {
    const double size = std::abs(outputs[k]);
    if (!(size > bar.at(k / coarse_block)) || !is_peak(outputs, k, width) ||
        !stands_alone(outputs, k, width, size))
      continue;
    const std::size_t edge = (k + 2 * width) * level.block;
    const std::size_t place = place_of_step(record.source, edge - w, 2 * w);
    const auto is_near = [&](const Step& step) {
      return std::max(step.at, place) - std::min(step.at, place) < 2 * w;
    };
    if (std::ranges::any_of(steps, is_near) || !is_sharp(record.source, place, w, outputs[k]))
      continue;
    steps.push_back({place, outputs[k], size / bar.scale_at(k / coarse_block), w});
  }
}

/// Takes the steps out of the level; a block that holds one is missing.
void level_out(Level& level, View<Step> steps) {
  std::vector<Step> sorted(steps.begin(), steps.end());
  std::ranges::sort(sorted, {}, &Step::at);
  double offset = 0.0;
  auto next = sorted.begin();
  for (std::size_t k = 0; k < level.mean.size(); ++k) {
    for (; next != sorted.end() && next->at < (k + 1) * level.block; ++next) {
      if (next->at > k * level.block) level.weight[k] = 0.0F;
      offset += next->size;
    }
    level.mean[k] -= offset;
  }
}

/// Knocks that windows of `width` blocks show, which then are missing from the level.
void find_knocks(
    const Record& record, Level& level, View<double> m, std::size_t width, std::vector<Hit>& hits) {
  if (m.size() < 5 * width) return;
  std::vector<double> outputs(m.size(), nan);
  for (std::size_t k = 2 * width; k + 2 * width < m.size(); ++k)
    outputs[k] =
        m[k] - 0.25 * ((m[k - 2 * width] + m[k - width]) + (m[k + width] + m[k + 2 * width]));
  const std::vector<Tally> blocks = tallies(outputs, coarse_block);
  const Bar bar = bar_of(blocks, group_of(record.rate_hz, coarse_block * level.block),
                         record.knock_floor, outputs.size());
  for (std::size_t k = 0; k < m.size(); ++k) {
    const std::size_t block = k / coarse_block;
    if (!(blocks[block].max > bar.at(block)) || std::isnan(m[k])) continue;
    const double size = std::abs(departure(m, k, width, false));
    if (!(size > bar.at(block)) || !stands_alone(outputs, k, width, size)) continue;
    hits.push_back({{k * level.block, (k + width) * level.block - 1}, size / bar.scale_at(block)});
    std::fill_n(level.weight.begin() + static_cast<std::ptrdiff_t>(k), width, 0.0F);
  }
}

/// Scales of 16 samples and more, short to long; what one finds the next does not see.
void search_coarse_scales(const Record& record, std::vector<Hit>& hits, std::vector<Step>& steps) {
  const std::size_t size = record.source.series.size();
  const std::size_t longest_step =
      std::min(size / 32, std::max<std::size_t>(1024, samples(30.0, record.rate_hz)));
  const std::size_t longest_knock =
      std::min(size / 32, std::max<std::size_t>(16, samples(2.0, record.rate_hz)));
  Level level = base_level(record.source);
  for (std::size_t width = 1;;) {
    const std::size_t w = width * level.block;
    if (w > longest_step && w > longest_knock) return;
    std::vector<double> m = windows(level, width);
    const std::size_t known = steps.size();
    if (w <= longest_step) find_steps(record, level, m, width, steps);
    if (steps.size() > known) {
      level_out(level, View<Step>(steps).subspan(known));
      m = windows(level, width);
    }
    if (w <= longest_knock) find_knocks(record, level, m, width, hits);
    if (width < 4) {
      width *= 2;
    } else {
      level = halved(level);
    }
  }
}

void add_missing(Source& source, const std::vector<Hit>& hits) {
  std::vector<Hit> all;
  for (const Stretch& gap : source.missing) all.push_back({gap, 0.0});
  for (const Hit& hit : hits)
    all.push_back({{hit.at.first - std::min<std::size_t>(hit.at.first, 2), hit.at.last + 2}, 0.0});
  merge(all, 1);
  source.missing.clear();
  for (const Hit& hit : all) source.missing.push_back(hit.at);
}

/// The largest departure in a stretch from the median of a second at either side.
double size_of_knock(View<double> series, const Stretch& at, double rate_hz) {
  const std::size_t side = std::max<std::size_t>(16, samples(1.0, rate_hz));
  std::vector<double> beside;
  const auto keep = [&](std::size_t first, std::size_t end) {
    for (std::size_t k = first; k < end; ++k)
      if (std::isfinite(series[k])) beside.push_back(series[k]);
  };
  keep(at.first - std::min(at.first, side), at.first);
  keep(at.last + 1, std::min(at.last + 1 + side, series.size()));
  const double level = beside.empty() ? 0.0 : median_of(beside);
  double size = 0.0;
  for (std::size_t k = at.first; k <= at.last; ++k)
    if (std::isfinite(series[k]) && std::abs(series[k] - level) > std::abs(size))
      size = series[k] - level;
  return size;
}

/// Two steps that cancel within seconds are a knock.
void pair_steps(std::vector<Step>& steps, std::vector<Hit>& hits, double rate_hz) {
  std::size_t kept = 0;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    if (k + 1 < steps.size() && steps[k + 1].at - steps[k].at <= samples(5.0, rate_hz) &&
        std::abs(steps[k].size + steps[k + 1].size) <
            0.3 * std::max(std::abs(steps[k].size), std::abs(steps[k + 1].size))) {
      hits.push_back({{steps[k].at, steps[k + 1].at - 1}, steps[k].sigmas});
      ++k;
    } else {
      steps[kept++] = steps[k];
    }
  }
  steps.resize(kept);
}

/// The change of the mean over up to two seconds at either side, not beyond another step.
double size_of_step(const Source& source, View<Step> steps, std::size_t k, double rate_hz) {
  const Step& step = steps[k];
  const std::size_t before = step.at - (k > 0 ? steps[k - 1].at : 0);
  const std::size_t after =
      (k + 1 < steps.size() ? steps[k + 1].at : source.series.size()) - step.at;
  const std::size_t side = std::min({std::max(step.window, samples(2.0, rate_hz)), before, after});
  const double size = mean_of(source, step.at, side) - mean_of(source, step.at - side, side);
  return std::isnan(size) ? step.size : size;
}

/// A burst that took a step with it hid the level beside the step. Seen from beyond the burst the
/// level may turn out not to have changed: then it was the burst's tail that looked like a step.
void settle_burst(const Source& source, Event& event, double rate_hz) {
  const std::size_t side = samples(2.0, rate_hz), margin = samples(0.5, rate_hz);
  const std::size_t behind = event.last + 1 + margin;
  if (event.first < side || behind + side > source.series.size()) return;
  const double change = mean_of(source, behind, side) - mean_of(source, event.first - side, side);
  if (std::isnan(change)) return;
  constexpr double least_sigmas = 4.0;
  const double sigma = std::abs(event.size) / event.significance;
  if (std::abs(change) > std::max(least_sigmas * sigma, 0.5 * std::abs(event.size))) {
    event.size = change;
    return;
  }
  event.kind = EventKind::knock;
  event.size = size_of_knock(source.series, {event.first, event.last}, rate_hz);
}

/// A knock rings on below what finds it. Its end moves on, tenth of a second by tenth, while these
/// means differ from the level seconds later by more than four times what those before it scatter.
void follow_to_its_end(const Source& source, Event& event, double rate_hz) {
  const std::size_t w = std::max<std::size_t>(4, samples(0.1, rate_hz));
  constexpr std::size_t windows = 20, farthest = 50;
  constexpr double least_sigmas = 4.0;
  const std::size_t size = source.series.size();
  if (event.first < (windows + 1) * w || event.last + (farthest + windows) * w >= size) return;
  Moments before;
  for (std::size_t k = 2; k <= windows + 1; ++k)
    before.add(mean_of(source, event.first - k * w, w));
  const double level = mean_of(source, event.last + farthest * w, windows * w);
  if (before.count < windows / 2 || std::isnan(level)) return;
  for (std::size_t k = 0; k < farthest; ++k) {
    const double mean = mean_of(source, event.last + 1, w);
    if (!(std::abs(mean - level) > least_sigmas * before.std())) return;
    event.last += w;
  }
}

std::vector<Event> assemble(const Source& source,
                            std::vector<Hit> hits,
                            std::vector<Step> steps,
                            double rate_hz) {
  const View<double> series = source.series;
  std::ranges::sort(steps, {}, &Step::at);
  std::vector<double> sizes;
  for (std::size_t k = 0; k < steps.size(); ++k)
    sizes.push_back(size_of_step(source, steps, k, rate_hz));
  for (std::size_t k = 0; k < steps.size(); ++k) steps[k].size = sizes[k];
  pair_steps(steps, hits, rate_hz);
  merge(hits, std::max<std::size_t>(4, samples(0.2, rate_hz)));
  std::vector<Event> events;
  for (const Step& step : steps)
    events.push_back({EventKind::step, step.at, step.at, step.size, step.sigmas});
  for (const Hit& hit : hits) {
    const Stretch at{hit.at.first, std::min(hit.at.last, series.size() - 1)};
    // A step sets the knock filter off beside it, in a window as long as that it was seen through.
    const auto owner = std::ranges::find_if(steps, [&](const Step& step) {
      const std::size_t reach =
          std::max<std::size_t>(32, 2 * std::min(step.window, samples(0.5, rate_hz)));
      return at.first <= step.at + reach && step.at <= at.last + reach;
    });
    if (owner == steps.end()) {
      events.push_back(
          {EventKind::knock, at.first, at.last, size_of_knock(series, at, rate_hz), hit.sigmas});
    } else {
      Event& event = events[static_cast<std::size_t>(owner - steps.begin())];
      event.first = std::min(event.first, at.first);
      event.last = std::max(event.last, at.last);
    }
  }
  for (Event& event : events) {
    if (event.kind == EventKind::step && event.last > event.first)
      settle_burst(source, event, rate_hz);
    if (event.kind == EventKind::knock) follow_to_its_end(source, event, rate_hz);
  }
  std::ranges::sort(events, {}, &Event::first);
  for (std::size_t k = 1; k < events.size(); ++k) {
    if (events[k].first > events[k - 1].last) continue;
    // A knock that reaches into what a step has taken gives way.
    events[k].first = events[k - 1].last + 1;
    events[k].last = std::max(events[k].last, events[k].first);
  }
  std::erase_if(events, [&](const Event& event) { return event.last >= series.size(); });
  return events;
}

}  // namespace

std::vector<Event> find_events(View<double> series, const EventOptions& options) {
  PM_EXPECTS(std::isfinite(options.rate_hz) && options.rate_hz > 0.0);
  if (series.size() < 16) return {};
  Grain grain = grain_of(series);
  Source source{series, std::move(grain.stuck)};
  const FineTallies blocks = tally_fine_scales(source);

  // √1.25 is the filter's gain for white noise.
  const double fine_sigma = group_scales(blocks[0], blocks[0].size(), 0.0)[0] / std::sqrt(1.25);
  const bool dithered = fine_sigma >= 0.5 * grain.quantum;
  const double knock_floor = dithered ? 0.0 : 0.5 * grain.quantum;
  const double step_floor = dithered ? 0.0 : 0.3 * grain.quantum;
  std::array<Bar, FineScales::scales> bars;
  for (std::size_t scale = 0; scale < bars.size(); ++scale)
    bars[scale] = bar_of(blocks[scale], group_of(options.rate_hz, FineScales::block), knock_floor,
                         series.size());

  std::vector<Hit> hits = hits_on_fine_scales(source, blocks, bars);
  add_missing(source, hits);
  std::vector<Step> steps;
  search_coarse_scales({source, options.rate_hz, step_floor, knock_floor}, hits, steps);
  return assemble(source, std::move(hits), std::move(steps), options.rate_hz);
}

void drop_events(std::span<double> series, const std::vector<Event>& events, double rate_hz) {
  PM_EXPECTS(std::isfinite(rate_hz) && rate_hz > 0.0);
  const std::size_t margin = std::max<std::size_t>(2, samples(0.1, rate_hz));
  for (const Event& event : events) {
    const std::size_t end = std::min(event.last + margin + 1, series.size());
    for (std::size_t k = event.first - std::min(event.first, margin); k < end; ++k) series[k] = nan;
  }
}

}  // namespace proofmass::signal
