#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/io/tdms_scale.hpp"
#include "proofmass/io/tdms_value.hpp"

namespace proofmass::io {

/// The chain of scales that turns what a channel stores into what it measured: NI_Scale[n]_*, of
/// which the last is the outcome.
class TdmsScaling {
 public:
  /// Where the chain begins that is not DAQmx raw data.
  static constexpr std::uint32_t stored_values = 0xFFFFFFFF;

  /// `scalers` are the channel's, by their numbers; empty where it is no DAQmx raw data. nullopt
  /// where there is no chain, or it has been applied already.
  /// Errors: unsupported (what cannot be computed), in a few words.
  [[nodiscard]] static Result<std::optional<TdmsScaling>> of(
      const TdmsProperties& properties, std::span<const std::uint32_t> scalers);

  /// The scalers whose values go in, in the order in which apply() takes them.
  [[nodiscard]] std::span<const std::uint32_t> sources() const { return sources_; }
  /// Precondition: one column for each source, of the outcome's length.
  void apply(std::span<const std::vector<double>> columns, std::span<double> out);
  /// "linear 2 x + 10, then thermocouple K"
  [[nodiscard]] std::string words() const;

 private:
  /// A column that goes in, or the outcome of a step before.
  struct Input {
    bool is_source = true;
    std::size_t number = 0;
  };
  struct Step {
    TdmsScale scale;
    Input left;
    Input right;
  };
  class Builder;

  std::vector<std::uint32_t> sources_;
  std::vector<Step> steps_;
  std::vector<std::vector<double>> outcomes_;
};

}  // namespace proofmass::io
