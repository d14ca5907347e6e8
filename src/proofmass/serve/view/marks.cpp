#include "proofmass/serve/view/marks.hpp"

#include <algorithm>

#include "proofmass/serve/view/names.hpp"
#include "proofmass/signal/events.hpp"
#include "proofmass/signal/rests.hpp"

namespace proofmass::serve {
namespace {

constexpr std::uint64_t most_samples = 5'000'000;

std::vector<std::size_t> axes_of(const ViewHead& head) {
  Recording named;
  named.channels = head.channels;
  const std::vector<Triad> triads = accelerometer_triads(named);
  std::vector<std::size_t> axes;
  if (!triads.empty())
    for (const auto& axis : {triads.front().x, triads.front().y, triads.front().z})
      if (axis) axes.push_back(*axis);
  if (axes.empty())
    for (std::size_t k = 0; k < std::min<std::size_t>(3, head.channels.size()); ++k)
      axes.push_back(k);
  return axes;
}

// Each outlier once, however many axes have felt it.
std::vector<double> merged(std::vector<double> times_s) {
  constexpr double same_s = 0.05;
  std::ranges::sort(times_s);
  const auto twins =
      std::ranges::unique(times_s, [](double a, double b) { return b - a < same_s; });
  times_s.erase(twins.begin(), twins.end());
  return times_s;
}

struct MarkedAxes {
  std::vector<MappedValues> files;
  std::vector<View<double>> values;
};

Result<MarkedAxes> open_axes(const std::string& folder, const ViewHead& head) {
  MarkedAxes out;
  for (const std::size_t axis : axes_of(head)) {
    auto file = MappedValues::open(folder + "/" + view_channel_name(axis));
    if (!file) return file.error();
    out.values.push_back(out.files.emplace_back(std::move(file).value()).values());
  }
  return out;
}

// The middle sample of each outlier in a rest.
std::vector<std::size_t> outliers_in(const signal::Rest& rest,
                                     const std::vector<View<double>>& axes,
                                     double rate_hz) {
  std::vector<std::size_t> out;
  if (!(rate_hz > 0.0)) return out;
  for (const View<double> axis : axes)
    for (const signal::Event& event : signal::find_events(
             axis.subspan(rest.first, rest.last + 1 - rest.first), {.rate_hz = rate_hz}))
      if (event.kind == signal::EventKind::outlier)
        out.push_back(rest.first + (event.first + event.last) / 2);
  return out;
}

}  // namespace

Status find_marks(const std::string& folder, ViewHead& head) {
  if (head.samples > most_samples) {
    head.why_no_rests = "rests and outliers are marked in recordings of up to 5 000 000 samples";
    return Done{};
  }
  const auto axes = open_axes(folder, head);
  if (!axes) return axes.error();
  MappedValues stamps;
  if (head.has_stamps) {
    auto file = MappedValues::open(folder + "/" + view_stamps_name);
    if (!file) return file.error();
    stamps = std::move(file).value();
  }
  const double rate = head.rate_hz > 0.0 ? head.rate_hz : 1.0;
  const auto time = [&](std::size_t k) {
    return head.has_stamps ? stamps.values()[k] : static_cast<double>(k) / rate;
  };
  const signal::RestSearch search = signal::find_rests(axes->values, {.rate_hz = head.rate_hz});
  head.why_no_rests = search.why_none;
  for (const signal::Rest& rest : search.rests) {
    head.rests.push_back({time(rest.first), time(rest.last)});
    for (const std::size_t k : outliers_in(rest, axes->values, head.rate_hz))
      head.outliers_s.push_back(time(k));
  }
  head.outliers_s = merged(std::move(head.outliers_s));
  return Done{};
}

}  // namespace proofmass::serve
