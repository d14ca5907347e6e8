#include "proofmass/serve/view/file.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "proofmass/core/contract.hpp"
#include "proofmass/serve/view/names.hpp"

namespace proofmass::serve {
namespace {

constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

Unit unit_of(const nlohmann::json& json) {
  const auto symbol = json.get<std::string>();
  return parse_unit(symbol).value_or(Unit{.symbol = symbol});
}

Result<ViewHead> read_head(const std::string& path) {
  std::ifstream in(path);
  const nlohmann::json json = nlohmann::json::parse(in, nullptr, false);
  if (!json.is_object()) return Error{Errc::corrupt, path + ": is not a head of a view"};
  try {
    ViewHead head;
    head.samples = json.at("samples").get<std::uint64_t>();
    head.rate_hz = json.at("rate_hz").get<double>();
    head.end_s = json.at("end_s").get<double>();
    head.has_stamps = json.at("has_stamps").get<bool>();
    head.why_no_rests = json.at("why_no_rests").get<std::string>();
    for (const auto& channel : json.at("channels"))
      head.channels.push_back(
          {channel.at("name").get<std::string>(), unit_of(channel.at("unit")), {}});
    for (const auto& rest : json.at("rests"))
      head.rests.push_back({rest.at(0).get<double>(), rest.at(1).get<double>()});
    head.outliers_s = json.at("knocks_s").get<std::vector<double>>();
    return head;
  } catch (const nlohmann::json::exception& wrong) {
    return Error{Errc::corrupt, path + ": " + wrong.what()};
  }
}

struct Ends {
  double min = no_value, max = no_value;
};

Ends ends_of(View<double> values) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  return low <= high ? Ends{low, high} : Ends{};
}

StretchFigures figures_of(View<double> values) {
  StretchFigures out;
  double sum = 0.0, square = 0.0;
  const Ends ends = ends_of(values);
  // About the first value, so that a large level does not eat the digits of the spread.
  const auto first = std::ranges::find_if(values, [](double x) { return std::isfinite(x); });
  const double level = first == values.end() ? 0.0 : *first;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    ++out.count;
    sum += value - level;
    square += (value - level) * (value - level);
  }
  if (out.count == 0) return out;
  const auto n = static_cast<double>(out.count);
  const double mean = sum / n, spread = std::max(0.0, square / n - mean * mean);
  out.mean = level + mean;
  out.std = out.count > 1 ? std::sqrt(spread * n / (n - 1.0)) : 0.0;
  out.rms = std::sqrt(out.mean * out.mean + spread);
  out.min = ends.min;
  out.max = ends.max;
  return out;
}

}  // namespace

Result<ViewFile> ViewFile::open(const std::string& folder) {
  ViewFile view;
  auto head = read_head(folder + "/" + view_head_name);
  if (!head) return head.error();
  view.head_ = std::move(head).value();
  for (std::size_t k = 0; k < view.head_.channels.size(); ++k) {
    auto values = MappedValues::open(folder + "/" + view_channel_name(k));
    if (!values) return values.error();
    if (values->values().size() != view.head_.samples)
      return Error{Errc::corrupt, folder + ": a channel is incomplete"};
    view.channels_.push_back(std::move(values).value());
  }
  if (view.head_.has_stamps) {
    auto stamps = MappedValues::open(folder + "/" + view_stamps_name);
    if (!stamps) return stamps.error();
    if (stamps->values().size() != view.head_.samples)
      return Error{Errc::corrupt, folder + ": the stamps are incomplete"};
    view.stamps_ = std::move(stamps).value();
  }
  auto pyramid = io::read_pyramid(folder + "/" + view_channel_name(0));
  if (!pyramid) return pyramid.error();
  view.pyramid_ = std::move(pyramid).value();
  return view;
}

double ViewFile::time_at(std::size_t sample) const {
  if (head_.has_stamps) return stamps_.values()[sample];
  const auto k = static_cast<double>(sample);
  return head_.rate_hz > 0.0 ? k / head_.rate_hz : k;
}

