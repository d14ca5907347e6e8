#include "wheel_coverage.hpp"

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <mutex>
#include <numbers>
#include <thread>

namespace proofmass::wheel_world {
namespace {

void compare(const estimate::WheelSolution& said, const Truth& truth, Coverage& into) {
  into.turns.add(said.turns, truth.turns);
  if (said.angle_final_rad) {
    const double off =
        std::remainder(said.angle_final_rad->value - truth.final_angle_rad, 2 * std::numbers::pi);
    into.angle.add(Uncertain{off, said.angle_final_rad->std}, 0.0);
  } else {
    into.angle.add(std::nullopt, 0.0);
  }
  for (std::size_t s = 0; s < truth.units.size(); ++s) {
    const estimate::WheelSensorFit& fit = said.sensors[s];
    const Unit& unit = truth.units[s];
    into.radius.add(fit.radius_m, unit.radius_m);
    for (std::size_t axis = 0; axis < 2; ++axis) {
      into.bias.add(fit.bias_mps2[axis], truth.final_bias_mps2[s][axis]);
      into.scale.add(fit.scale[axis], unit.scale[axis]);
    }
    into.skew.add(fit.skew_rad, unit.skew_rad);
    if (!fit.has_gyro) continue;
    into.gyro.add(fit.gyro_bias_radps, unit.gyro->bias_radps);
    into.gyro.add(fit.gyro_scale, unit.gyro->scale);
  }
  if (said.rolling_radius_m) into.rolling.add(said.rolling_radius_m, truth.rolling_radius_m);
  if (said.encoder)
    for (std::size_t i = 0; i < 4; ++i)
      into.encoder.add(said.encoder->errors_rad[i], truth.encoder_errors_rad[i]);
}

void print_one(const char* scenario, std::uint64_t seed, const Coverage& one) {
  std::printf("%s %llu%s:", scenario, static_cast<unsigned long long>(seed),
              one.refused > 0 ? " refused" : "");
  const auto print = [](const char* name, const Tally& tally) {
    std::printf(" %s", name);
    for (const double z : tally.z) std::printf(" %.1f", z);
    if (tally.none > 0) std::printf(" -");
  };
  print("turns", one.turns);
  print("angle", one.angle);
  print("radius", one.radius);
  print("bias", one.bias);
  print("scale", one.scale);
  print("skew", one.skew);
  if (one.encoder.given() + one.encoder.none > 0) print("encoder", one.encoder);
  if (one.gyro.given() + one.gyro.none > 0) print("gyroscope", one.gyro);
  if (one.rolling.given() > 0) print("rolling radius", one.rolling);
  std::printf("\n");
  std::fflush(stdout);
}

void append(Coverage& to, const Coverage& from) {
  to.turns.append(from.turns);
  to.angle.append(from.angle);
  to.radius.append(from.radius);
  to.bias.append(from.bias);
  to.scale.append(from.scale);
  to.skew.append(from.skew);
  to.encoder.append(from.encoder);
  to.gyro.append(from.gyro);
  to.rolling.append(from.rolling);
  to.recordings += from.recordings;
  to.refused += from.refused;
}

}  // namespace

void Tally::add(const std::optional<Uncertain>& told, double truth) {
  if (told)
    z.push_back((told->value - truth) / told->std);
  else
    ++none;
}

void Tally::append(const Tally& other) {
  z.insert(z.end(), other.z.begin(), other.z.end());
  none += other.none;
}

double Tally::coverage_95() const {
  const auto held = std::ranges::count_if(z, [](double one) { return std::abs(one) <= 1.959964; });
  return z.empty() ? 1.0 : static_cast<double>(held) / static_cast<double>(z.size());
}

double Tally::largest() const {
  double most = 0.0;
  for (const double one : z)
    if (!(std::abs(one) <= most)) most = std::abs(one);
  return most;
}

double Tally::rms() const {
  double sum = 0.0;
  for (const double one : z) sum += one * one;
  return z.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(z.size()));
}

Coverage coverage_of(const Scenario& scenario, std::uint64_t first, int count, bool verbose) {
  Coverage all;
  std::mutex mutex;
  std::atomic<int> next{0};
  const auto work = [&] {
    for (int i = next++; i < count; i = next++) {
      const std::uint64_t seed = first + static_cast<std::uint64_t>(i);
      const World world = scenario.draw(seed);
      const Recorded recorded = record(world, seed);
      estimate::WheelOptions options = scenario.options(world);
      options.encoder = recorded.encoder;
      const auto said = estimate::estimate_wheel(recorded.sensors, options);
      Coverage one;
      one.recordings = 1;
      if (said)
        compare(*said, recorded.truth, one);
      else
        one.refused = 1;
      const std::scoped_lock lock(mutex);
      if (verbose) print_one(scenario.name, seed, one);
      append(all, one);
    }
  };
  std::vector<std::jthread> workers(std::max(1U, std::thread::hardware_concurrency()));
  for (std::jthread& worker : workers) worker = std::jthread(work);
  for (std::jthread& worker : workers) worker.join();
  return all;
}

}  // namespace proofmass::wheel_world
