#include "proofmass/acquire/sim/faults.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <string>
#include <string_view>

namespace proofmass::acquire {
namespace {

/// "5,-1"
std::optional<std::array<double, 2>> pair_of(std::string_view text) {
  std::array<double, 2> pair{};
  const char* const end = text.data() + text.size();
  const auto [comma, problem] = std::from_chars(text.data(), end, pair[0]);
  if (problem != std::errc{} || comma == end || *comma != ',') return std::nullopt;
  const auto [stop, second_problem] = std::from_chars(comma + 1, end, pair[1]);
  if (second_problem != std::errc{} || stop != end) return std::nullopt;
  if (!std::isfinite(pair[0]) || !std::isfinite(pair[1]) || pair[0] < 0.0) return std::nullopt;
  return pair;
}

Error expected(std::string_view key, std::string_view text, std::string_view what) {
  return {Errc::invalid_argument, fmt::format("{}={}: expected {}", key, text, what)};
}

Status read_stall(SourceUri& uri, SimFaults& faults) {
  const auto text = uri.value("stall");
  if (!text) return Done{};
  const auto pair = pair_of(*text);
  if (!pair || !((*pair)[1] > 0.0))
    return expected("stall", *text, "AT,FOR in seconds, such as 5,2");
  faults.stall = {(*pair)[0], (*pair)[1]};
  return Done{};
}

Status read_jump(SourceUri& uri, SimFaults& faults) {
  const auto text = uri.value("clock-jump");
  if (!text) return Done{};
  const auto pair = pair_of(*text);
  constexpr double most_s = 1e9;  // half of the range that the time leaves of 64-bit nanoseconds
  if (!pair || std::abs((*pair)[1]) > most_s)
    return expected("clock-jump", *text, "AT,BY in seconds, such as 5,-1");
  faults.clock_jump = {(*pair)[0], (*pair)[1]};
  return Done{};
}

}  // namespace

Result<SimFaults> sim_faults(SourceUri& uri) {
  SimFaults faults;
  const auto drop = uri.number("drop", 0.0);
  if (!drop) return drop.error();
  if (*drop && **drop >= 1.0) return expected("drop", *uri.value("drop"), "a share below 1");
  faults.drop = drop->value_or(0.0);
  if (const Status read = read_stall(uri, faults); !read) return read.error();
  const auto unplug_s = uri.number("unplug", 0.0);
  if (!unplug_s) return unplug_s.error();
  faults.unplug_s = *unplug_s;
  if (const Status read = read_jump(uri, faults); !read) return read.error();
  const auto dead = uri.choice("dead-clock", {"0", "1"});
  if (!dead) return dead.error();
  faults.dead_clock = *dead == "1";
  return faults;
}

}  // namespace proofmass::acquire
