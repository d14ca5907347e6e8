#include "proofmass/report/drift/report.hpp"

#include <limits>
#include <map>
#include <set>

#include "proofmass/report/drift/wording.hpp"

namespace proofmass::report {
namespace {

using characterise::DriftAnalysis;

struct Block {
  double value, fitted, fitted_std, bias;
};

std::map<double, Block> blocks_of(const DriftAnalysis& analysis) {
  std::map<double, Block> blocks;
  for (std::size_t k = 0; k < analysis.block_mean.size(); ++k) {
    const double t_s = analysis.block_time_s(k);
    blocks[t_s] = {analysis.block_mean[k], analysis.fit.curve.value(t_s),
                   analysis.fit.curve.std(t_s), analysis.block_bias[k]};
  }
  return blocks;
}

void add_columns(const std::string& name,
                 const ChannelDrift& channel,
                 const std::vector<double>& times_s,
                 Recording& table) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const std::map<double, Block> blocks = blocks_of(*channel.analysis);
  std::vector<double> values, fitted, fitted_std, bias;
  for (const double t_s : times_s) {
    const auto at = blocks.find(t_s);
    const Block block = at == blocks.end() ? Block{none, none, none, none} : at->second;
    values.push_back(block.value);
    fitted.push_back(block.fitted);
    fitted_std.push_back(block.fitted_std);
    bias.push_back(block.bias);
  }
  table.channels.push_back({name, channel.unit, std::move(values)});
  table.channels.push_back({name + "_fit", channel.unit, std::move(fitted)});
  table.channels.push_back({name + "_fit_std", channel.unit, std::move(fitted_std)});
  table.channels.push_back({name + "_bias", channel.unit, std::move(bias)});
}

}  // namespace

Recording drift_series(const DriftReport& report) {
  std::set<double> all;
  for (const ChannelDrift& channel : report.channels) {
    if (!channel.analysis) continue;
    const DriftAnalysis& analysis = *channel.analysis;
    for (std::size_t k = 0; k < analysis.block_mean.size(); ++k) {
      all.insert(analysis.block_time_s(k));
    }
  }
  Recording table;
  table.source = "proofmass drift";
  table.format = "series";
  table.time.source = TimeSource::stamps;
  table.time.stamps_s.assign(all.begin(), all.end());
  for (const ChannelDrift& channel : report.channels) {
    if (!channel.analysis) continue;
    add_columns(channel_label(report, channel), channel, table.time.stamps_s, table);
  }
  return table;
}

}  // namespace proofmass::report
