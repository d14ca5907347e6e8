#include <cstddef>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "proofmass/characterise/noise/noise_test_support.hpp"
#include "proofmass/characterise/noise/record_needed.hpp"
#include "proofmass/characterise/noise_analysis.hpp"

// How often a term is identified in recordings of length record_needed_s, which promises 95 %.
namespace proofmass::characterise::record_needed_slow_test {
namespace {

using test::Series;

struct Case {
  const char* name;
  double quantisation, flicker, random_walk, ramp;  // in addition to white noise of 1
  double rate_hz;
  Coefficient NoiseModelFit::* asked;
};

NoiseModelFit true_model(const Case& of) {
  NoiseModelFit model;
  model.rate_hz = of.rate_hz;
  model.duration_s = 600.0;
  const auto set = [](Coefficient& term, double value) {
    term.value = value;
    term.upper_95 = value > 0.0 ? value : 1e-6;
    if (value > 0.0) term.verdict = Verdict::identified;
  };
  set(model.white, 1.0);
  set(model.quantisation, of.quantisation);
  set(model.flicker, of.flicker);
  set(model.random_walk, of.random_walk);
  set(model.ramp, of.ramp);
  set_records_needed(model);
  return model;
}

Series drawn(const Case& of, std::size_t n, unsigned seed) {
  return test::sum_of({test::white(1.0, of.rate_hz, n, seed),
                       test::quantisation(of.quantisation, of.rate_hz, n, seed + 1),
                       test::flicker(of.flicker, n, seed + 2),
                       test::random_walk(of.random_walk, of.rate_hz, n, seed + 3),
                       test::ramp(of.ramp, of.rate_hz, n)});
}

TEST(RecordNeeded, IdentifiesEachTermWithTheProbabilityItPromises) {
  const std::vector<Case> cases{
      {"quantisation", 0.02, 0.0, 0.0, 0.0, 100.0, &NoiseModelFit::quantisation},
      {"quantisation, seconds", 0.04, 0.0, 0.0, 0.0, 100.0, &NoiseModelFit::quantisation},
      {"flicker", 0.0, 0.5, 0.0, 0.0, 100.0, &NoiseModelFit::flicker},
      {"random walk", 0.0, 0.0, 0.1, 0.0, 20.0, &NoiseModelFit::random_walk},
      {"ramp in white noise", 0.0, 0.0, 0.0, 2e-3, 10.0, &NoiseModelFit::ramp},
      {"ramp in a random walk", 0.0, 0.0, 0.02, 0.05, 10.0, &NoiseModelFit::ramp},
      {"ramp in flicker noise", 0.0, 0.3, 0.0, 0.02, 10.0, &NoiseModelFit::ramp},
  };
  constexpr unsigned records = 150;
  for (const Case& of : cases) {
    SCOPED_TRACE(of.name);
    const auto needed_s = (true_model(of).*of.asked).record_needed_s;
    ASSERT_TRUE(needed_s.has_value());
    const auto n = static_cast<std::size_t>(*needed_s * of.rate_hz);
    int seen = 0;
    for (unsigned record = 0; record < records; ++record) {
      const auto found =
          analyse_noise(drawn(of, n, 10 * record),
                        {.rate_hz = of.rate_hz, .taus = {.kind = TauGrid::Kind::decade}});
      ASSERT_TRUE(found.has_value());
      seen += (found->model.*of.asked).verdict == Verdict::identified ? 1 : 0;
    }
    RecordProperty(std::string("identified of 150: ") + of.name, seen);
    // 95 % minus three standard deviations of 150 trials.
    EXPECT_GE(seen, 134);
  }
}

}  // namespace
}  // namespace proofmass::characterise::record_needed_slow_test
