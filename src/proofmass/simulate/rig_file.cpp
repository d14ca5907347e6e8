#include "proofmass/simulate/rig_file.hpp"

#include <array>
#include <charconv>
#include <cstdint>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <toml++/toml.h>
#include <utility>

#include "proofmass/simulate/rig_fields.hpp"

namespace proofmass::simulate {
namespace {

constexpr std::array<std::pair<RigOutput, std::string_view>, 3> outputs{
    {{RigOutput::acceleration, "acceleration"},
     {RigOutput::voltage, "voltage"},
     {RigOutput::counts, "counts"}}};

struct Failure {
  Error error;
};

[[noreturn]] void fail(const toml::node& node, std::string_view key, std::string_view why) {
  throw Failure{
      {Errc::invalid_argument, fmt::format("line {}: {} {}", node.source().begin.line, key, why)}};
}

/// What fills a member from a node; one overload for each kind of member.
struct Fill {
  const toml::node& node;
  std::string_view key;
  double to_si;

  void operator()(double& member) const {
    const auto value = node.is_number() ? node.value<double>() : std::nullopt;
    if (!value) fail(node, key, "must be a number");
    member = *value * to_si;
  }
  template <std::size_t N>
  void operator()(std::array<double, N>& member) const {
    const toml::array* array = node.as_array();
    if (array == nullptr || array->size() != N)
      fail(node, key, fmt::format("must be an array of {} numbers", N));
    for (std::size_t i = 0; i < N; ++i) Fill{(*array)[i], key, to_si}(member[i]);
  }
  void operator()(bool& member) const {
    const auto* value = node.as_boolean();
    if (value == nullptr) fail(node, key, "must be true or false");
    member = value->get();
  }
  void operator()(int& member) const {
    const auto* value = node.as_integer();
    if (value == nullptr || value->get() < -1000 || value->get() > 1000)
      fail(node, key, "must be a small whole number");
    member = static_cast<int>(value->get());
  }
  void operator()(std::uint64_t& member) const {
    const auto* value = node.as_integer();
    if (value == nullptr || value->get() < 0) fail(node, key, "must be a whole number, 0 or more");
    member = static_cast<std::uint64_t>(value->get());
  }
  void operator()(RigOutput& member) const {
    for (const auto& [output, name] : outputs)
      if (const auto text = node.value<std::string_view>(); text == name) {
        member = output;
        return;
      }
    fail(node, key, "must be \"acceleration\", \"voltage\" or \"counts\"");
  }
};

/// Visits a section's fields, and takes out of its table what it has read.
struct Take {
  toml::table& table;

