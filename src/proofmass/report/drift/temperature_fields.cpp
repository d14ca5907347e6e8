#include <fmt/format.h>

#include "proofmass/report/drift/fields.hpp"
#include "proofmass/report/drift/wording.hpp"

namespace proofmass::report {
namespace {

using characterise::TemperatureModel;

Field coefficients(const TemperatureModel& model, const std::string& unit) {
  Fields items;
  for (std::size_t j = 0; j < model.coefficients.size(); ++j)
    items.push_back(field::measured({}, model.coefficients[j], per_kelvin(unit, j)));
  return field::list("coefficients", std::move(items), {.meaning = "c_j of sum c_j (T - T0)^j"});
}

Field covariance(const Eigen::MatrixXd& values) {
  Fields rows;
  for (Eigen::Index i = 0; i < values.rows(); ++i) {
    const Eigen::VectorXd row = values.row(i);
    rows.push_back(field::numbers({}, row));
  }
  return field::list("covariance", std::move(rows), {.meaning = "of the coefficients"});
}

Field cross_validation(const TemperatureModel& model) {
  return field::records(
      "cross_validation", model.cross_validation,
      [](const characterise::DegreeScore& score) -> Fields {
        return {field::integer("degree", score.degree),
                field::number("score", score.score, {.meaning = "mean square prediction error"}),
                field::number("excess", score.excess, {.meaning = "over the best degree's"}),
                field::magnitude("std", score.std, {.meaning = "of the excess"})};
      });
}

std::string_view name_of(characterise::Sweep sweep) {
  switch (sweep) {
    case characterise::Sweep::heating:
      return "heating";
    case characterise::Sweep::cooling:
      return "cooling";
    case characterise::Sweep::dwell:
      break;
  }
  return "dwell";
}

Field points(const TemperatureModel& model) {
  return field::records(
      "points", model.points, [](const characterise::TemperaturePoint& point) -> Fields {
        return {field::choice("sweep", name_of(point.sweep), {"heating", "cooling", "dwell"}),
                field::number("temperature_k", point.temperature_k),
                field::number("mean", point.mean), field::magnitude("std", point.std),
                field::count("blocks", point.blocks)};
      });
}

}  // namespace

Field temperature_field(const DriftTemperature& found, const Unit& unit) {
  const std::string level = level_unit(unit);
  std::optional<Fields> fields;
  if (found.model) {
    const TemperatureModel& model = *found.model;
    fields =
        Fields{field::text("channel", found.channel),
               verdict_field(model.verdict == characterise::Verdict::identified),
               field::text("reason", model.reason, {.meaning = "why it is not identified"}),
               field::integer("degree", model.degree),
               field::number("reference_k", model.reference_k, {.meaning = "T0"}),
               field::number("lowest_k", model.lowest_k,
                             {.meaning = "lower end of the range of validity"}),
               field::number("highest_k", model.highest_k, {.meaning = "upper end"}),
               coefficients(model, level),
               covariance(model.covariance),
               field::magnitude("bias_span", model.bias_span,
                                {.meaning = "largest less smallest of the curve"}),
               field::measured("hysteresis", model.hysteresis, level,
                               {.meaning = "heating less cooling at the same temperature",
                                .why_null = "heating and cooling share too little of the range"}),
               field::flag("hysteresis_significant", model.hysteresis_significant),
               field::magnitude("slope_upper_95", model.slope_upper_95,
                                {.meaning = "upper limit of the size of the mean slope, per K",
                                 .why_null = "the range of temperatures is too small"}),
               cross_validation(model),
               field::magnitude("residual_std", model.residual_std),
               field::magnitude("white_std", model.white_std),
               field::magnitude("drift_std", model.drift_std),
               field::magnitude("block_s", model.block_s),
               points(model)};
  }
  return field::object_or_null(
      "temperature", std::move(fields),
      {.meaning = "where the recording has a temperature channel",
       .why_null = fmt::format("no curve against {}: {}", found.channel, found.refused)});
}

}  // namespace proofmass::report
