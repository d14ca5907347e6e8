#include "proofmass/report/tune/report.hpp"

#include <cmath>
#include <limits>
#include <map>

namespace proofmass::report {

using estimate::TunedSeries;

Recording tune_series(const TuneReport& report) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  std::map<double, std::size_t> places;
  for (const TunedSeries& series : report.tuning.series) {
    for (const double t_s : series.time_s) places.emplace(t_s, 0);
  }
  Recording table;
  table.source = "proofmass tune";
  table.format = "series";
  table.time.source = TimeSource::stamps;
  for (auto& [t_s, place] : places) {
    place = table.time.stamps_s.size();
    table.time.stamps_s.push_back(t_s);
  }
  for (std::size_t c = 0; c < report.channels.size(); ++c) {
    const TunedSeries& series = report.tuning.series[c];
    std::vector<double> innovation(places.size(), none), std(places.size(), none);
    for (std::size_t k = 0; k < series.time_s.size(); ++k) {
      const std::size_t place = places.at(series.time_s[k]);
      innovation[place] = series.innovation[k];
      std[place] = std::sqrt(series.variance[k]);
    }
    const TuneChannel& channel = report.channels[c];
    table.channels.push_back({channel.name + "_innovation", channel.unit, std::move(innovation)});
    table.channels.push_back({channel.name + "_innovation_std", channel.unit, std::move(std)});
  }
  return table;
}

}  // namespace proofmass::report
