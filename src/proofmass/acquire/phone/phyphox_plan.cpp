#include "proofmass/acquire/phone/phyphox_plan.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "proofmass/acquire/phone/sensors.hpp"
#include "proofmass/io/names.hpp"

namespace proofmass::acquire {
namespace {

/// "Acceleration x (m/s^2)" to m/s^2.
Unit unit_in(std::string_view label) {
  const std::size_t open = label.rfind('(');
  if (open == std::string_view::npos) return {};
  return parse_unit(label.substr(open)).value_or(Unit{});
}

const PhyphoxConfig::Input* input_of(const PhyphoxConfig& config, std::string_view source) {
  const auto found = std::ranges::find(config.inputs, source, &PhyphoxConfig::Input::source);
  return found == config.inputs.end() || !found->outputs.contains("t") ? nullptr : &*found;
}

const PhyphoxConfig::Input* input_with(const PhyphoxConfig& config, std::string_view buffer) {
  const auto has = [&](const auto& output) { return output.second == buffer; };
  const auto found = std::ranges::find_if(
      config.inputs, [&](const auto& input) { return std::ranges::any_of(input.outputs, has); });
  return found == config.inputs.end() ? nullptr : &*found;
}

Unit unit_of(const PhyphoxConfig& config, const std::string& buffer) {
  if (const auto* const input = input_with(config, buffer)) {
    const Unit unit = phone_sensor(input->source).unit;
    if (unit.quantity != Quantity::unknown) return unit;
  }
  for (const PhyphoxConfig::Export& one : config.exports)
    if (one.buffer == buffer) return unit_in(one.label);
  return {};
}

void add_buffer(PhyphoxGroup& group, const PhyphoxConfig& config, const std::string& buffer) {
  group.buffers.push_back(buffer);
  group.units.push_back(unit_of(config, buffer));
}

PhyphoxGroup group_of(const PhyphoxConfig& config, const PhyphoxConfig::Input& input) {
  PhyphoxGroup group{.sensor = input.source, .time = input.outputs.at("t")};
  for (const char* const axis : {"x", "y", "z"})
    if (const auto found = input.outputs.find(axis); found != input.outputs.end())
      add_buffer(group, config, found->second);
  return group;
}

/// The time among a set of exports; empty if there is none.
std::string time_in_set(const PhyphoxConfig& config, std::size_t set) {
  for (const PhyphoxConfig::Export& one : config.exports)
    if (one.set == set && io::lower(one.label).starts_with("time")) return one.buffer;
  return {};
}

/// If no input is an acceleration (a Bluetooth sensor), a label may be.
std::optional<PhyphoxGroup> labelled_group(const PhyphoxConfig& config) {
  for (const PhyphoxConfig::Export& first : config.exports) {
    const std::string time = time_in_set(config, first.set);
    PhyphoxGroup group{.sensor = "acceleration", .time = time};
    for (const PhyphoxConfig::Export& one : config.exports)
      if (one.set == first.set && unit_in(one.label).quantity == Quantity::acceleration &&
          !io::lower(one.label).starts_with("abs"))
        add_buffer(group, config, one.buffer);
    if (!time.empty() && !group.buffers.empty()) return group;
  }
  return std::nullopt;
}

std::string inputs_of(const PhyphoxConfig& config) {
  std::vector<std::string_view> names;
  for (const auto& input : config.inputs) names.push_back(input.source);
  return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

Status check_buffer(const PhyphoxConfig& config, const std::string& name) {
  std::vector<std::string_view> names;
  for (const auto& buffer : config.buffers) names.push_back(buffer.name);
  if (std::ranges::find(names, name) != names.end()) return Done{};
  return Error{Errc::invalid_argument, fmt::format("{}: no such buffer of \"{}\", which has {}",
                                                   name, config.title, fmt::join(names, ", "))};
}

Result<std::vector<PhyphoxGroup>> named_buffers(const PhyphoxConfig& config,
                                                const PhyphoxWish& wish) {
  PhyphoxGroup group{.sensor = "buffers", .time = wish.time};
  const auto* const input = input_with(config, wish.buffers.front());
  if (group.time.empty() && input != nullptr && input->outputs.contains("t"))
    group.time = input->outputs.at("t");
  if (group.time.empty())
    return Error{Errc::invalid_argument,
                 "buffers=: expected time= too, with the buffer of their time"};
  if (const Status there = check_buffer(config, group.time); !there) return there.error();
  for (const std::string& buffer : wish.buffers) {
    if (const Status there = check_buffer(config, buffer); !there) return there.error();
    add_buffer(group, config, buffer);
  }
  return std::vector{std::move(group)};
}

Result<std::vector<PhyphoxGroup>> named_sensors(const PhyphoxConfig& config,
                                                const PhyphoxWish& wish) {
  std::vector<PhyphoxGroup> groups;
  for (const std::string& sensor : wish.sensors) {
    const auto* const input = input_of(config, sensor);
    if (input == nullptr)
      return Error{Errc::invalid_argument,
                   fmt::format("sensors={}: no such input with a time of \"{}\", which has {}",
                               sensor, config.title, inputs_of(config))};
    groups.push_back(group_of(config, *input));
  }
  return groups;
}

}  // namespace

Result<std::vector<PhyphoxGroup>> plan_phyphox(const PhyphoxConfig& config,
                                               const PhyphoxWish& wish) {
  if (!wish.buffers.empty()) return named_buffers(config, wish);
  if (!wish.sensors.empty()) return named_sensors(config, wish);
  std::vector<PhyphoxGroup> groups;
  for (const char* const sensor : {"accelerometer", "linear_acceleration", "gyroscope"}) {
    const bool is_second = std::string_view(sensor) == "linear_acceleration" && !groups.empty();
    const auto* const input = input_of(config, sensor);
    if (input != nullptr && !is_second) groups.push_back(group_of(config, *input));
  }
  const bool has_acceleration = !groups.empty() && groups.front().sensor != "gyroscope";
  const auto labelled = has_acceleration ? std::nullopt : labelled_group(config);
  if (labelled) groups.insert(groups.begin(), *labelled);
  std::erase_if(groups, [](const PhyphoxGroup& group) { return group.buffers.empty(); });
  if (!groups.empty()) return groups;
  return Error{Errc::device, fmt::format("the experiment \"{}\" has no acceleration with a time, "
                                         "its inputs are: {}; open \"Acceleration "
                                         "with g\" on the phone, or name buffers=…&time=…",
                                         config.title, inputs_of(config))};
}

}  // namespace proofmass::acquire
