#include "proofmass/sensor/calibration.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace proofmass::sensor {
namespace {

using Columns = std::array<std::vector<double>, 3>;

double si_or(const std::optional<Figure>& figure, double otherwise) {
  return figure ? figure->si() : otherwise;
}

std::array<std::optional<std::size_t>, 3> indices(const Triad& triad) {
  return {triad.x, triad.y, triad.z};
}

Error missing(const Channel& channel, std::string_view figure) {
  return {Errc::invalid_argument, "channel " + channel.name + " is in " + channel.unit.symbol +
                                      ", which needs " + std::string(figure) +
                                      " (not 0) in the sensor file"};
}

/// A permitted unit of a calibration's scale, and the corresponding reading.
struct Reading {
  std::string_view scale, bias;
  Quantity quantity;
};
constexpr std::array<Reading, 3> readings{{{"1", "m/s^2", Quantity::acceleration},
                                           {"V/(m/s^2)", "V", Quantity::voltage},
                                           {"counts/(m/s^2)", "counts", Quantity::counts}}};

/// The first figure whose SI unit differs; nullptr if there is none.
const Figure* first_not_in(std::string_view si_symbol, const AxisFigures& figures) {
  for (const auto& figure : figures)
    if (figure && figure->unit.si_symbol != si_symbol) return &*figure;
  return nullptr;
}

Result<Quantity> reading_quantity(const Calibration& calibration) {
  const auto reading = std::ranges::find_if(readings, [&](const Reading& r) {
    return first_not_in(r.scale, calibration.scale) == nullptr;
  });
  if (reading == readings.end())
    return Error{Errc::invalid_argument,
                 "calibration.scale must be of one unit on all axes: 1, V/g or counts/g, say"};
  for (const auto& figure : calibration.scale)
    if (figure && figure->si() == 0.0)
      return Error{Errc::invalid_argument, "calibration.scale must not be 0"};
  if (const Figure* bias = first_not_in(reading->bias, calibration.bias))
    return Error{Errc::invalid_argument, "calibration.bias is in " + bias->unit.symbol +
                                             ", but to that scale belongs one in " +
                                             std::string(reading->bias)};
  return reading->quantity;
}

Quantity quantity_of_lsb(const Figure& lsb) {
  return lsb.unit.si_symbol == "V" ? Quantity::voltage : Quantity::acceleration;
}

/// V_ref / V_s at each sample, or one number if no supply is recorded.
Result<std::vector<double>> supply_correction(const Electrical& electrical,
                                              const Recording& recording) {
  if (!electrical.reference_supply) return std::vector{1.0};
  const double reference_v = electrical.reference_supply->si();
  if (electrical.supply_channel.empty())
    return std::vector{reference_v / si_or(electrical.supply, reference_v)};
  const Channel* supply = recording.find(electrical.supply_channel);
  if (supply == nullptr || supply->unit.quantity != Quantity::voltage)
    return Error{Errc::invalid_argument, "the sensor file takes the supply from channel \"" +
                                             electrical.supply_channel +
                                             "\", which the recording does not have in volts"};
  std::vector<double> correction;
  correction.reserve(supply->values.size());
  for (const double v : supply->values) correction.push_back(reference_v / supply->unit.si(v));
  return correction;
}

void multiply(std::vector<double>& values, const std::vector<double>& by) {
  for (std::size_t k = 0; k < values.size(); ++k) values[k] *= by.size() == 1 ? by[0] : by[k];
}

/// Conversion of one channel to the calibration's reading; see Electrical for the equations.
struct Nominal {
  const Electrical& electrical;
  const std::vector<double>& supply_correction;
  Quantity wanted;

  Result<std::vector<double>> operator()(const Channel& channel, std::size_t axis) const {
    std::vector<double> values = channel.values.copy();
    for (double& v : values) v = channel.unit.si(v);
    Quantity have = channel.unit.quantity;
    if (have == Quantity::counts && wanted != have) {
      if (!electrical.lsb || electrical.lsb->si() == 0.0) return missing(channel, "electrical.lsb");
      for (double& v : values) v *= electrical.lsb->si();
      have = quantity_of_lsb(*electrical.lsb);
    }
    if (wanted == Quantity::counts && have != wanted) return to_counts(std::move(values), channel);
    if (have == Quantity::voltage) {
      multiply(values, supply_correction);
      if (wanted == Quantity::acceleration) return from_volts(std::move(values), channel, axis);
    }
    if (have != wanted)
      return Error{Errc::invalid_argument,
                   "channel " + channel.name + " is in " + channel.unit.symbol +
                       ", but the sensor file's calibration is of " + std::string(name_of(wanted))};
    return values;
  }

  /// Reverses the conversion of counts to volts or acceleration by the LSB.
  Result<std::vector<double>> to_counts(std::vector<double> values, const Channel& channel) const {
    if (!electrical.lsb || electrical.lsb->si() == 0.0 ||
        quantity_of_lsb(*electrical.lsb) != channel.unit.quantity)
      return Error{Errc::invalid_argument,
                   "channel " + channel.name + " is in " + channel.unit.symbol +
                       ", but the sensor file's calibration is of counts: record counts, or give "
                       "electrical.lsb (not 0) in that unit"};
    for (double& v : values) v /= electrical.lsb->si();
    return values;
  }

