#pragma once

#include <array>
#include <vector>

#include "proofmass/estimate/motor/filter.hpp"

namespace proofmass::estimate::motor {

/// Probabilities of the left flank, of none, and of the right flank, at each sample.
using ContactProbabilities = std::vector<std::array<double, 3>>;

/// A bank of three filters, one for each contact of the gear, which share their estimates at every
/// sample according to a Markov chain; then the chain's backward pass.
///
/// On a flank the load's angle is the motor's ∓ half the backlash; on none it is anywhere between,
/// and the motor has not the load's torque.
///
/// Source: C.-J. Kim, Dynamic linear models with Markov-switching, Journal of Econometrics 60
/// (1994) 1, section 2.
[[nodiscard]] ContactProbabilities contact_probabilities(const Series& series,
                                                         const Regimes& regimes,
                                                         const Parameters& p);

/// The flank where its probability exceeds `least` and the motor moves towards it, else 0; and 0
/// for some samples at either end of each contact: early in the gap the angle does not yet show
/// that the flank has been left.
[[nodiscard]] std::vector<std::int8_t> certain_contacts(const ContactProbabilities& probabilities,
                                                        const std::vector<double>& speed_radps,
                                                        double least);

}  // namespace proofmass::estimate::motor
