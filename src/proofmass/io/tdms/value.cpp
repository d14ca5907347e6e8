#include "proofmass/io/tdms/value.hpp"

#include <limits>

namespace proofmass::io::tdms {
namespace {

constexpr std::int64_t unix_epoch_s = 2'082'844'800;  // 1970-01-01 on LabVIEW's clock
constexpr std::int64_t ns_per_s = 1'000'000'000;
__extension__ using UInt128 = unsigned __int128;

}  // namespace

Int128 Instant::wide_ns() const {
  const UInt128 scaled = UInt128{fraction} * static_cast<std::uint64_t>(ns_per_s);
  const Int128 part = static_cast<Int128>((scaled + (UInt128{1} << 63)) >> 64);
  return (Int128{seconds} - unix_epoch_s) * ns_per_s + part;
}

std::optional<std::int64_t> Instant::unix_ns() const {
  const Int128 ns = wide_ns();
  constexpr Int128 limit = std::numeric_limits<std::int64_t>::max();
  if (!is_set() || ns > limit || ns < -limit) return std::nullopt;
  return static_cast<std::int64_t>(ns);
}

Instant instant_at(std::int64_t unix_ns) {
  std::int64_t seconds = unix_ns / ns_per_s;
  std::int64_t part = unix_ns % ns_per_s;
  if (part < 0) {
    part += ns_per_s;
    --seconds;
  }
  // Rounded up, so that rounding to the nearest nanosecond recovers it.
  const UInt128 fraction = ((UInt128{static_cast<std::uint64_t>(part)} << 64) + ns_per_s - 1) /
                           static_cast<std::uint64_t>(ns_per_s);
  return {seconds + unix_epoch_s, static_cast<std::uint64_t>(fraction)};
}

std::optional<double> number_of(const Properties& properties, std::string_view name) {
  const auto found = properties.find(name);
  if (found == properties.end()) return std::nullopt;
  const double* figure = std::get_if<double>(&found->second);
  return figure != nullptr ? std::optional(*figure) : std::nullopt;
}

std::string text_of(const Properties& properties, std::string_view name) {
  const auto found = properties.find(name);
  if (found == properties.end()) return {};
  const auto* text = std::get_if<std::string>(&found->second);
  return text != nullptr ? *text : std::string{};
}

std::optional<Instant> instant_of(const Properties& properties, std::string_view name) {
  const auto found = properties.find(name);
  if (found == properties.end()) return std::nullopt;
  const auto* instant = std::get_if<Instant>(&found->second);
  return instant != nullptr ? std::optional(*instant) : std::nullopt;
}

}  // namespace proofmass::io::tdms