  Result<std::vector<double>> from_volts(std::vector<double> values,
                                         const Channel& channel,
                                         std::size_t axis) const {
    const double sensitivity = si_or(electrical.sensitivity[axis], 0.0);
    if (sensitivity == 0.0) return missing(channel, "electrical.sensitivity");
    const auto& supply =
        electrical.reference_supply ? electrical.reference_supply : electrical.supply;
    if (electrical.zero_g_fraction[axis] && !supply) return missing(channel, "electrical.supply");
    const double zero_v = si_or(electrical.zero_g_fraction[axis], 0.0) * si_or(supply, 0.0);
    for (double& v : values) v = (v - zero_v) / sensitivity;
    return values;
  }
};

/// reading -> f in place; an axis without a column counts as zero force.
void correct(const Calibration& calibration, Columns& columns) {
  const auto M = correction_matrix(calibration);
  const std::array<double, 3> bias{si_or(calibration.bias[0], 0.0), si_or(calibration.bias[1], 0.0),
                                   si_or(calibration.bias[2], 0.0)};
  // T is upper triangular: row i uses only the columns from i on, which are not yet overwritten.
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t k = 0; k < columns[row].size(); ++k) {
      double sum = 0.0;
      for (std::size_t axis = row; axis < 3; ++axis)
        if (M[row][axis] != 0.0 && !columns[axis].empty())
          sum += M[row][axis] * (columns[axis][k] - bias[axis]);
      columns[row][k] = sum;
    }
}

/// True if T couples an axis that was not recorded into one that was.
bool lacks_an_axis(const Calibration& calibration, const Columns& columns) {
  const auto M = correction_matrix(calibration);
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t axis = row + 1; axis < 3; ++axis)
      if (M[row][axis] != 0.0 && columns[axis].empty() && !columns[row].empty()) return true;
  return false;
}

}  // namespace

Status bring_to_reference_supply(const Electrical& electrical,
                                 const Triad& triad,
                                 Recording& recording) {
  const auto correction = supply_correction(electrical, recording);
  if (!correction) return correction.error();
  for (const auto& axis : {triad.x, triad.y, triad.z}) {
    if (!axis || recording.channels[*axis].unit.quantity != Quantity::voltage) continue;
    multiply(recording.channels[*axis].values.edit(), *correction);
  }
  return Done{};
}

Result<std::string> reading_unit(const Calibration& calibration) {
  const auto quantity = reading_quantity(calibration);
  if (!quantity) return quantity.error();
  return std::string(std::ranges::find(readings, *quantity, &Reading::quantity)->bias);
}

std::array<std::array<double, 3>, 3> correction_matrix(const Calibration& calibration) {
  const auto alpha = [&](std::size_t i) { return si_or(calibration.misalignment[i], 0.0); };
  const double yz = alpha(0), zy = alpha(1), zx = alpha(2);
  std::array<std::array<double, 3>, 3> M{{{1.0, -yz, zy}, {0.0, 1.0, -zx}, {0.0, 0.0, 1.0}}};
  for (auto& row : M)
    for (std::size_t axis = 0; axis < 3; ++axis) row[axis] /= si_or(calibration.scale[axis], 1.0);
  return M;
}

Status apply(const SensorModel& model, const Triad& triad, Recording& recording) {
  const auto wanted = reading_quantity(model.calibration);
  if (!wanted) return wanted.error();
  const auto supply = supply_correction(model.electrical, recording);
  if (!supply) return supply.error();
  const Nominal nominal{model.electrical, *supply, *wanted};
  const auto channels = indices(triad);
  Columns columns;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!channels[axis]) continue;
    if (!model.calibration.scale[axis] && *wanted != Quantity::acceleration)
      return missing(recording.channels[*channels[axis]], "calibration.scale");
    auto values = nominal(recording.channels[*channels[axis]], axis);
    if (!values) return values.error();
    columns[axis] = std::move(values).value();
  }
  if (lacks_an_axis(model.calibration, columns))
    recording.notes.push_back(
        {Severity::warning, triad.name + ": the calibration corrects for an axis that was not "
                                         "recorded; the force along it was taken as 0"});
  correct(model.calibration, columns);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!channels[axis]) continue;
    Channel& channel = recording.channels[*channels[axis]];
    channel.values = std::move(columns[axis]);
    channel.unit = {Quantity::acceleration, 1.0, 0.0, "m/s^2"};
  }
  return Done{};
}

Status apply(const SensorModel& model, Recording& recording) {
  const std::vector<Triad> triads = accelerometer_triads(recording);
  if (triads.empty())
    return Error{Errc::invalid_argument,
                 "no accelerometer channel to apply the sensor file to; name them acc_x, acc_y, …"};
  Recording corrected = recording;
  for (const Triad& triad : triads)
    if (const Status status = apply(model, triad, corrected); !status) return status.error();
  recording = std::move(corrected);
  return Done{};
}

std::optional<double> alignment_std_rad(const SensorModel& model) {
  const auto& figure = model.calibration.alignment_std;
  return figure ? std::optional(figure->si()) : std::nullopt;
}

}  // namespace proofmass::sensor
