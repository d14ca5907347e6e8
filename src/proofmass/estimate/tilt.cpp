#include "proofmass/estimate/tilt.hpp"

#include <optional>
#include <string>

#include "proofmass/estimate/tilt/epochs.hpp"
#include "proofmass/estimate/tilt/motion.hpp"
#include "proofmass/estimate/tilt/record.hpp"
#include "proofmass/estimate/tilt/rest_search.hpp"
#include "proofmass/estimate/tilt/still.hpp"

namespace proofmass::estimate {
namespace {

// A moving base, by filter and smoother.
void follow(const TiltRecord& record, const TiltOptions& options, TiltSolution& solution) {
  TiltEpochs epochs = epochs_of(record, solution);
  if (const std::size_t held = drop_held(epochs); held > 0)
    solution.notes.push_back(
        {Severity::warning, std::to_string(held) + " of " + std::to_string(solution.samples) +
                                " rows repeat the previous one: the sensor is slower than the "
                                "recording, and each measurement counts once"});
  const TiltKnown known = known_of(record, options, solution, epochs);
  if (options.progress) options.progress("fitting the noise", 0.0);
  const bool gyroscope = has_rates(record);
  std::optional<RateBias> rate_bias;
  // The rotation of a biased gyroscope would count as acceleration: repeated without its bias.
  for (int round = 0; round < (gyroscope ? 2 : 1); ++round) {
    const BaseAccel accel = base_accel(epochs, rate_bias, known);
    epochs.accel_cov_m2ps4 = accel.cov_m2ps4;
    solution.motion = fit_tilt_motion(epochs, known, accel, gyroscope);
    if (gyroscope) rate_bias = rate_bias_of(epochs, known, *solution.motion);
  }
  run_tilt(epochs, known, options, solution);
  // A limitation that no residual reveals, see docs/methods/tilt.md.
  solution.notes.push_back(
      {Severity::info, std::string("a level acceleration that lasts longer than ") +
                           (gyroscope ? "half a minute" : "10 s") +
                           " cannot be distinguished from tilt, and is not in the uncertainty"});
}

}  // namespace

Result<TiltSolution> estimate_tilt(const TiltRecord& all, const TiltOptions& given) {
  TiltSolution solution;
  const std::optional<TiltRecord> believable = without_unusable(all, solution.notes);
  const TiltRecord& record = believable ? *believable : all;
  TiltOptions options = given;
  if (const Status fits = check_record(record, options, solution); !fits) return fits.error();
  signal::RestSearch found = rests_of(record, options);
  const Result<bool> moving = is_moving(record, options, found, solution);
  if (!moving) return moving.error();
  solution.moving = *moving;
  if (solution.moving) {
    drop_slow_motion(record, found);
    if (has_rates(record)) leave_out_rotations(record, options, found);
    leave_out_hidden_onsets(record, options, found);
  }
  if (!solution.moving && found.rests.empty()) {
    found.rests.push_back({0, solution.samples - 1});
    solution.notes.push_back(
        {Severity::warning, "no rest was found (" + found.why_none +
                                "): the mean of the whole recording is taken, as if it were"});
  }
  find_rests(record, options, found.rests, solution);
  if (judge_norm(options, solution)) find_rests(record, options, found.rests, solution);
  make_series(record, solution);
  if (!solution.moving) {
    fill_still(record, options, solution);
    solution.final = solution.rests.back().angles;
    solution.shares = solution.rests.back().shares;
    return solution;
  }
  follow(record, options, solution);
  return solution;
}

}  // namespace proofmass::estimate
