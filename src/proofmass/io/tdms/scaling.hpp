#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/io/tdms/scale.hpp"
#include "proofmass/io/tdms/value.hpp"

namespace proofmass::io::tdms {

/// The chain of scales from a channel's stored values to its measured values: NI_Scale[n]_*; the
/// last one gives the result.
class Scaling {
 public:
  /// Input of a chain that is not DAQmx raw data.
  static constexpr std::uint32_t stored_values = 0xFFFFFFFF;

  /// `scalers` are the channel's, by their numbers; empty if it is not DAQmx raw data. nullopt if
  /// there is no chain, or it has been applied already.
  /// Errors: unsupported (cannot be computed), a short message.
  [[nodiscard]] static Result<std::optional<Scaling>> of(const Properties& properties,
                                                         std::span<const std::uint32_t> scalers);

  /// The scalers used as input, in the order in which apply() takes them.
  [[nodiscard]] std::span<const std::uint32_t> sources() const { return sources_; }
  /// Precondition: one column per source, of the result's length.
  void apply(std::span<const std::vector<double>> columns, std::span<double> out);
  /// "linear 2 x + 10, then thermocouple K"
  [[nodiscard]] std::string words() const;

 private:
  /// An input column, or the result of an earlier step.
  struct Input {
    bool is_source = true;
    std::size_t number = 0;
  };
  struct Step {
    Scale scale;
    Input left;
    Input right;
  };
  class Builder;

  std::vector<std::uint32_t> sources_;
  std::vector<Step> steps_;
  std::vector<std::vector<double>> outcomes_;
};

}  // namespace proofmass::io::tdms
