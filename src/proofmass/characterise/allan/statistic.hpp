#pragma once

#include <optional>
#include <string_view>

namespace proofmass::characterise {

/// A deviation of the Allan family. Source for all but the last: W. J. Riley, NIST SP 1065 (2008),
/// section 5.2; for the last: F. Vernotte, M. Lenczner, P.-Y. Bourgeois, E. Rubiola, The parabolic
/// variance (PVAR), IEEE Trans. UFFC 63 (2016) 611.
enum class Statistic {
  adev,     ///< Allan, without overlap
  oadev,    ///< Allan, fully overlapping
  mdev,     ///< modified Allan
  tdev,     ///< time: modified Allan · τ / √3
  hdev,     ///< Hadamard, without overlap
  ohdev,    ///< Hadamard, fully overlapping
  totdev,   ///< total
  mtotdev,  ///< modified total
  ttotdev,  ///< time total: modified total · τ / √3
  htotdev,  ///< Hadamard total
  theo1,    ///< Theo1, at an effective τ of 0.75 m τ0
  pdev,     ///< parabolic
};

/// Whether it is a mean square of differences of the phase, which can be computed online; the
/// others need the whole record at once.
[[nodiscard]] constexpr bool is_difference(Statistic statistic) {
  return statistic <= Statistic::ohdev;
}

/// "oadev", the name on the command line and in documents.
[[nodiscard]] std::string_view name_of(Statistic statistic);

/// "overlapping Allan deviation", the name for people.
[[nodiscard]] std::string_view title_of(Statistic statistic);

/// nullopt for an unknown name.
[[nodiscard]] std::optional<Statistic> parse_statistic(std::string_view name);

}  // namespace proofmass::characterise
