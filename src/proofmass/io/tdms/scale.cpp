#include "proofmass/io/tdms/scale.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <string_view>

#include "proofmass/io/text/wording.hpp"

namespace proofmass::io::tdms {
namespace {

constexpr double most_points = 65'536;

/// The properties of one scale; keeps the first missing one.
class ScaleProperties {
 public:
  ScaleProperties(const Properties& properties, std::uint32_t index, std::string_view kind)
      : properties_(properties), prefix_(fmt::format("NI_Scale[{}]_{}_", index, kind)) {}

  double operator()(std::string_view name) {
    const auto found = number_of(properties_, prefix_ + std::string(name));
    if (!found && missing_.empty()) missing_ = prefix_ + std::string(name);
    return found.value_or(0.0);
  }
  [[nodiscard]] std::optional<double> maybe(std::string_view name) const {
    return number_of(properties_, prefix_ + std::string(name));
  }
  /// "name[0]" … "name[count - 1]"
  std::vector<double> list(std::string_view name, double count) {
    std::vector<double> out;
    for (int i = 0; i < count && missing_.empty(); ++i)
      out.push_back((*this)(fmt::format("{}[{}]", name, i)));
    return out;
  }
  [[nodiscard]] Result<Scale> done(Scale scale) const {
    if (missing_.empty()) return scale;
    return Error{Errc::unsupported, missing_ + " is missing"};
  }