ViewFile::Range ViewFile::range_of(const Stretch& stretch) const {
  const auto count = static_cast<std::size_t>(head_.samples);
  if (head_.has_stamps) {
    const View<double> t = stamps_.values();
    const auto first = std::ranges::lower_bound(t, stretch.from_s);
    const auto last = std::upper_bound(first, t.end(), stretch.to_s);
    return {static_cast<std::size_t>(first - t.begin()),
            static_cast<std::size_t>(last - t.begin())};
  }
  const double rate = head_.rate_hz > 0.0 ? head_.rate_hz : 1.0;
  const auto sample = [&](double x) {
    return static_cast<std::size_t>(std::clamp(x, 0.0, static_cast<double>(count)));
  };
  return {sample(std::ceil(stretch.from_s * rate)), sample(std::floor(stretch.to_s * rate) + 1.0)};
}

ViewWindow ViewFile::window(const Stretch& stretch, std::size_t pixels) const {
  PM_EXPECTS(stretch.from_s < stretch.to_s && pixels > 0);
  Range range = range_of(stretch);
  range.first -= range.first > 0 ? 1 : 0;
  range.last = std::min<std::size_t>(range.last + 1, head_.samples);
  const std::size_t count = range.last - std::min(range.first, range.last);
  if (count / pixels >= io::PyramidBuilder::finest_bin)
    return pyramid_window(pyramid_, stretch, pixels);
  const std::size_t run = count <= 2 * pixels ? 1 : (count + pixels - 1) / pixels;
  ViewWindow out{.are_samples = run == 1, .time_s = {}, .min = {}, .max = {}};
  for (std::size_t k = range.first; k < range.last; k += run) out.time_s.push_back(time_at(k));
  for (const MappedValues& channel : channels_) {
    auto& min = out.min.emplace_back();
    auto& max = out.max.emplace_back();
    for (std::size_t k = range.first; k < range.last; k += run) {
      const Ends ends = ends_of(channel.values().subspan(k, std::min(run, range.last - k)));
      min.push_back(ends.min);
      max.push_back(ends.max);
    }
  }
  if (out.are_samples) out.max.clear();
  return out;
}

std::vector<StretchFigures> ViewFile::figures(const Stretch& stretch) const {
  const Range range = range_of(stretch);
  std::vector<StretchFigures> out;
  for (const MappedValues& channel : channels_)
    out.push_back(figures_of(
        channel.values().subspan(range.first, range.last - std::min(range.first, range.last))));
  return out;
}

Result<Recording> ViewFile::cut(const Stretch& stretch,
                                std::size_t channel,
                                std::size_t most) const {
  if (channel >= channels_.size()) return Error{Errc::invalid_argument, "no such channel"};
  const Range range = range_of(stretch);
  const std::size_t count = range.last - std::min(range.first, range.last);
  if (count > most)
    return Error{Errc::invalid_argument,
                 fmt::format("{} samples are in view: up to {} are analysed at once", count, most)};
  if (count < 16) return Error{Errc::too_few_samples, "fewer than 16 samples are in view"};
  Recording out;
  out.time.source = head_.has_stamps ? TimeSource::stamps : TimeSource::given_rate;
  out.time.rate_hz = head_.rate_hz;
  const View<double> values = channels_[channel].values().subspan(range.first, count);
  out.channels = {head_.channels[channel]};
  out.channels.front().values.edit().assign(values.begin(), values.end());
  for (std::size_t k = 0; head_.has_stamps && k < count; ++k)
    out.time.stamps_s.push_back(time_at(range.first + k) - time_at(range.first));
  return out;
}

ViewWindow pyramid_window(const io::Pyramid& pyramid, const Stretch& stretch, std::size_t pixels) {
  ViewWindow out;
  if (pyramid.levels.empty()) return out;
  const io::PyramidLevel& level = pyramid.level_for(stretch.from_s, stretch.to_s, pixels);
  const auto& start = level.start_s;
  auto first = std::ranges::upper_bound(start, stretch.from_s);
  if (first != start.begin()) --first;
  auto last = std::upper_bound(first, start.end(), stretch.to_s);
  const auto begin = first - start.begin(), end = last - start.begin();
  out.time_s.assign(first, last);
  for (const io::PyramidChannel& channel : level.channels) {
    out.min.emplace_back(channel.min.begin() + begin, channel.min.begin() + end);
    out.max.emplace_back(channel.max.begin() + begin, channel.max.begin() + end);
  }
  return out;
}

}  // namespace proofmass::serve
