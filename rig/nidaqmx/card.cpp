#include "card.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace standin {
namespace {

constexpr std::array<Card, 11> all_cards{{{"Dev1", Fault::none},
                                          {"DevOverrun", Fault::buffer_overrun},
                                          {"DevFifo", Fault::fifo_overflow},
                                          {"DevChoked", Fault::overruns_only},
                                          {"DevUnplug", Fault::unplugged},
                                          {"DevGone", Fault::unreachable},
                                          {"DevTimeout", Fault::silent},
                                          {"DevShort", Fault::short_reads},
                                          {"DevHang", Fault::hangs},
                                          {"DevWild", Fault::wild_rate},
                                          {"Dev2", Fault::none}}};

constexpr std::array<Range, 8> all_ranges{{{-1.0, 1.0},
                                           {-1.25, 1.25},
                                           {-2.0, 2.0},
                                           {-2.5, 2.5},
                                           {-4.0, 4.0},
                                           {-5.0, 5.0},
                                           {-10.0, 10.0},
                                           {-20.0, 20.0}}};
constexpr Range single_ended_range{-10.0, 10.0};

}  // namespace

const Card* card_of(std::string_view device) {
  const auto* const found = std::ranges::find(all_cards, device, &Card::name);
  return found != all_cards.end() ? found : nullptr;
}

std::span<const Range> ranges() {
  return all_ranges;
}

std::optional<Terminals> granted_terminals(unsigned index, std::int32_t asked) {
  const bool has_pair = index < inputs / 2;
  if (asked == by_default) return has_pair ? differential : rse;
  if (asked == rse) return rse;
  if (asked == differential && has_pair) return differential;
  return std::nullopt;
}

std::optional<Range> granted_range(Terminals terminals, double lowest, double highest) {
  const auto holds = [&](const Range& range) {
    return range.low <= lowest && highest <= range.high;
  };
  if (terminals == rse)
    return holds(single_ended_range) ? std::optional(single_ended_range) : std::nullopt;
  const auto* const found = std::ranges::find_if(all_ranges, holds);
  return found != all_ranges.end() ? std::optional(*found) : std::nullopt;
}

double granted_rate_hz(double asked_hz, std::size_t channels) {
  constexpr double timebase_hz = 12e6;
  if (!(asked_hz > 0.0) || asked_hz * static_cast<double>(channels) > most_samples_per_s)
    return 0.0;
  return timebase_hz / std::floor(timebase_hz / asked_hz);
}

double reading(const Channel& channel, std::uint64_t row, double time_s) {
  const double volts = channel.index == 0
                           ? -1.0 + 0.001 * static_cast<double>(row % 2000)
                           : std::sin(2.0 * std::numbers::pi * (1.0 + channel.index) * time_s);
  const double codes = channel.terminals == differential ? 16384.0 : 8192.0;
  const double step = (channel.range.high - channel.range.low) / codes;
  return std::clamp(std::round(volts / step) * step, channel.range.low, channel.range.high - step);
}

}  // namespace standin