  template <class Member>
  void operator()(std::string_view key, Member& member, double to_si, const char*) const {
    const toml::node* node = table.get(key);
    if (node == nullptr) return;
    Fill{*node, key, to_si}(member);
    table.erase(key);
  }
};

void must_be_empty(const toml::table& table, std::string_view section) {
  if (!table.empty())
    fail(table.begin()->second, table.begin()->first.str(),
         fmt::format("is no key of {}; `proofmass simulate --print-config` shows them all",
                     section));
}

/// [name], if it is there.
template <class Read>
void read_section(toml::table& root, std::string_view name, Read read) {
  toml::node* node = root.get(name);
  if (node == nullptr) return;
  if (!node->is_table()) fail(*node, name, fmt::format("must be a section, [{}]", name));
  read(Take{*node->as_table()});
  must_be_empty(*node->as_table(), fmt::format("[{}]", name));
  root.erase(name);
}

/// All of [[name]], if there is one; they replace what was there.
template <class Item, class Read>
void read_list(toml::table& root, std::string_view name, std::vector<Item>& items, Read read) {
  toml::node* node = root.get(name);
  if (node == nullptr) return;
  toml::array* array = node->as_array();
  if (array == nullptr || !array->is_array_of_tables())
    fail(*node, name, fmt::format("must be a list of sections, [[{}]]", name));
  items.clear();
  for (toml::node& element : *array) {
    read(items.emplace_back(), Take{*element.as_table()});
    must_be_empty(*element.as_table(), fmt::format("[[{}]]", name));
  }
  root.erase(name);
}

RigOptions read_options(toml::table& root) {
  RigOptions o;
  visit_general(o, Take{root});
  read_section(root, "wheel", [&](Take take) { visit_wheel(o.wheel, take); });
  read_section(root, "ripple", [&](Take take) { visit_ripple(o.wheel.ripple, take); });
  read_section(root, "supply", [&](Take take) { visit_supply(o.supply, take); });
  read_section(root, "daq", [&](Take take) { visit_daq(o.daq, take); });
  read_list(root, "segment", o.wheel.profile,
            [](SpeedSegment& segment, Take take) { visit_segment(segment, take); });
  read_list(root, "sensor", o.sensors,
            [](RigSensor& sensor, Take take) { visit_sensor(sensor, take); });
  must_be_empty(root, "a rig's description");
  return o;
}

/// The shortest decimal that, read and converted, is `si` again; the nearest where none is.
std::string number_text(double si, double to_si) {
  const double value = si / to_si;
  for (int digits = 1; digits < 17; ++digits) {
    const std::string text = fmt::format("{:.{}g}", value, digits);
    double back = 0.0;
    std::from_chars(text.data(), text.data() + text.size(), back);
    if (back * to_si == si) return fmt::format("{}", back);
  }
  return fmt::format("{}", value);
}

std::string value_text(double member, double to_si) {
  return number_text(member, to_si);
}
std::string value_text(bool member, double) {
  return member ? "true" : "false";
}
std::string value_text(int member, double) {
  return std::to_string(member);
}
std::string value_text(std::uint64_t member, double) {
  return std::to_string(member);
}
std::string value_text(RigOutput member, double) {
  for (const auto& [output, name] : outputs)
    if (output == member) return fmt::format("\"{}\"", name);
  return {};
}
template <std::size_t N>
std::string value_text(const std::array<double, N>& member, double to_si) {
  std::string text;
  for (const double v : member) text += (text.empty() ? "" : ", ") + number_text(v, to_si);
  return "[" + text + "]";
}

struct Print {
  std::string& out;
  template <class Member>
  void operator()(std::string_view key, const Member& member, double to_si, const char* why) const {
    out +=
        fmt::format("{:<44} # {}\n", fmt::format("{} = {}", key, value_text(member, to_si)), why);
  }
};

}  // namespace

Result<RigOptions> parse_rig_file(std::string_view text, std::string_view name) {
  try {
    toml::table root = toml::parse(text);
    RigOptions options = read_options(root);
    if (const Status checked = check(options); !checked) return checked.error().at(name);
    return options;
  } catch (const Failure& failure) {
    return failure.error.at(name);
  } catch (const toml::parse_error& error) {
    return Error{Errc::corrupt, fmt::format("{}: line {}: no TOML: {}", name,
                                            error.source().begin.line, error.description())};
  }
}

Result<RigOptions> read_rig_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  if (!in.is_open() || in.bad())
    return Error{Errc::unreadable, path + ": cannot be read; expected a rig's description (TOML)"};
  return parse_rig_file(text, path);
}

std::string format_rig_file(const RigOptions& options) {
  std::string out =
      "# A rig for `proofmass simulate`. A key that is left out keeps its default.\n\n";
  const Print print{out};
  visit_general(options, print);
  out += "\n[wheel]\n";
  visit_wheel(options.wheel, print);
  out += "\n[ripple]\n";
  visit_ripple(options.wheel.ripple, print);
  out += "\n[supply]\n";
  visit_supply(options.supply, print);
  out += "\n[daq]\n";
  visit_daq(options.daq, print);
  for (const SpeedSegment& segment : options.wheel.profile) {
    out += "\n[[segment]]\n";
    visit_segment(segment, print);
  }
  for (const RigSensor& sensor : options.sensors) {
    out += "\n[[sensor]]\n";
    visit_sensor(sensor, print);
  }
  return out;
}

}  // namespace proofmass::simulate
