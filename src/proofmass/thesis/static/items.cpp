#include <algorithm>
#include <cctype>
#include <fmt/format.h>
#include <utility>

#include "proofmass/report/drift/wording.hpp"
#include "proofmass/report/wording.hpp"
#include "proofmass/thesis/static/item_parts.hpp"

namespace proofmass::thesis {

Finding milli_g(std::string key, std::string label) {
  return {.key = std::move(key),
          .label = std::move(label),
          .si_unit = "m/s^2",
          .shown = {"mg", mg_mps2}};
}

Finding seconds(std::string key, std::string label) {
  return {.key = std::move(key), .label = std::move(label), .si_unit = "s", .shown = {"s", 1.0}};
}

Finding percent(std::string key, std::string label) {
  return {.key = std::move(key), .label = std::move(label), .si_unit = "", .shown = {"%", 0.01}};
}

std::size_t first_axis(const StaticTest& test) {
  const auto known =
      std::ranges::find_if(test.axes, [](const AxisTest& axis) { return axis.drift.has_value(); });
  return static_cast<std::size_t>(known - test.axes.begin());
}

std::size_t fitted_axis(const StaticTest& test) {
  constexpr std::size_t y = 1;
  return test.axes.size() > y && test.axes[y].drift ? y : first_axis(test);
}

report::ChannelDrift channel_of(const StaticTest& test, std::size_t axis) {
  report::ChannelDrift channel;
  channel.name = test.record.axes[axis].name;
  channel.file = test.record.source;
  channel.unit = parse_unit("m/s^2").value_or(Unit{});
  channel.analysis = test.axes[axis].drift;
  return channel;
}

std::string verdict_sentence(const StaticTest& test, std::size_t axis) {
  std::string text = report::drift_verdict(channel_of(test, axis)) + ".";
  text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
  return text;
}

std::string picked_words(const StaticRecord& record) {
  return record.decimation == 1 ? "every sample"
                                : fmt::format("one sample in {}", record.decimation);
}

std::string source_words(const StaticTest& test) {
  return test.record.simulated ? "simulated" : report::file_name(test.record.source);
}

double sampled_hz(const StaticRecord& record) {
  return record.rate_hz * static_cast<double>(record.decimation);
}

double duration_s(const StaticTest& test) {
  return test.axes[first_axis(test)].drift->duration_s;
}

std::vector<Item> static_items(const StaticTest& test) {
  return {bias_data_item(test), fit_item(test), residuals_item(test), static_noise_item(test),
          bias_track_item(test)};
}

}  // namespace proofmass::thesis
