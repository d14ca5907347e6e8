#include "proofmass/fleet/summary.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <fmt/format.h>
#include <map>
#include <set>
#include <utility>

#include "proofmass/core/statistics.hpp"
#include "proofmass/fleet/family.hpp"

namespace proofmass::fleet {
namespace {

constexpr std::size_t least_values = 3;

std::optional<double> figure_in(std::string_view text) {
  double value = 0.0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return error == std::errc() && stop == end && std::isfinite(value) ? std::optional(value)
                                                                     : std::nullopt;
}

/// A row by its names.
class Fielded {
 public:
  explicit Fielded(const Row& row) {
    for (const auto& [name, cell] : row) cells_[name] = &cell;
  }
  [[nodiscard]] std::optional<double> figure(const std::string& name) const {
    const auto found = cells_.find(name);
    const auto* value = found == cells_.end() ? nullptr : std::get_if<double>(found->second);
    return value == nullptr ? std::nullopt : std::optional(*value);
  }
  [[nodiscard]] std::string text(const std::string& name) const {
    const auto found = cells_.find(name);
    const auto* value = found == cells_.end() ? nullptr : std::get_if<std::string>(found->second);
    return value == nullptr ? std::string() : *value;
  }

 private:
  std::map<std::string_view, const io::parquet::TableCell*> cells_;
};

// What follows from another figure alone.
bool is_derived(const std::string& name) {
  return name.starts_with("filter_") || name == "spectrum_floor_two_sided";
}

/// What the journals hold, by channel and figure.
class Collector {
 public:
  explicit Collector(Summary& summary) : summary_(&summary) {}

  void take(const Entry& entry) {
    if (!entry.failure.empty()) {
      ++summary_->failures;
      return;
    }
    ++summary_->recordings;
    for (const Row& row : entry.rows) take(entry, row);
  }

  /// Leaves the folders that they share out of the names of sensors that are paths.
  void shorten_names() {
    if (by_path_.empty()) return;
    std::string shared = summary_->sensors[by_path_.front()];
    for (const std::size_t sensor : by_path_) {
      const std::string& name = summary_->sensors[sensor];
      const auto apart = std::ranges::mismatch(shared, name).in1;
      shared.erase(apart, shared.end());
    }
    const std::size_t folders = shared.rfind('/') + 1;  // 0 where there is none
    for (const std::size_t sensor : by_path_) summary_->sensors[sensor].erase(0, folders);
  }

 private:
  void take(const Entry& entry, const Row& row) {
    const Fielded fields(row);
    for (const auto& [name, cell] : row) {
      const auto value = fields.figure(name);
      const auto std = fields.figure(name + "_std");
      const bool is_statistic = entry.verb == "inspect" && (name == "mean" || name == "std");
      if (!value || (!std && !is_statistic) || is_derived(name)) continue;
      FigureSummary& figure = figure_of(name, fields);
      const std::string verdict = fields.text(name + "_verdict");
      if (!verdict.empty() && verdict != "identified") {
        ++figure.not_identified;
        continue;
      }
      figure.values.push_back(
          {.sensor = sensor_of(entry),
           .value = *value,
           .std = std,
           .day = day_of(manifest_field(entry.columns, "date")),
           .temperature_c = figure_in(manifest_field(entry.columns, "temperature")),
           .file = entry.path,
           .page = entry.report.empty() ? entry.document : entry.report});
    }
  }
  FigureSummary& figure_of(const std::string& name, const Fielded& fields) {
    const std::string channel = fields.text("channel");
    const auto [place, is_new] = places_.try_emplace({channel, name}, summary_->figures.size());
    if (is_new) {
      FigureSummary& figure = summary_->figures.emplace_back();
      figure.name = name;
      figure.channel = channel;
      figure.unit = fields.text(name + "_unit");
      if (figure.unit.empty() && (name == "mean" || name == "std"))
        figure.unit = fields.text("unit");
    }
    return summary_->figures[place->second];
  }
  std::size_t sensor_of(const Entry& entry) {
    std::string name(manifest_field(entry.columns, "sensor"));
    if (name.empty()) name = manifest_field(entry.columns, "serial");
    const bool is_path = name.empty();
    if (is_path) name = entry.path;
    const auto [place, is_new] = sensors_.try_emplace(name, summary_->sensors.size());
    if (is_new) summary_->sensors.push_back(name);
    if (is_new && is_path) by_path_.push_back(place->second);
    return place->second;
  }

