#include "proofmass/signal/resample/counter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace proofmass::signal {

namespace {

bool is_count(double value) {
  return std::abs(value) < 1e15 && value == std::trunc(value);
}

bool ran_over(double last, double next) {
  constexpr std::array<double, 4> ends{0x1p8, 0x1p16, 0x1p24, 0x1p32};
  return std::ranges::any_of(ends, [&](double end) {
    return last < end && last > 0.9 * end && next >= 0.0 && next < 0.1 * end;
  });
}

}  // namespace

void RunningCounter::add(View<double> values) {
  rows_ += values.size();
  for (const double value : values) {
    ++rows_since_;
    if (!is_count(value)) continue;
    if (started_) {
      const double step = value - last_;
      const double missing = step - static_cast<double>(rows_since_);
      if (step == 1.0) ++ones_;
      if (step < 0.0 && !ran_over(last_, value)) went_back_ = true;
      if (missing > 0.0 && missing < 1e6) lost_ += missing;
    }
    started_ = true;
    last_ = value;
    rows_since_ = 0;
  }
}

bool RunningCounter::counts_rows() const {
  return !went_back_ && rows_ > 1 && ones_ * 10 >= (rows_ - 1) * 8;
}

bool is_counter_name(std::string_view name) {
  std::string bare;
  for (const char c : name) {
    if (c >= 'A' && c <= 'Z') bare += static_cast<char>(c + 32);
    if (c >= 'a' && c <= 'z') bare += c;
  }
  constexpr std::array<std::string_view, 18> names{
      "packetcounter", "packetnumber", "packetcount", "packet",   "packetnr",     "counter",
      "count",         "sample",       "samples",     "nsamples", "samplenumber", "sampleno",
      "samplecounter", "index",        "seq",         "sequence", "frame",        "framenumber"};
  return std::ranges::find(names, std::string_view(bare)) != names.end();
}

std::optional<std::size_t> find_counter(const Recording& recording) {
  for (std::size_t c = 0; c < recording.channels.size(); ++c) {
    const Channel& channel = recording.channels[c];
    if (!is_counter_name(channel.name)) continue;
    RunningCounter counter;
    counter.add(channel.values);
    if (counter.counts_rows()) return c;
  }
  return std::nullopt;
}

std::size_t count_lost_rows(View<double> values) {
  RunningCounter counter;
  counter.add(values);
  return counter.lost_rows();
}

}  // namespace proofmass::signal
