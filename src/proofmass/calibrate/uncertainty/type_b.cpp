#include "proofmass/calibrate/uncertainty/type_b.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <initializer_list>
#include <utility>
#include <vector>

#include "proofmass/sensor/figure.hpp"

namespace proofmass::calibrate {
namespace {

struct TargetWord {
  TypeBTarget target;
  std::string_view word;
  std::string_view example;  ///< an example of its unit
  std::initializer_list<std::string_view> si_units;
};
const std::array<TargetWord, 7> targets{{
    {TypeBTarget::bias, "bias", "mg", {"m/s^2", "V", "counts"}},
    {TypeBTarget::scale, "scale", "%", {"1", "V/(m/s^2)", "counts/(m/s^2)"}},
    {TypeBTarget::misalignment, "misalignment", "deg", {"rad"}},
    {TypeBTarget::k0, "K0", "mg", {"m/s^2", "V", "counts"}},
    {TypeBTarget::k1, "K1", "%", {"1", "V/(m/s^2)", "counts/(m/s^2)"}},
    {TypeBTarget::angle, "angle", "deg", {"rad"}},
    {TypeBTarget::gravity, "gravity", "m/s^2", {"m/s^2"}},
}};

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

std::string lower(std::string_view text) {
  std::string low(text);
  for (char& c : low)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return low;
}

std::vector<std::string_view> parts_of(std::string_view text) {
  std::vector<std::string_view> parts;
  for (;;) {
    const std::size_t comma = text.find(',');
    parts.push_back(trimmed(text.substr(0, comma)));
    if (comma == std::string_view::npos) return parts;
    text.remove_prefix(comma + 1);
  }
}

Error expected(std::string_view what, std::string_view found) {
  return {Errc::invalid_argument, fmt::format("expected {}, not '{}'", what, found)};
}

Status read_target(std::string_view text, TypeB& line) {
  const std::size_t dot = text.find('.');
  const std::string word = lower(trimmed(text.substr(0, dot)));
  const auto* const found =
      std::ranges::find_if(targets, [&](const TargetWord& t) { return lower(t.word) == word; });
  const Error wrong = expected(
      "bias, scale, misalignment, K0, K1, angle or gravity, with .x, .y or .z for one axis", text);
  if (found == targets.end()) return wrong;
  line.target = found->target;
  if (dot == std::string_view::npos) return Done{};
  const std::string axis = lower(trimmed(text.substr(dot + 1)));
  if (axis != "x" && axis != "y" && axis != "z") return wrong;
  line.axis = static_cast<std::size_t>(axis[0] - 'x');
  return Done{};
}

struct Amount {
  double value;
  std::string_view unit;
};

std::optional<Amount> amount_of(std::string_view text) {
  text = trimmed(text);
  double value = 0.0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || !std::isfinite(value) || value <= 0.0) return std::nullopt;
  return Amount{value, trimmed({stop, static_cast<std::size_t>(text.data() + text.size() - stop)})};
}

// The amount, where "2 K * 1 mg/K" is evaluated to 2 mg.
std::optional<Amount> product_of(std::string_view text) {
  constexpr std::array<std::string_view, 3> signs{"*", "×", " x "};
  for (const std::string_view sign : signs) {
    const std::size_t at = text.find(sign);
    if (at == std::string_view::npos) continue;
    const auto span = amount_of(text.substr(0, at));
    auto slope = amount_of(text.substr(at + sign.size()));
    if (!span || !slope || (span->unit != "K" && span->unit != "degC")) return std::nullopt;
    const std::size_t slash = slope->unit.rfind('/');
    if (slash == std::string_view::npos || slope->unit.substr(slash) != "/K") return std::nullopt;
    return Amount{span->value * slope->value, slope->unit.substr(0, slash)};
  }
  return amount_of(text);
}

Status read_amount(std::string_view text, TypeB& line) {
  const TargetWord& target = targets[static_cast<std::size_t>(line.target)];
  const auto amount = product_of(text);
  if (!amount)
    return expected(fmt::format("a number above 0 with its unit (\"0.1 {0}\", \"2 K * 1 {0}/K\")",
                                target.example),
                    text);
  const auto unit = sensor::parse_figure_unit(amount->unit);
  // parse_figure_unit() accepts an empty unit as "1", but here the unit was probably omitted.
  if (!unit || amount->unit.empty() || std::ranges::count(target.si_units, unit->si_symbol) == 0)
    return expected(fmt::format("a unit of {} (\"{}\")", target.word, target.example), text);
  line.std = amount->value * unit->to_si;
  line.unit = unit->si_symbol;
  return Done{};
}

std::optional<Distribution> distribution_of(std::string_view text) {
  std::string word = lower(text);
  std::ranges::replace(word, '-', ' ');
  std::ranges::replace(word, '_', ' ');
  for (const Distribution d : {Distribution::normal, Distribution::uniform,
                               Distribution::triangular, Distribution::arcsine})
    if (word == name_of(d)) return d;
  if (word == "gaussian") return Distribution::normal;
  if (word == "rectangular") return Distribution::uniform;
  if (word == "t" || word == "student t") return Distribution::student_t;
  return std::nullopt;
}

Status read_distribution(const std::vector<std::string_view>& parts, TypeB& line) {
  if (parts.size() > 3) {
    const auto distribution = distribution_of(parts[3]);
    if (!distribution)
      return expected("normal, uniform, triangular, arcsine or student-t", parts[3]);
    line.distribution = *distribution;
  }
  line.std = std_of_half_width(line.std, line.distribution);
  if (parts.size() > 4) {
    const auto dof = amount_of(parts[4]);
    if (!dof || dof->value < 1.0 || !dof->unit.empty())
      return expected("degrees of freedom of 1 or more", parts[4]);
    line.dof = dof->value;
  }
  if (line.distribution == Distribution::student_t && line.dof == 0.0)
    return Error{Errc::invalid_argument,
                 "expected the degrees of freedom after student-t: NAME,TARGET,VALUE "
                 "UNIT,student-t,DOF"};
  return Done{};
}

// Sources common to all axes: a converter's reference, gravity, a supply.
bool is_common(std::string_view source) {
  const std::string word = lower(source);
  return word == "adc reference" || word == "gravity" || word == "supply";
}

BudgetLine plain_line(const TypeB& type_b, double sensitivity) {
  return {.source = type_b.source,
          .type_a = false,
          .distribution = type_b.distribution,
          .std = type_b.std,
          .unit = type_b.unit,
          .sensitivity = sensitivity,
          .dof = type_b.dof};
}

}  // namespace

