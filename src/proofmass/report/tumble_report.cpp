#include "proofmass/report/tumble_report.hpp"

#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "proofmass/report/tumble_wording.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using calibrate::TumbleCoefficient;
using calibrate::TumbleFit;
using calibrate::TumblePosition;
using Q = calibrate::TumbleQuantity;

std::string scale_words(const ChannelTumble& channel) {
  const TumbleCoefficient* scale = channel.fit->find(Q::K1);
  return scale == nullptr ? "" : "scale factor " + coefficient_words(*scale, channel.unit);
}

std::string bias_words(const ChannelTumble& channel) {
  for (const auto& [quantity, where] :
       {std::pair{Q::K0, " at 0 g"}, {Q::K0_second, " at 0 g"}, {Q::K0_up_down, " between ±1 g"}}) {
    const TumbleCoefficient* bias = channel.fit->find(quantity);
    if (bias != nullptr && bias->value)
      return "bias " + coefficient_words(*bias, channel.unit) + where;
  }
  return "bias not determined";
}

std::string channel_text(const ChannelTumble& channel) {
  std::string text = channel.name + '\n';
  if (!channel.fit) return text + "  refused: " + channel.refused + '\n';
  std::vector<std::vector<std::string>> rows{{"coefficient", "value", "95 %", "what it is"}};
  for (std::vector<std::string>& row : coefficient_rows(channel)) rows.push_back(std::move(row));
  text += aligned(rows) + '\n';
  for (const std::string& sentence : tumble_sentences(channel)) text += "  " + sentence + '\n';
  return text;
}

// Of all channels the one with most positions has the rows.
const ChannelTumble* longest(const TumbleReport& report) {
  const ChannelTumble* found = nullptr;
  for (const ChannelTumble& channel : report.channels) {
    if (!channel.fit) continue;
    if (found == nullptr || channel.positions.size() > found->positions.size()) found = &channel;
  }
  return found;
}

bool same_place(const TumblePosition& a, const TumblePosition& b) {
  return a.angle_rad == b.angle_rad && a.mount_rad == b.mount_rad && a.plane == b.plane &&
         a.direction == b.direction && a.time_s == b.time_s && a.label == b.label;
}

void add_columns(const ChannelTumble& channel, const ChannelTumble& rows, Recording& out) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const std::size_t n = rows.positions.size();
  std::vector<double> output(n, none), fitted(n, none), residual(n, none), std(n, none);
  std::size_t k = 0;
  for (std::size_t j = 0; j < n && k < channel.positions.size(); ++j) {
    if (!same_place(rows.positions[j], channel.positions[k])) continue;
    const calibrate::TumbleResidual& r = channel.fit->positions[k];
    output[j] = channel.positions[k].output;
    fitted[j] = r.fitted;
    residual[j] = r.residual;
    std[j] = r.std.value_or(none);
    ++k;
  }
  const std::string& name = channel.name;
  out.channels.push_back({name, channel.unit, std::move(output)});
  out.channels.push_back({name + "_fit", channel.unit, std::move(fitted)});
  out.channels.push_back({name + "_residual", channel.unit, std::move(residual)});
  out.channels.push_back({name + "_residual_std", channel.unit, std::move(std)});
}

}  // namespace

std::string tumble_conclusion(const TumbleReport& report) {
  std::string text;
  for (const ChannelTumble& channel : report.channels) {
    if (!channel.fit) continue;
    const std::string name = report.channels.size() > 1 ? channel.name + ": " : "";
    const std::string words = name + scale_words(channel) + ", " + bias_words(channel) + ". ";
    text += words;
  }
  if (text.empty()) return "No channel follows the angle: there is nothing to be told.";
  text.pop_back();
  if (report.channels.size() == 1 || text[0] == 's') text[0] = 'S';
  return text;
}

std::string tumble_text(const TumbleReport& report) {
  std::string text = tumble_conclusion(report) + "\n";
  for (const ChannelTumble& channel : report.channels) text += '\n' + channel_text(channel);
  for (const std::string& sentence : table_sentences(report)) text += "\n  " + sentence;
  return text.ends_with('\n') ? text : text + '\n';
}

std::vector<Note> tumble_notes(const TumbleReport& report) {
  std::vector<Note> notes = report.notes;
  const bool any = longest(report) != nullptr;
  for (const ChannelTumble& channel : report.channels) {
    const std::string prefix = channel.name + ": ";
    const bool harmless = any && !channel.axis.swings();
    if (!channel.refused.empty())
      notes.push_back({harmless ? Severity::warning : Severity::bad, prefix + channel.refused});
    if (!channel.fit) continue;
    for (const std::string& text : channel.fit->notes)
      notes.push_back({Severity::warning, prefix + text});
  }
  return notes;
}

Recording tumble_series(const TumbleReport& report) {
  Recording out;
  out.source = "proofmass tumble";
  out.format = "series";
  const ChannelTumble* rows = longest(report);
  if (rows == nullptr) return out;
  const Unit plain{Quantity::unknown, 1.0, 0.0, "1"};
  std::vector<double> angle, direction, mount, plane;
  for (const TumblePosition& p : rows->positions) {
    angle.push_back(p.angle_rad);
    direction.push_back(p.direction);
    mount.push_back(p.mount_rad);
    plane.push_back(p.plane);
  }
  out.channels = {{"angle", *parse_unit("rad"), std::move(angle)},
                  {"direction", plain, std::move(direction)},
                  {"mount", *parse_unit("rad"), std::move(mount)},
                  {"plane", plain, std::move(plane)}};
  for (const ChannelTumble& channel : report.channels)
    if (channel.fit) add_columns(channel, *rows, out);
  return out;
}

}  // namespace proofmass::report
