#include "proofmass/signal/counter.hpp"

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

bool counts_rows(View<double> values) {
  std::size_t ones = 0;
  double last = std::nan("");
  for (const double value : values) {
    if (!is_count(value)) continue;
    if (value < last && !ran_over(last, value)) return false;
    if (value - last == 1.0) ++ones;
    last = value;
  }
  return values.size() > 1 && ones * 10 >= (values.size() - 1) * 8;
}

}  // namespace

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
    if (is_counter_name(channel.name) && counts_rows(channel.values)) return c;
  }
  return std::nullopt;
}

std::size_t count_lost_rows(View<double> counter) {
  double lost = 0.0;
  double last = std::nan("");
  std::size_t rows_since = 0;
  for (const double count : counter) {
    ++rows_since;
    if (!is_count(count)) continue;
    const double missing = count - last - static_cast<double>(rows_since);
    if (missing > 0.0 && missing < 1e6) lost += missing;
    last = count;
    rows_since = 0;
  }
  return static_cast<std::size_t>(lost);
}

}  // namespace proofmass::signal