 private:
  const Properties& properties_;
  std::string prefix_;
  std::string missing_;
};

Error impossible(std::string_view what) {
  return {Errc::unsupported, std::string(what)};
}

bool is_count(double value) {
  return value >= 0.0 && value <= most_points && value == std::floor(value);
}

Result<Scale> read_polynomial(ScaleProperties& of) {
  const double size = of.maybe("Coefficients_Size").value_or(4.0);
  if (!is_count(size)) return impossible("a polynomial of too many coefficients");
  Polynomial polynomial{of.list("Coefficients", size)};
  return of.done(std::move(polynomial));
}

/// The "scaled values" are the input and the "pre-scaled" ones the output, as in NI's own readers.
Result<Scale> read_lookup(ScaleProperties& of) {
  const double size = of("Scaled_Values_Size");
  if (!is_count(size) || size < 1.0 || of("Pre_Scaled_Values_Size") != size)
    return impossible("a table whose columns differ in length, or are none");
  Lookup table{of.list("Scaled_Values", size), of.list("Pre_Scaled_Values", size)};
  if (table.x.size() > 1 && table.x.front() > table.x.back()) {
    std::ranges::reverse(table.x);
    std::ranges::reverse(table.y);
  }
  for (std::size_t i = 1; i < table.x.size(); ++i)
    if (!(table.x[i] > table.x[i - 1])) return impossible("a table that does not ascend");
  return of.done(std::move(table));
}

constexpr double current_excitation = 10134;
constexpr double voltage_excitation = 10322;

/// The part of the leads' resistance in the measured path, by the number of wires.
double leads_ohm(double lead_ohm, double wires, bool is_divider) {
  if (wires == 3) return lead_ohm;
  return wires == 2 && !is_divider ? 2.0 * lead_ohm : 0.0;
}

Result<Scale> read_rtd(ScaleProperties& of) {
  Rtd rtd;
  rtd.current_amp = of("Current_Excitation");
  rtd.r0_ohm = of("R0_Nominal_Resistance");
  rtd.a = of("A");
  rtd.b = of("B");
  rtd.c = of("C");
  rtd.lead_ohm = leads_ohm(of("Lead_Wire_Resistance"), of("Resistance_Configuration"), false);
  if (rtd.current_amp == 0.0 || rtd.r0_ohm == 0.0 || rtd.a == 0.0)
    return impossible("a resistance thermometer without current, resistance or coefficients");
  return of.done(rtd);
}

Result<Scale> read_strain(ScaleProperties& of) {
  using Bridge = Strain::Bridge;
  Strain strain;
  const double configuration = of("Configuration");
  const bool is_full = configuration >= 10183 && configuration <= 10185;
  if (configuration == 10183)
    strain.bridge = Bridge::full_1;
  else if (configuration == 10184)
    strain.bridge = Bridge::full_2;
  else if (configuration == 10185)
    strain.bridge = Bridge::full_3;
  else if (configuration == 10188)
    strain.bridge = Bridge::half_1;
  else if (configuration == 10189)
    strain.bridge = Bridge::half_2;
  else if (configuration == 10271 || configuration == 10272)
    strain.bridge = Bridge::quarter;
  else
    return impossible(fmt::format("strain gages in configuration {}", configuration));
  strain.poisson = of("Poisson_Ratio");
  strain.gage_factor = of("Gage_Factor");
  strain.excitation_volt = of("Voltage_Excitation");
  strain.unstrained_volt = of("Initial_Bridge_Voltage");
  strain.gain = of.maybe("Bridge_Shunt_Calibration_Gain_Adjustment").value_or(1.0);
  const double gage_ohm = of("Gage_Resistance");
  if (!is_full) strain.gain *= 1.0 + of("Lead_Wire_Resistance") / gage_ohm;
  if (strain.gage_factor == 0.0 || strain.excitation_volt == 0.0 || gage_ohm == 0.0)
    return impossible("strain gages without factor, resistance or excitation");
  return of.done(strain);
}

Result<Scale> read_thermistor(ScaleProperties& of) {
  Thermistor thermistor;
  const double type = of("Excitation_Type");
  if (type != current_excitation && type != voltage_excitation)
    return impossible(fmt::format("a thermistor of excitation {}", type));
  thermistor.is_divider = type == voltage_excitation;
  thermistor.excitation = of("Excitation_Value");
  thermistor.r1_ohm = of("R1_Reference_Resistance");
  thermistor.lead_ohm =
      leads_ohm(of("Lead_Wire_Resistance"), of("Resistance_Configuration"), thermistor.is_divider);
  thermistor.a = of("A");
  thermistor.b = of("B");
  thermistor.c = of("C");
  thermistor.offset_kelvin = of("Temperature_Offset");
  return of.done(thermistor);
}

Result<Scale> read_thermocouple(ScaleProperties& of) {
  struct Code {
    double code;
    char type;
  };
  constexpr std::array<Code, 8> codes{{{10047, 'B'},
                                       {10055, 'E'},
                                       {10072, 'J'},
                                       {10073, 'K'},
                                       {10077, 'N'},
                                       {10082, 'R'},
                                       {10085, 'S'},
                                       {10086, 'T'}}};
  const double asked = of.maybe("Thermocouple_Type").value_or(10072);
  const auto found = std::ranges::find(codes, asked, &Code::code);
  if (found == codes.end()) return impossible(fmt::format("a thermocouple of type {}", asked));
  return of.done(Thermocouple{found->type, of.maybe("Scaling_Direction").value_or(0.0) == 1.0});
}

}  // namespace

Result<Scale> read_scale(const Properties& properties, std::uint32_t index) {
  const std::string kind = text_of(properties, fmt::format("NI_Scale[{}]_Scale_Type", index));
  ScaleProperties of(properties, index, kind);
  if (kind == "Linear") {
    const Linear linear{of("Slope"), of("Y_Intercept")};
    return of.done(linear);
  }
  if (kind == "Polynomial") return read_polynomial(of);
  if (kind == "Table") return read_lookup(of);
  if (kind == "RTD") return read_rtd(of);
  if (kind == "Strain") return read_strain(of);
  if (kind == "Thermistor") return read_thermistor(of);
  if (kind == "Thermocouple") return read_thermocouple(of);
  if (kind == "Add") return Scale(Sum{1.0});
  if (kind == "Subtract") return Scale(Sum{-1.0});
  if (kind == "AdvancedAPI") return Scale(Identity{});
  return impossible(fmt::format("a scale of kind \"{}\"", kind));
}

std::string words_for(const Scale& scale) {
  if (const auto* linear = std::get_if<Linear>(&scale))
    return fmt::format("linear {} x + {}", in_words(linear->slope), in_words(linear->intercept));
  if (const auto* polynomial = std::get_if<Polynomial>(&scale))
    return fmt::format("polynomial of {} coefficients", polynomial->coefficients.size());
  if (const auto* table = std::get_if<Lookup>(&scale))
    return fmt::format("table of {} points", table->x.size());
  if (std::holds_alternative<Rtd>(scale)) return "resistance thermometer";
  if (std::holds_alternative<Strain>(scale)) return "strain gages";
  if (std::holds_alternative<Thermistor>(scale)) return "thermistor";
  if (const auto* couple = std::get_if<Thermocouple>(&scale))
    return fmt::format("thermocouple {}{}", couple->type, couple->to_voltage ? " to voltage" : "");
  if (const auto* sum = std::get_if<Sum>(&scale))
    return sum->sign_of_left > 0.0 ? "sum" : "difference";
  return "no change";
}

}  // namespace proofmass::io::tdms
