#include "proofmass/signal/events/coarse_scales.hpp"

#include <algorithm>
#include <cmath>

#include "proofmass/signal/events/level.hpp"
#include "proofmass/signal/events/thresholds.hpp"

namespace proofmass::signal {
namespace {

/// Splits a segment into two constants with the least squares.
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

/// Output of the step filter at a position, with windows of w samples.
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

/// True if the outputs two and a half to four windows away are far below `size`, unlike next to a
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

/// The positions in blocks whose largest output exceeds the threshold, ascending.
std::vector<std::size_t> places_above(const std::vector<Tally>& blocks,
                                      const Bar& bar,
                                      std::size_t places) {
  std::vector<std::size_t> result;
  for (std::size_t block = 0; block < blocks.size(); ++block) {
    if (!(blocks[block].max > bar.at(block))) continue;
    const std::size_t end = std::min((block + 1) * coarse_block, places);
    for (std::size_t k = block * coarse_block; k < end; ++k) result.push_back(k);
  }
  return result;
}

/// Adds the steps found with windows of `width` blocks.
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
  const std::vector<Tally> blocks = tallies(outputs);
  const Bar bar = bar_of(blocks, group_of(record.rate_hz, coarse_block * level.block),
                         record.step_floor, outputs.size());
  for (const std::size_t k : places_above(blocks, bar, outputs.size())) {
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

/// Finds outliers with windows of `width` blocks and marks them as missing in the level.
void find_outliers(
    const Record& record, Level& level, View<double> m, std::size_t width, std::vector<Hit>& hits) {
  if (m.size() < 5 * width) return;
  std::vector<double> outputs(m.size(), nan);
  for (std::size_t k = 2 * width; k + 2 * width < m.size(); ++k)
    outputs[k] =
        m[k] - 0.25 * ((m[k - 2 * width] + m[k - width]) + (m[k + width] + m[k + 2 * width]));
  const std::vector<Tally> blocks = tallies(outputs);
  const Bar bar = bar_of(blocks, group_of(record.rate_hz, coarse_block * level.block),
                         record.outlier_floor, outputs.size());
  for (const std::size_t k : places_above(blocks, bar, m.size())) {
    const std::size_t block = k / coarse_block;
    if (std::isnan(m[k])) continue;
    const double size = std::abs(departure(m, k, width, false));
    if (!(size > bar.at(block)) || !stands_alone(outputs, k, width, size)) continue;
    hits.push_back({{k * level.block, (k + width) * level.block - 1}, size / bar.scale_at(block)});
    std::fill_n(level.weight.begin() + static_cast<std::ptrdiff_t>(k), width, 0.0F);
  }
}

}  // namespace

void search_coarse_scales(const Record& record, std::vector<Hit>& hits, std::vector<Step>& steps) {
  const std::size_t size = record.source.series.size();
  const std::size_t longest_step =
      std::min(size / 32, std::max<std::size_t>(1024, samples_in(30.0, record.rate_hz)));
  const std::size_t longest_outlier =
      std::min(size / 32, std::max<std::size_t>(16, samples_in(2.0, record.rate_hz)));
  Level level = base_level(record.source);
  for (std::size_t width = 1;;) {
    const std::size_t w = width * level.block;
    if (w > longest_step && w > longest_outlier) return;
    std::vector<double> m = windows(level, width);
    const std::size_t known = steps.size();
    if (w <= longest_step) find_steps(record, level, m, width, steps);
    if (steps.size() > known) {
      level_out(level, View<Step>(steps).subspan(known));
      m = windows(level, width);
    }
    if (w <= longest_outlier) find_outliers(record, level, m, width, hits);
    if (width < 4) {
      width *= 2;
    } else {
      level = halved(level);
    }
  }
}

}  // namespace proofmass::signal
