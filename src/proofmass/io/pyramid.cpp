#include "proofmass/io/pyramid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "proofmass/core/contract.hpp"

namespace proofmass::io {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// NaN is replaced by any number.
void widen(double& min, double& max, double low, double high) {
  if (!(min <= low)) min = std::isnan(low) ? min : low;
  if (!(max >= high)) max = std::isnan(high) ? max : high;
}

void open_bin(PyramidLevel& level, double start_s) {
  level.start_s.push_back(start_s);
  for (PyramidChannel& channel : level.channels) {
    channel.min.push_back(nan);
    channel.max.push_back(nan);
    channel.nonfinite.push_back(0);
  }
}

void add_values(View<double> values, PyramidChannel& channel) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  std::uint32_t nonfinite = 0;
  for (const double value : values) {
    const bool is_number = std::isfinite(value);
    nonfinite += is_number ? 0 : 1;
    low = is_number && value < low ? value : low;
    high = is_number && value > high ? value : high;
  }
  channel.nonfinite.back() += nonfinite;
  if (low <= high) widen(channel.min.back(), channel.max.back(), low, high);
}

PyramidLevel coarser(const PyramidLevel& fine) {
  PyramidLevel out{fine.bin_samples * PyramidBuilder::factor, {}, {}};
  out.channels.resize(fine.channels.size());
  for (std::size_t i = 0; i < fine.bins(); ++i) {
    if (i % PyramidBuilder::factor == 0) open_bin(out, fine.start_s[i]);
    for (std::size_t c = 0; c < fine.channels.size(); ++c) {
      const PyramidChannel& from = fine.channels[c];
      PyramidChannel& to = out.channels[c];
      widen(to.min.back(), to.max.back(), from.min[i], from.max[i]);
      to.nonfinite.back() += from.nonfinite[i];
    }
  }
  return out;
}

}  // namespace

const PyramidLevel& Pyramid::level_for(double from_s, double to_s, std::size_t pixels) const {
  PM_EXPECTS(!levels.empty() && from_s < to_s);
  const double part = end_s > 0.0 ? std::min(1.0, (to_s - from_s) / end_s) : 1.0;
  const auto fits = [&](const PyramidLevel& level) {
    return static_cast<double>(level.bins()) * part >= static_cast<double>(pixels);
  };
  const auto coarsest = std::find_if(levels.rbegin(), levels.rend(), fits);
  return coarsest == levels.rend() ? levels.front() : *coarsest;
}

PyramidBuilder::PyramidBuilder(const Recording& head) {
  time_.rate_hz = head.time.rate_hz;
  for (const Channel& channel : head.channels) {
    out_.names.push_back(channel.name);
    out_.units.push_back(channel.unit.symbol);
  }
  out_.levels.push_back({finest_bin, {}, std::vector<PyramidChannel>(head.channels.size())});
}

void PyramidBuilder::add_to_bins(const Block& block, std::size_t first, std::size_t count) {
  PyramidLevel& level = out_.levels.front();
  const auto time_of = [&](std::size_t row) {
    return block.stamps_s.empty() ? time_.at(out_.samples + row - first) : block.stamps_s[row];
  };
  if (out_.samples % finest_bin == 0) open_bin(level, time_of(first));
  for (std::size_t c = 0; c < block.channels.size(); ++c)
    add_values(block.channels[c].subspan(first, count), level.channels[c]);
  out_.end_s = time_of(first + count - 1);
  out_.samples += count;
}

void PyramidBuilder::add(const Block& block) {
  PM_EXPECTS(block.channels.size() == out_.names.size());
  for (std::size_t row = 0; row < block.rows();) {
    const std::size_t room = finest_bin - out_.samples % finest_bin;
    const std::size_t count = std::min<std::size_t>(room, block.rows() - row);
    add_to_bins(block, row, count);
    row += count;
  }
}

Pyramid PyramidBuilder::finish() {
  while (out_.levels.back().bins() > factor) out_.levels.push_back(coarser(out_.levels.back()));
  Pyramid out = std::move(out_);
  out_ = {};
  out_.names = out.names;
  out_.units = out.units;
  out_.levels.push_back({finest_bin, {}, std::vector<PyramidChannel>(out.names.size())});
  return out;
}

}  // namespace proofmass::io
