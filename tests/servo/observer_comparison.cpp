#include "observer_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "contact_bank.hpp"
#include "proofmass/core/statistics.hpp"
#include "proofmass/core/units.hpp"
#include "proofmass/servo/motor_model_test_support.hpp"
#include "proofmass/simulate/gear_motor.hpp"

namespace proofmass::servo_comparison {
namespace {

constexpr std::array all{
    Scenario{"steps"},
    Scenario{"sine", 0.012, 0.15, 0.013, true},
    Scenario{"steps, backlash of 3°", 0.052},
    Scenario{"sine, backlash of 3°", 0.052, 0.15, 0.013, true},
    Scenario{"steps, backlash of 3°, load that turns freely", 0.052, 0.02},
    Scenario{"steps, a quarter of the noise", 0.012, 0.15, 0.003},
};

// The first seconds turn the wheel, so that the biases are known.
constexpr double turning_s = 8.0, duration_s = 40.0;

double voltage_at(const Scenario& scenario, double t_s) {
  if (t_s < turning_s) return 30.0;
  constexpr double period_s = 4.0, half_s = 1.5;
  if (scenario.is_slow) return 9.0 * std::sin(2.0 * std::numbers::pi * t_s / period_s);
  return std::fmod(t_s, 2.0 * half_s) < half_s ? 25.0 : -25.0;
}

class Tally {
 public:
  void add(const Uncertain& found, double truth_rad) {
    const double off = found.value - truth_rad;
    squares_ += off * off;
    within_ += std::abs(off) < 1.96 * found.std ? 1 : 0;
    largest_z_ = std::max(largest_z_, std::abs(off) / found.std);
    ++count_;
  }
  [[nodiscard]] Crossing crossing() const {
    return {std::sqrt(squares_ / count_), within_ / count_, largest_z_};
  }

 private:
  double squares_ = 0.0, within_ = 0.0, largest_z_ = 0.0, count_ = 0.0;
};

void run(const Scenario& scenario, unsigned seed, Tally& smooth, Tally& bank) {
  constexpr double step_s = 0.005, current_std_a = 0.002, bias_std_mps2 = 0.1, after_s = 0.2;
  simulate::GearMotorParameters drive;
  drive.backlash_rad = scenario.backlash_rad;
  drive.load_coulomb_nm = scenario.load_coulomb_nm;
  simulate::GearMotor motor(drive);
  const servo::MotorObserverOptions options{.model = servo::model_of(drive),
                                            .step_s = step_s,
                                            .accel_std_mps2 = scenario.noise_mps2,
                                            .bias_std_mps2 = bias_std_mps2,
                                            .current_std_a = current_std_a};
  servo::MotorObserver observer(options, 0.0);
  ContactBank contacts(options);
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> normal;
  const double bias = bias_std_mps2 * normal(engine), g = standard_gravity_mps2;
  double crossed_s = -1.0;
  int flank = 0;
  for (int k = 0; k * step_s < duration_s; ++k) {
    const double t = k * step_s, voltage = voltage_at(scenario, t);
    motor.advance(voltage, step_s);
    observer.predict(voltage);
    contacts.predict(voltage);
    const simulate::GearMotorState& truth = motor.state();
    const double angle = truth.load_rad;
    const servo::MotorSample sample{
        .current_a = truth.current_a + current_std_a * normal(engine),
        .accel_mps2 = {g * std::sin(angle) + bias + scenario.noise_mps2 * normal(engine),
                       g * std::cos(angle) - bias + scenario.noise_mps2 * normal(engine)}};
    observer.update(sample);
    contacts.update(sample);
    if (truth.contact == 0 || (flank != 0 && truth.contact != flank)) crossed_s = t;
    if (truth.contact != 0) flank = truth.contact;
    if (t < turning_s || t - crossed_s > after_s) continue;
    smooth.add(observer.load_rad(), angle);
    bank.add(contacts.load_rad(), angle);
  }
}

}  // namespace

std::span<const Scenario> scenarios() {
  return all;
}

Comparison compare(const Scenario& scenario, int recordings) {
  Tally smooth, bank;
  for (int k = 0; k < recordings; ++k) run(scenario, static_cast<unsigned>(k), smooth, bank);
  return {smooth.crossing(), bank.crossing()};
}

}  // namespace proofmass::servo_comparison
