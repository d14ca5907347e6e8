#include "proofmass/io/tdms/scaling.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <map>

#include "proofmass/core/contract.hpp"

namespace proofmass::io::tdms {
namespace {

constexpr std::size_t most_steps = 64;

std::string property(std::uint32_t index, std::string_view what) {
  return fmt::format("NI_Scale[{}]_{}", index, what);
}

}  // namespace

/// Follows the chain from its last scale to the stored values.
class Scaling::Builder {
 public:
  Builder(const Properties& properties, std::span<const std::uint32_t> scalers)
      : properties_(properties), scalers_(scalers) {}

  Result<std::optional<Scaling>> run(std::uint32_t last) {
    const auto outcome = follow(last, 0);
    if (!outcome) return outcome.error();
    if (outcome->is_source) made_.steps_.push_back({Identity{}, *outcome, *outcome});
    made_.outcomes_.resize(made_.steps_.size());
    return std::optional(std::move(made_));
  }

 private:
  Result<Input> source(std::uint32_t scaler) {
    const auto found = std::ranges::find(made_.sources_, scaler);
    const Input input{true, static_cast<std::size_t>(found - made_.sources_.begin())};
    if (found == made_.sources_.end()) made_.sources_.push_back(scaler);
    return input;
  }

  /// The stored values, by the name used in a scale.
  Result<Input> stored(std::uint32_t index) {
    if (scalers_.empty()) {
      if (index == stored_values) return source(stored_values);
    } else if (std::ranges::find(scalers_, index) != scalers_.end()) {
      return source(index);
    } else if (index == stored_values && scalers_.size() == 1) {
      return source(scalers_.front());
    }
    return Error{Errc::unsupported, fmt::format("scale {} is not there", index)};
  }

  Result<Input> follow(std::uint32_t index, std::size_t depth) {
    if (const auto known = outcome_of_.find(index); known != outcome_of_.end())
      return known->second;
    const std::string kind = text_of(properties_, property(index, "Scale_Type"));
    if (index == stored_values || kind.empty()) return stored(index);
    if (depth >= most_steps || made_.steps_.size() >= most_steps)
      return Error{Errc::unsupported, "the scales go round in a circle, or are too many"};
    auto scale = read_scale(properties_, index);
    if (!scale) return scale.error();
    const bool is_sum = std::holds_alternative<Sum>(*scale);
    const auto left =
        follow(input_of(index, kind + (is_sum ? "_Left_Operand_Input_Source" : "_Input_Source")),
               depth + 1);
    if (!left) return left.error();
    auto right = left;
    if (is_sum) right = follow(input_of(index, kind + "_Right_Operand_Input_Source"), depth + 1);
    if (!right) return right.error();
    if (made_.steps_.size() >= most_steps)
      return Error{Errc::unsupported, "the scales are too many"};
    made_.steps_.push_back({std::move(scale).value(), *left, *right});
    const Input outcome{false, made_.steps_.size() - 1};
    outcome_of_[index] = outcome;
    return outcome;
  }

  [[nodiscard]] std::uint32_t input_of(std::uint32_t index, const std::string& name) const {
    const auto input = number_of(properties_, property(index, name));
    const bool is_index = input && *input >= 0.0 && *input <= 4294967295.0;
    return is_index ? static_cast<std::uint32_t>(*input) : stored_values;
  }

  const Properties& properties_;
  std::span<const std::uint32_t> scalers_;
  Scaling made_;
  std::map<std::uint32_t, Input> outcome_of_;
};

Result<std::optional<Scaling>> Scaling::of(const Properties& properties,
                                           std::span<const std::uint32_t> scalers) {
  using Found = std::optional<Scaling>;
  const auto count = number_of(properties, "NI_Number_Of_Scales");
  if (!count || !(*count >= 1.0) || *count > 4294967295.0) return Found{};
  if (text_of(properties, "NI_Scaling_Status") == "scaled") return Found{};
  return Builder(properties, scalers).run(static_cast<std::uint32_t>(*count) - 1);
}

void Scaling::apply(std::span<const std::vector<double>> columns, std::span<double> out) {
  PM_EXPECTS(columns.size() == sources_.size() && !steps_.empty());
  const auto values_of = [&](const Input& input) {
    const auto& values = input.is_source ? columns[input.number] : outcomes_[input.number];
    return View<double>(values).first(out.size());
  };
  for (std::size_t s = 0; s < steps_.size(); ++s) {
    const Step& step = steps_[s];
    const bool is_last = s + 1 == steps_.size();
    if (!is_last) outcomes_[s].resize(std::max(outcomes_[s].size(), out.size()));
    apply_scale(step.scale, values_of(step.left), values_of(step.right),
                is_last ? out : std::span(outcomes_[s]).first(out.size()));
  }
}

std::string Scaling::words() const {
  std::string words;
  for (const Step& step : steps_) words += (words.empty() ? "" : ", then ") + words_for(step.scale);
  return words;
}

}  // namespace proofmass::io::tdms
