#include "proofmass/sensor/encoder_update.hpp"

#include <cmath>

#include "proofmass/sensor/file/change.hpp"

namespace proofmass::sensor {

std::optional<std::array<Uncertain, 4>> encoder_errors_rad(const Encoder& encoder) {
  std::array<Uncertain, 4> errors{};
  const std::array figures{&encoder.once_cos, &encoder.once_sin, &encoder.twice_cos,
                           &encoder.twice_sin};
  for (std::size_t k = 0; k < figures.size(); ++k) {
    const std::optional<Figure>& figure = *figures[k];
    if (!figure || !figure->std) return std::nullopt;
    errors[k] = {figure->si(), *figure->std_si()};
  }
  return errors;
}

Status update_encoder(SensorModel& model, const MeasuredEncoder& measured) {
  for (const Uncertain& error : measured.errors_rad) {
    if (!std::isfinite(error.value) || !std::isfinite(error.std))
      return Error{Errc::not_finite, "encoder: a figure is not finite"};
    if (error.std < 0.0)
      return Error{Errc::invalid_argument, "encoder: a negative standard deviation"};
  }
  Encoder& encoder = model.encoder;
  encoder.counts_per_turn.reset();
  if (measured.counts_per_turn)
    encoder.counts_per_turn = make_figure(*measured.counts_per_turn, "1", measured.origin);
  const std::array figures{&encoder.once_cos, &encoder.once_sin, &encoder.twice_cos,
                           &encoder.twice_sin};
  for (std::size_t k = 0; k < figures.size(); ++k) {
    *figures[k] = make_figure(measured.errors_rad[k].value, "rad", measured.origin);
    (*figures[k])->std = measured.errors_rad[k].std;
  }
  return Done{};
}

Status update_encoder(const std::string& path, const MeasuredEncoder& measured) {
  return change_sensor_file(path,
                            [&](SensorModel& model) { return update_encoder(model, measured); });
}

}  // namespace proofmass::sensor