std::string_view name_of(TypeBTarget target) {
  return targets[static_cast<std::size_t>(target)].word;
}

Result<TypeB> parse_type_b(std::string_view text) {
  const std::vector<std::string_view> parts = parts_of(text);
  const auto at = [&](const Error& error) { return error.at(fmt::format("'{}'", text)); };
  if (parts.size() < 3 || parts.size() > 5 || parts[0].empty())
    return expected("NAME,TARGET,VALUE UNIT[,DISTRIBUTION[,DOF]]", text);
  TypeB line;
  line.source = parts[0];
  if (const Status good = read_target(parts[1], line); !good) return at(good.error());
  if (const Status good = read_amount(parts[2], line); !good) return at(good.error());
  if (const Status good = read_distribution(parts, line); !good) return at(good.error());
  line.common = !line.axis && (is_common(line.source) || line.target == TypeBTarget::gravity);
  return line;
}

Result<BudgetLine> line_of(const TypeB& type_b, const ParameterUnit& parameter) {
  const Error wrong{
      Errc::invalid_argument,
      fmt::format("{}: a contribution to {} in {} does not go with readings in {}", type_b.source,
                  name_of(type_b.target), type_b.unit, parameter.reading)};
  if (parameter.scale == 0.0 || !std::isfinite(parameter.scale))
    return Error{Errc::invalid_argument, type_b.source + ": the scale is not known"};
  switch (type_b.target) {
    case TypeBTarget::bias:
      if (type_b.unit == parameter.reading) return plain_line(type_b, 1.0);
      return type_b.unit == "m/s^2" ? Result<BudgetLine>(plain_line(type_b, parameter.scale))
                                    : wrong;
    case TypeBTarget::k0:
      if (type_b.unit == "m/s^2") return plain_line(type_b, 1.0);
      return type_b.unit == parameter.reading
                 ? Result<BudgetLine>(plain_line(type_b, 1.0 / parameter.scale))
                 : wrong;
    case TypeBTarget::scale:
    case TypeBTarget::k1:
      if (type_b.unit == "1") return plain_line(type_b, parameter.scale);
      return type_b.unit == fmt::format("{}/(m/s^2)", parameter.reading)
                 ? Result<BudgetLine>(plain_line(type_b, 1.0))
                 : wrong;
    case TypeBTarget::misalignment:
    case TypeBTarget::angle:
    case TypeBTarget::gravity:
      break;
  }
  return plain_line(type_b, 1.0);
}

}  // namespace proofmass::calibrate
