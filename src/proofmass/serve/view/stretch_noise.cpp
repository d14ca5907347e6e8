#include "proofmass/serve/view/stretch_noise.hpp"

#include "proofmass/characterise/noise_analysis.hpp"
#include "proofmass/report/noise/report.hpp"
#include "proofmass/report/page/json.hpp"
#include "proofmass/signal/even_grid.hpp"

namespace proofmass::serve {

Result<std::string> stretch_noise(const Recording& recording) {
  const Channel& channel = recording.channels.front();
  const auto grid = signal::even_grid(recording.time, recording.samples());
  if (!grid) return grid.error();
  Samples series = signal::on_even_grid(channel.values, *grid);
  Unit unit = channel.unit;
  if (unit.quantity == Quantity::acceleration) {
    for (double& value : series.edit()) value = unit.si(value);
    unit = *parse_unit("m/s^2");
  }
  auto analysis = characterise::analyse_noise(series, {.rate_hz = grid->rate_hz});
  if (!analysis) return analysis.error();
  report::NoiseReport report;
  report.inputs = {channel.name};
  report::ChannelNoise& shown = report.channels.emplace_back();
  shown.name = channel.name;
  shown.unit = unit;
  shown.analysis = std::move(analysis).value();
  return report::page_json(report::describe(report).page);
}

}  // namespace proofmass::serve