  Summary* summary_;
  std::map<std::pair<std::string, std::string>, std::size_t> places_;
  std::map<std::string, std::size_t> sensors_;
  std::vector<std::size_t> by_path_;  // sensors that differ only in the recordings' names
};

Quantiles quantiles_of(const FigureSummary& figure) {
  std::vector<double> values;
  for (const FigureValue& one : figure.values) values.push_back(one.value);
  const auto at = [&](double p) { return quantile(values, p).value_or(0.0); };
  return {at(0.0), at(0.05), at(0.25), at(0.5), at(0.75), at(0.95), at(1.0)};
}

std::map<std::size_t, SensorValues> by_sensor(const FigureSummary& figure) {
  std::map<std::size_t, SensorValues> sensors;
  const bool all_known = std::ranges::all_of(
      figure.values, [](const FigureValue& one) { return one.std && *one.std > 0.0; });
  for (const FigureValue& one : figure.values) {
    SensorValues& sensor = sensors[one.sensor];
    sensor.values.push_back(one.value);
    if (all_known) sensor.stds.push_back(*one.std);
  }
  return sensors;
}

// σ²/n of each sensor: of the scatter within all, or of a single value's own standard deviation.
std::vector<SensorMean> means_of(const std::map<std::size_t, SensorValues>& sensors) {
  double squares = 0.0, dof = 0.0;
  std::vector<SensorMean> means;
  for (const auto& [index, sensor] : sensors) {
    const Moments found = moments(sensor.values);
    means.push_back({found.mean, 0.0});
    squares += found.squares;
    dof += static_cast<double>(sensor.values.size()) - 1.0;
  }
  std::size_t k = 0;
  for (const auto& [index, sensor] : sensors) {
    const auto n = static_cast<double>(sensor.values.size());
    if (dof > 0.0)
      means[k].within_variance = squares / dof / n;
    else if (!sensor.stds.empty())
      means[k].within_variance = square(sensor.stds.front());
    ++k;
  }
  return means;
}

// All distances, with no outlier named yet.
void test_family(FigureSummary& figure, FamilyTest& test) {
  const auto sensors = by_sensor(figure);
  const std::vector<SensorMean> means = means_of(sensors);
  const std::vector<Distance> distances = test.distances(means);
  figure.is_tested = !distances.empty();
  std::size_t k = 0;
  for (const auto& [index, sensor] : sensors) {
    if (!figure.is_tested) break;
    figure.outliers.push_back(
        {.sensor = index, .mean = means[k].value, .z = distances[k].z, .p = distances[k].p});
    ++k;
  }
}

// Keeps those that are significant over all figures together.
void keep_outliers(Summary& summary) {
  std::vector<double> p;
  for (const FigureSummary& figure : summary.figures)
    for (const Outlier& one : figure.outliers) p.push_back(one.p);
  summary.family_tests = p.size();
  const std::vector<double> adjusted = adjusted_p(p);
  std::size_t k = 0;
  for (FigureSummary& figure : summary.figures) {
    for (Outlier& one : figure.outliers) one.adjusted_p = adjusted[k++];
    std::erase_if(figure.outliers,
                  [&](const Outlier& one) { return !(one.adjusted_p <= summary.false_share); });
    std::ranges::sort(figure.outliers, {}, &Outlier::p);
  }
}

void fit_type(FigureSummary& figure) {
  std::vector<SensorValues> family;
  for (auto& [index, sensor] : by_sensor(figure)) {
    const bool is_out = std::ranges::any_of(
        figure.outliers, [&](const Outlier& one) { return one.sensor == index; });
    if (!is_out) family.push_back(sensor);
  }
  figure.type = fit_random_effects(family);
}

std::optional<Trend> trend_of(const FigureSummary& figure,
                              std::optional<double> FigureValue::* cause) {
  std::vector<TrendPoint> points;
  for (const FigureValue& one : figure.values)
    if (one.*cause) points.push_back({one.sensor, *(one.*cause), one.value});
  return fit_trend(points);
}

void fit_trends(Summary& summary) {
  std::vector<double> p;
  for (FigureSummary& figure : summary.figures) {
    figure.per_day = trend_of(figure, &FigureValue::day);
    figure.per_kelvin = trend_of(figure, &FigureValue::temperature_c);
    for (const auto& trend : {figure.per_day, figure.per_kelvin})
      if (trend) p.push_back(trend->p);
  }
  summary.trend_tests = p.size();
  const std::vector<double> adjusted = adjusted_p(p);
  std::size_t k = 0;
  for (FigureSummary& figure : summary.figures) {
    if (figure.per_day) figure.per_day_adjusted_p = adjusted[k++];
    if (figure.per_kelvin) figure.per_kelvin_adjusted_p = adjusted[k++];
  }
}

Bounds wilson_95(double within, double n) {
  constexpr double z = 1.959963984540054;
  const double share = within / n, middle = (share + z * z / (2.0 * n)) / (1.0 + z * z / n);
  const double reach =
      z / (1.0 + z * z / n) * std::sqrt(share * (1.0 - share) / n + z * z / (4.0 * n * n));
  return {std::max(0.0, middle - reach), std::min(1.0, middle + reach)};
}

Yield yield_of(const FigureSummary& figure, const Limit& limit) {
  Yield yield;
  yield.limit = limit;
  for (const auto& [index, sensor] : by_sensor(figure)) {
    const double mean = moments(sensor.values).mean;
    ++yield.sensors;
    if (limit.is_upper ? mean <= limit.bound : mean >= limit.bound)
      ++yield.within;
    else
      yield.failing.push_back(index);
  }
  yield.share_95 = wilson_95(static_cast<double>(yield.within), static_cast<double>(yield.sensors));
  return yield;
}

Status hold_limits(Summary& summary, const std::vector<Limit>& limits) {
  for (const Limit& limit : limits) {
    bool any = false;
    for (FigureSummary& figure : summary.figures) {
      if (figure.name != limit.figure) continue;
      any = true;
      figure.yields.push_back(yield_of(figure, limit));
    }
    if (any) continue;
    std::set<std::string> names;
    for (const FigureSummary& figure : summary.figures) names.insert(figure.name);
    std::string list;
    for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
    return Error{Errc::invalid_argument,
                 fmt::format("limit {}: there is no figure {}: there are {}", limit.text,
                             limit.figure, list.empty() ? "none" : list)};
  }
  return Done{};
}

}  // namespace

Result<Limit> parse_limit(const std::string& text) {
  const std::size_t at = text.find_first_of("<>");
  const std::size_t after = at == std::string::npos ? at : text.find_first_not_of("<>=", at);
  const auto bound = after == std::string::npos ? std::nullopt : figure_in(text.substr(after));
  if (!bound || at == 0)
    return Error{
        Errc::invalid_argument,
        fmt::format("limit {}: expected a figure, < or >, and a number: \"white<2e-3\"", text)};
  return Limit{text, text.substr(0, at), text[at] == '<', *bound};
}

Result<Summary> summarise(const std::string& folder, const SummaryOptions& options) {
  const auto results = Results::read(folder);
  if (!results) return results.error();
  Summary summary;
  summary.folder = folder;
  summary.false_share = options.false_share;
  Collector collector(summary);
  const Status read = results->visit([&](const Entry& entry) -> Status {
    collector.take(entry);
    return Done{};
  });
  if (!read) return read.error();
  collector.shorten_names();
  std::erase_if(summary.figures,
                [](const FigureSummary& figure) { return figure.values.size() < least_values; });
  FamilyTest test;
  for (FigureSummary& figure : summary.figures) {
    figure.quantiles = quantiles_of(figure);
    test_family(figure, test);
  }
  keep_outliers(summary);
  for (FigureSummary& figure : summary.figures) fit_type(figure);
  fit_trends(summary);
  if (const Status held = hold_limits(summary, options.limits); !held) return held.error();
  return summary;
}

}  // namespace proofmass::fleet
